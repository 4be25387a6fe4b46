"""S5: friction in proportion to the load on a guide, below the dynamometer."""

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, OneSign, Signature, StageName, parameter
from sim.effects.friction import UNLIKE, at_both_struts
from sim.effects.situation import Situation, at_struts
from sim.model.friction import LoadFriction
from sim.rig import SimulatedRig

HIGHEST = 5


@dataclass(frozen=True)
class LoadDependentFriction(Effect):
    """``mu |N_0 + F| sgn(v)`` at each strut, F its force.

    Without side load the third harmonic is as large as the first, ``2 mu F/pi`` each where F is in
    phase. A side load that is larger than F gives Coulomb friction, and even harmonics:
    ``8 mu F/(3 pi)`` at the second order. Dry guides turn it over the distance in which their
    asperities bend (Dahl).
    """

    code = "S5"
    name = "load-friction"
    title = "Friction in proportion to the load on a guide"
    stage = StageName.STRUCTURE

    friction: float = parameter(
        0.02, 0.0, 0.3, "1", "coefficient of friction", one_sign=OneSign.FRICTION
    )
    side_load_n: float = parameter(0.0, -500.0, 500.0, "N", "steady load on the guide")
    presliding_m: float = parameter(
        0.0,
        0.0,
        2e-3,
        "m",
        "distance in which bristles bend the other way, 0 for none",
        one_sign=OneSign.LENGTH,
        forms=(5e-5, 4e-4),
    )
    unlike: float = parameter(0.0, -1.0, 1.0, "1", UNLIKE, forms=(0.3,))

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with the friction at both struts."""
        law = LoadFriction(self.friction, self.side_load_n, 1.0, self.presliding_m or None)
        return at_both_struts(rig, law, self.unlike)

    def signature(self, situation: Situation) -> Signature:
        """Return the Fourier coefficients, from the stretches in which no sign changes; exact."""
        force = situation.force() / situation.turn
        predicted: dict[tuple[str, int], complex] = {}
        for order in range(HIGHEST + 1):
            shares = [_share(self.side_load_n, complex(phasor), order) for phasor in force]
            values = self.friction * np.array(shares) * situation.turn**order
            predicted |= at_struts(values.real if order == 0 else values, order)
        return predicted


def _share(side_load: float, force: complex, order: int) -> complex:
    """Return ``S + i C`` of |N + F sin(th + alpha)| sgn(cos th), F and alpha of the phasor."""
    size, alpha = abs(force), math.atan2(force.imag, force.real)
    turns = [-math.pi / 2.0, math.pi / 2.0, 1.5 * math.pi]
    if size > abs(side_load):
        rise = math.asin(-side_load / size)
        zeros = (rise - alpha, math.pi - rise - alpha)
        turns += [(zero + math.pi / 2.0) % (2.0 * math.pi) - math.pi / 2.0 for zero in zeros]
    total = 0j
    for start, end in pairwise(sorted(turns)):
        middle = (start + end) / 2.0
        load = side_load + size * math.sin(middle + alpha)
        sign = math.copysign(1.0, load) * math.copysign(1.0, math.cos(middle))
        total += sign * (
            side_load * _wave(-order, start, end)
            + (force * _wave(1 - order, start, end)) / 2j
            - (force.conjugate() * _wave(-1 - order, start, end)) / 2j
        )
    return total.real / (2.0 * math.pi) + 0j if order == 0 else 1j * total / math.pi


def _wave(order: int, start: float, end: float) -> complex:
    """Return the integral of exp(i order th)."""
    if order == 0:
        return complex(end - start)
    waves = np.exp(1j * order * np.array([start, end]))
    return complex(waves[1] - waves[0]) / (1j * order)
