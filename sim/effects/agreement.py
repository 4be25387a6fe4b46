"""Difference between an effect's simulated signature and the one that theory states."""

from collections.abc import Iterable, Sequence
from typing import Final

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, Signature
from sim.effects.situation import Situation
from sim.effects.switching import switch_on
from sim.periodic import SteadyState
from sim.rig import SimulatedRig
from sim.run import steady_run

# Of the nominal signal: a smaller change is none.
SMALLEST: Final = 1e-6


def phasor(state: SteadyState, name: str, order: int) -> complex:
    """Return ``S + i C`` of a signal as a recording would be analysed.

    Time counts from the photocell's pulse; order 0 is the mean.
    """
    return _phasors(state, [(name, order)])[name, order]


def _phasors(state: SteadyState, keys: Sequence[tuple[str, int]]) -> Signature:
    referred = {name: state.referred(name) for name in dict.fromkeys(name for name, _ in keys)}
    found = {}
    for name, order in keys:
        harmonic = complex(referred[name][order])
        found[name, order] = harmonic if order == 0 else complex(-harmonic.imag, harmonic.real)
    return found


def simulated_signature(
    effect: Effect,
    rig: SimulatedRig,
    set_point: SetPoint,
    keys: Iterable[tuple[str, int]],
    orders: int = 12,
    points: int = 128,
) -> Signature:
    """Return what the effect changes in the exact periodic steady state.

    Parameters
    ----------
    keys
        Channel name and order of the harmonics that are wanted.
    points
        Of the period, for what neither jumps nor bends.
    """
    nominal = steady_run(rig, set_point, orders=orders, points=points)
    named = list(keys)
    before = _phasors(nominal, named)
    after = _phasors(_changed(effect, rig, set_point, orders, points), named)
    return {key: after[key] - before[key] for key in named}


def _changed(
    effect: Effect, rig: SimulatedRig, set_point: SetPoint, orders: int, points: int
) -> SteadyState:
    return steady_run(*switch_on((effect,), rig, set_point), orders=orders, points=points)


def mismatch(
    effect: Effect,
    rig: SimulatedRig,
    set_points: Sequence[SetPoint],
    orders: int = 12,
    points: int = 128,
) -> float:
    """Return the largest distance from the theory over the set-points, relative to its norm.

    All orders up to the highest that the theory names are compared, those that it says do not
    change among them; each quantity (the forces, the displacements) for itself, relative to what
    the theory states of it, or to 1e-6 of the nominal signal where that is more. NaN where it
    states no change at any set-point: a change that does not repeat with the shaft, or none at all.
    """
    worst = float("nan")
    for set_point in set_points if effect.repeats else ():
        situation = Situation.of(rig, set_point, orders, points)
        theory = effect.signature(situation)
        if not any(theory.values()):
            continue
        highest = max(order for _, order in theory)
        names = sorted({name for name, _ in theory})
        keys = [(name, order) for name in names for order in range(highest + 1)]
        before = _phasors(situation.nominal, keys)
        after = _phasors(_changed(effect, rig, set_point, orders, points), keys)
        for quantity in {_quantity(name) for name in names}:
            group = [key for key in keys if _quantity(key[0]) == quantity]
            stated = np.array([theory.get(key, 0.0) for key in group])
            nominal = np.array([before[key] for key in group])
            gap = np.array([after[key] for key in group]) - nominal - stated
            least = SMALLEST * np.linalg.norm(nominal)
            worst = float(np.fmax(worst, np.linalg.norm(gap) / max(np.linalg.norm(stated), least)))
    return worst


def _quantity(name: str) -> str:
    return name.removesuffix("_aft").removesuffix("_fore")
