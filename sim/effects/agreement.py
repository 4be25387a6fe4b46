"""How far the simulated signature of an effect is from the one that its theory states."""

from collections.abc import Iterable, Sequence

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.effects.applied import switch_on
from sim.effects.effect import Effect, Signature
from sim.effects.situation import Situation
from sim.periodic import SteadyState, steady_run
from sim.rig import SimulatedRig


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
) -> Signature:
    """Return what the effect changes in the exact periodic steady state.

    Parameters
    ----------
    keys
        Channel name and order of the harmonics that are wanted.
    """
    nominal = steady_run(rig, set_point, orders=orders)
    changed = steady_run(*switch_on((effect,), rig, set_point), orders=orders)
    return {key: phasor(changed, *key) - phasor(nominal, *key) for key in keys}


def mismatch(
    effect: Effect, rig: SimulatedRig, set_points: Sequence[SetPoint], orders: int = 12
) -> float:
    """Return the largest distance from the theory over the set-points, relative to its norm.

    All orders up to the highest that the theory names are compared, those that it says do not
    change among them. NaN where it states no change at any set-point: a change that does not repeat
    with the shaft, or no change at all.
    """
    worst = float("nan")
    for set_point in set_points:
        theory = effect.signature(Situation.of(rig, set_point))
        norm = float(np.linalg.norm(list(theory.values())))
        if norm == 0.0:
            continue
        names = sorted({name for name, _ in theory})
        highest = max(order for _, order in theory)
        keys = [(name, order) for name in names for order in range(highest + 1)]
        found = simulated_signature(effect, rig, set_point, keys, orders)
        gap = [found[key] - theory.get(key, 0.0) for key in keys]
        worst = float(np.fmax(worst, np.linalg.norm(gap) / norm))
    return worst
