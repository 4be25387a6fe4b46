"""Compare what an effect does in the periodic steady state with the signature that it states."""

from collections.abc import Sequence

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect
from sim.effects.situation import Situation
from sim.periodic import SteadyState, steady_run
from sim.rig import SimulatedRig


def phasor(state: SteadyState, name: str, order: int) -> complex:
    """``S + i C`` of a signal as a recording would be analysed: time from the photocell's pulse."""
    harmonic = complex(state.referred(name)[order])
    return harmonic if order == 0 else complex(-harmonic.imag, harmonic.real)


def mismatch(
    effect: Effect, rig: SimulatedRig, set_points: Sequence[SetPoint], orders: int = 12
) -> float:
    """Largest distance from the signature over the set-points, relative to the signature's norm.

    All orders up to the highest that the signature names are compared, those that it says do not
    change among them.
    """
    worst = 0.0
    for set_point in set_points:
        expected = effect.signature(Situation.of(rig, set_point))
        names = sorted({name for name, _ in expected})
        highest = max(order for _, order in expected)
        nominal = steady_run(rig, set_point, orders=orders)
        changed = steady_run(effect.change(rig, set_point), set_point, orders=orders)
        keys = [(name, order) for name in names for order in range(highest + 1)]
        found = np.array([phasor(changed, *key) - phasor(nominal, *key) for key in keys])
        theory = np.array([expected.get(key, 0.0) for key in keys])
        worst = max(worst, float(np.linalg.norm(found - theory) / np.linalg.norm(theory)))
    return worst
