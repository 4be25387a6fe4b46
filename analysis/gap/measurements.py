"""Measurements besides oscillations, as runs that have not been made.

At rest; check weights that are put on each strut's dynamometer in turn and taken off again; a sine
into all force amplifiers in place of the bridges. What a simulated rig shows in them is compared as
in any run. Their noise is that of the means of the run whose frequency is nearest to 1 Hz.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from analysis.gap.components import Component, GapRun, Observation, Part
from analysis.gap.fit import Problem
from analysis.gap.observe import FORCES
from hardware.description.setpoint import SetPoint
from sim.effects.campaign import CampaignRun
from sim.effects.effect import Measurement
from sim.standing import Applied, check_weight, injection

FloatArray = NDArray[np.float64]

BESIDES: Final = (Measurement.REST, Measurement.CHECK_WEIGHT, Measurement.INJECTION)
REST_S: Final = 60.0
INJECTED_HZ: Final = 1.0
_ORDERS: Final = (1, 2)  # of what is done to the rig: its size, and what a curved gauge makes of it
# How well that is known, of itself: weights of class M1 with their arm; a generator's sine.
_KNOWN: Final = {Measurement.CHECK_WEIGHT: 1e-4, Measurement.INJECTION: 1e-3}
_STANDS: Final = SetPoint(INJECTED_HZ, 0.0)


def measured_besides(
    problem: Problem, kind: Measurement, place: CampaignRun, force_n: float
) -> tuple[GapRun, ...]:
    """Return the records of one measurement; none where no gauge was recorded.

    Parameters
    ----------
    kind
        One of :data:`BESIDES`.
    place
        When it is made.
    force_n
        Check weight, or amplitude of the sine.
    """
    near = min(problem.simulator.stack.turning, key=_far)
    parts = tuple(_parts(kind, {one.channel for one in near.observed.components}))
    if not parts:
        return ()
    noise = np.array([near.observed.uncertainty[_mean(near, one.channel)] for one in parts])
    known = _KNOWN.get(kind, 0.0) * force_n * np.array([one.order == 1 for one in parts])
    seen = Observation(parts, np.zeros(len(parts)), np.hypot(noise, known))
    still = replace(
        near, set_point=_STANDS, place=place, observed=seen, periods=round(REST_S * INJECTED_HZ),
        lead_s=0.0, stands_at_m=(0.0, 0.0),
    )  # fmt: skip
    return tuple(
        replace(still, name=f"{kind} {number}", applied=one)
        for number, one in enumerate(_applied(kind, force_n))
    )


def _far(run: GapRun) -> float:
    return abs(float(np.log(run.set_point.frequency_hz / INJECTED_HZ)))


def _mean(run: GapRun, channel: str) -> int:
    return run.observed.components.index(Component(channel, Part.MEAN))


def _parts(kind: Measurement, recorded: set[str]) -> Iterator[Component]:
    for name in FORCES:
        if name in recorded:
            yield Component(name, Part.MEAN)
            for order in () if kind is Measurement.REST else _ORDERS:
                yield Component(name, Part.IN_PHASE, order)
                yield Component(name, Part.QUADRATURE, order)


def _applied(kind: Measurement, force_n: float) -> Sequence[Applied | None]:
    if kind is Measurement.CHECK_WEIGHT:
        return check_weight(force_n), check_weight(force_n, fore=True)
    if kind is Measurement.INJECTION:
        return (injection(force_n, INJECTED_HZ),)
    return (None,)
