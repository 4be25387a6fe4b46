"""S4: friction that is larger near standstill, below the dynamometer."""

import math
from dataclasses import dataclass

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, OneSign, Signature, StageName, parameter
from sim.effects.friction import UNLIKE, at_both_struts
from sim.effects.situation import Situation, at_struts
from sim.model.friction import Stribeck
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class StribeckFriction(Effect):
    """``(F_s - F_c) exp(-(v/v_s)^2) sgn(v)`` at each strut, besides Coulomb friction.

    In quadrature ``(4/pi) (F_s - F_c) D(p)/p`` with p = a w/v_s and Dawson's integral D, so it
    falls as 1/p^2; the third harmonic is the larger one for p > 1.30. It may turn over the distance
    in which bristles bend (Dahl), or fall more slowly, ``(1 + |v|/v_n)^-n``, v_n being such that
    the loss per cycle at p >> 1 is the same.
    """

    code = "S4"
    name = "stribeck-friction"
    title = "Friction that is larger near standstill"
    stage = StageName.STRUCTURE

    excess_n: float = parameter(
        0.15,
        0.0,
        5.0,
        "N",
        "static less sliding friction, at each strut",
        one_sign="what slides is not held faster than what sticks",
    )
    stribeck_speed_m_s: float = parameter(
        0.02,
        0.001,
        0.2,
        "m/s",
        "speed at which 1/e of the excess is left",
        one_sign="a speed, whichever way",
    )
    presliding_m: float = parameter(
        0.0,
        0.0,
        2e-3,
        "m",
        "distance in which bristles bend the other way, 0 for none",
        one_sign=OneSign.LENGTH,
        forms=(2e-5,),
    )
    tail: float = parameter(
        0.0,
        0.0,
        0.45,
        "1",
        "1/n of a fall as a power of the speed; 0 for that of a normal density",
        one_sign="what slides is not held faster than what sticks",
        forms=(0.25,),
    )
    unlike: float = parameter(0.0, -1.0, 1.0, "1", UNLIKE, forms=(0.3,))

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with the friction at both struts."""
        speed, tail = self.stribeck_speed_m_s, None
        if self.tail:
            tail = 1.0 / self.tail
            speed *= math.sqrt((tail - 1.0) * (tail - 2.0) / 2.0)
        law = Stribeck(self.excess_n, speed, self.presliding_m or None, tail)
        return at_both_struts(rig, law, self.unlike)

    def signature(self, situation: Situation) -> Signature:
        """Return the describing function, by Dawson's integral; each strut at its own phase."""
        peak = situation.amplitude_m * situation.omega / self.stribeck_speed_m_s
        predicted: dict[tuple[str, int], complex] = {}
        if not peak:
            return predicted
        for order, share in zip((1, 3, 5), _shares(peak), strict=True):
            predicted |= at_struts(1j * self.excess_n * share * situation.turn**order, order)
        return predicted


def _shares(peak: float) -> FloatArray:
    """Return the cosine parts of orders 1, 3 and 5 of exp(-(p cos)^2) sgn(cos).

    With m_j the mean of s^j exp(-p^2 (1 - s^2)) over s from 0 to 1, they are 4/pi times m_0,
    m_0 - 4 m_2 and m_0 - 12 m_2 + 16 m_4.
    """
    from scipy.special import dawsn

    m0 = dawsn(peak) / peak
    m2 = (1.0 - m0) / (2.0 * peak**2)
    m4 = (1.0 - 3.0 * m2) / (2.0 * peak**2)
    return np.array([m0, m0 - 4.0 * m2, m0 - 12.0 * m2 + 16.0 * m4]) * 4.0 / np.pi
