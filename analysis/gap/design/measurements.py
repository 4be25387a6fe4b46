"""Measurements besides oscillations, as runs that have not been made.

At rest; a check weight that is put on one strut's dynamometer and taken off again; a sine into all
force amplifiers in place of the bridges. What a simulated rig shows in them is compared as in any
run. Their noise is that of the means of the run whose frequency is nearest to 1 Hz, for as long as
the record takes.
"""

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Final

import numpy as np

from analysis.gap.forward.problem import Problem
from analysis.gap.observe.components import Component, GapRun, Observation, Part
from hardware.description.channels import FORCES
from hardware.description.setpoint import SetPoint
from sim.effects.campaign import CampaignRun
from sim.effects.effect import FurtherMeasurement
from sim.rest import Excitation, check_weight, injection

BESIDES: Final = (
    (FurtherMeasurement.REST, ""),
    (FurtherMeasurement.CHECK_WEIGHT, "aft"),
    (FurtherMeasurement.CHECK_WEIGHT, "fore"),
    (FurtherMeasurement.INJECTION, ""),
)
REST_S: Final = 60.0
INJECTED_HZ: Final = 10.0  # so fast that a low-pass shows in the size, and not as a delay does
_SAMPLED: Final = 2.5  # times that, at least
_USUAL_HZ: Final = 1.0
_ORDERS: Final = (1, 2)  # of what is done to the rig: its size, and what a curved gauge makes of it
# How well that is known, of itself: weights of class M1 with their arm; a generator's sine. That
# one is off alike at both amplifiers, but is taken as off at each by itself: what all observations
# share are the rig's numbers, and this is none of them.
_KNOWN: Final = {FurtherMeasurement.CHECK_WEIGHT: 1e-4, FurtherMeasurement.INJECTION: 1e-3}
_STANDS: Final = SetPoint(INJECTED_HZ, 0.0)


def measured_besides(
    problem: Problem,
    kind: FurtherMeasurement,
    place: CampaignRun,
    force_n: float = 0.0,
    strut: str = "",
) -> GapRun | None:
    """Return the record of one measurement.

    ``None`` where no gauge of it was recorded, or too seldom for the sine.

    Parameters
    ----------
    kind, strut
        One of :data:`BESIDES`: what is measured, and whose dynamometer a check weight is put on.
    place
        When it is made.
    force_n
        Check weight, or amplitude of the sine.
    """
    near = min(problem.simulator.stack.turning, key=_frequency_distance)
    parts = tuple(_parts(kind, {component.channel for component in near.observed.components}))
    loaded = [component.channel for component in parts if component.channel.endswith(strut)]
    sampled = (
        near.sample_rate_hz >= _SAMPLED * INJECTED_HZ or kind is not FurtherMeasurement.INJECTION
    )
    if not (loaded and sampled):
        return None
    applied = _applied(kind, force_n, strut)
    noise = np.array(
        [near.observed.uncertainty[_mean(near, component.channel)] for component in parts]
    )
    longer = REST_S * near.set_point.frequency_hz / near.periods
    size_uncertainty = _KNOWN.get(kind, 0.0) * np.array(
        [_size_n(applied, component) if component.channel in loaded else 0.0 for component in parts]
    )
    observation = Observation(
        parts, np.zeros(len(parts)), np.hypot(noise / math.sqrt(longer), size_uncertainty)
    )
    return replace(
        near, name=f"{kind} {strut}".strip(), set_point=_STANDS, place=place, observed=observation,
        periods=round(REST_S * INJECTED_HZ), lead_s=0.0, stands_at_m=(0.0, 0.0), applied=applied,
    )  # fmt: skip


def _frequency_distance(run: GapRun) -> float:
    return abs(float(np.log(run.set_point.frequency_hz / _USUAL_HZ)))


def _mean(run: GapRun, channel: str) -> int:
    return run.observed.components.index(Component(channel, Part.MEAN))


def _parts(kind: FurtherMeasurement, recorded: set[str]) -> Iterator[Component]:
    for name in FORCES:
        if name in recorded:
            yield Component(name, Part.MEAN)
            for order in () if kind is FurtherMeasurement.REST else _ORDERS:
                yield Component(name, Part.IN_PHASE, order)
                yield Component(name, Part.QUADRATURE, order)


def _applied(kind: FurtherMeasurement, force_n: float, strut: str) -> Excitation | None:
    if kind is FurtherMeasurement.CHECK_WEIGHT:
        return check_weight(force_n, fore=strut == "fore")
    return injection(force_n, INJECTED_HZ) if kind is FurtherMeasurement.INJECTION else None


def _size_n(applied: Excitation | None, component: Component) -> float:
    """Return the size of what is done to a gauge: its mean, and its first harmonic."""
    if applied is None:
        return 0.0
    _, *sizes = applied.forces_n[0]  # the same at each gauge that it is done to
    return abs(sizes[component.order]) if component.order < len(sizes) else 0.0
