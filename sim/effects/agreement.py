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
    harmonic = complex(state.referred(name)[order])
    return harmonic if order == 0 else complex(-harmonic.imag, harmonic.real)


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
    real = switch_on((effect,), rig, set_point)
    changed = steady_run(*real, orders=orders, points=points)
    return {key: phasor(changed, *key) - phasor(nominal, *key) for key in keys}


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
        situation = Situation.of(rig, set_point)
        theory = effect.signature(situation)
        if not any(theory.values()):
            continue
        highest = max(order for _, order in theory)
        names = sorted({name for name, _ in theory})
        keys = [(name, order) for name in names for order in range(highest + 1)]
        simulated = simulated_signature(effect, rig, set_point, keys, orders, points)
        for quantity in {_quantity(name) for name in names}:
            group = [key for key in keys if _quantity(key[0]) == quantity]
            stated = np.array([theory.get(key, 0.0) for key in group])
            gap = np.array([simulated[key] for key in group]) - stated
            least = SMALLEST * np.linalg.norm([phasor(situation.nominal, *key) for key in group])
            worst = float(np.fmax(worst, np.linalg.norm(gap) / max(np.linalg.norm(stated), least)))
    return worst


def _quantity(name: str) -> str:
    return name.removesuffix("_aft").removesuffix("_fore")
