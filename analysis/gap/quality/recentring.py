"""The point about which a diagnosis is linear: the coefficients that the campaign itself fits.

Where a campaign says 40 kg of added mass and the water says 75, nothing is linear about the 40; so
the rig is moved to what fits best, by steps. The tolerances stay about what is stated.

Only added mass and damping are moved. Mass, inertia and restoring are known beforehand: where they
seem to be many tolerances off, something else is there, and moving them would hide it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np

from analysis.gap.forward.free_numbers import Free, free_numbers, tolerated, with_coefficients
from analysis.gap.forward.noise import pooled
from analysis.gap.forward.simulator import Simulator
from analysis.gap.forward.tolerances import Tolerances
from analysis.gap.inference.gaussian import Nuisances
from analysis.gap.observe.components import STEADY_PARTS, GapRun, Observation, Stack
from hardware.description.arrays import FloatArray
from hardware.description.errors import PmmError
from sim.effects.effect import Effect
from sim.rig import SimulatedRig

_STEPS: Final = 20
_LONGEST: Final = 4.0
_SETTLED: Final = 0.3  # prior deviations: a smaller step changes no slope


@dataclass(frozen=True)
class Recentred:
    """A rig moved to the coefficients that a campaign fits.

    Attributes
    ----------
    rig
        The one that was given where the campaign fits what is stated.
    free
        What is left free, with the tolerances of what is stated.
    units
        By how many prior deviations each coefficient was moved; empty where none was.
    moved
        The same in each coefficient's own unit.
    """

    rig: SimulatedRig
    free: tuple[Free, ...]
    units: Mapping[str, float] = field(default_factory=dict)
    moved: Mapping[str, float] = field(default_factory=dict)


def recentred(
    rig: SimulatedRig,
    runs: Sequence[GapRun],
    tolerances: Tolerances,
    on: Sequence[Effect] = (),
    reference_channel: str | None = None,
) -> Recentred:
    """Move a rig to the coefficients that fit."""
    free = free_numbers(rig, tolerances)
    stack = Stack.of([repeating_only(run) for run in pooled(runs, rig, tolerances)])
    simulator = Simulator(rig, stack, tuple(on), reference_channel)
    owned = np.array([number.is_sought for number in free])
    total = np.zeros(len(free))
    # Of prescribed motions forces are linear in the coefficients: slopes are found once.
    nuisances = tolerated(simulator, free, tolerances)
    for _ in range(_STEPS):
        step = np.where(owned, _step(simulator, nuisances, total), 0.0)
        if np.abs(step).max(initial=0.0) < _SETTLED:
            break
        try:
            next_rig = with_coefficients(rig, free, list(total + step))
            Simulator(
                next_rig, simulator.stack, simulator.active_effects, reference_channel
            ).steady(())
        except PmmError:
            break
        total, simulator = total + step, simulator.with_rig(next_rig)
    return _result(simulator.rig, free, total)


def repeating_only(run: GapRun) -> GapRun:
    """Return a run without what does not repeat with the shaft: coefficients do not change that."""
    observation = run.observed
    rows = [
        at for at, component in enumerate(observation.components) if component.part in STEADY_PARTS
    ]
    parts = tuple(observation.components[at] for at in rows)
    return replace(
        run, observed=Observation(parts, observation.values[rows], observation.uncertainty[rows])
    )


def _result(rig: SimulatedRig, free: Sequence[Free], total: FloatArray) -> Recentred:
    pairs = [(number, float(unit)) for number, unit in zip(free, total, strict=True) if unit]
    return Recentred(
        rig,
        tuple(free),
        {number.name: unit for number, unit in pairs},
        {number.name: unit * number.deviation for number, unit in pairs},
    )


def _step(simulator: Simulator, nuisances: Nuisances, total: FloatArray) -> FloatArray:
    """Return how far to go on from where the rig is, the tolerances about what is stated."""
    stack = simulator.stack
    residual = (stack.values - simulator.steady(())) / stack.uncertainty
    stated = residual + nuisances.columns[:, : len(total)] @ total
    units = nuisances.fitted(stated)[: len(total)] - total
    return np.asarray(units * min(1.0, _LONGEST / max(float(np.abs(units).max()), 1e-12)))
