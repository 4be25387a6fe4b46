"""S4: friction that is larger near standstill, below the dynamometer."""

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, Signature, StageName, parameter
from sim.effects.situation import Situation, at_struts
from sim.model.law_point import Acting, Point
from sim.model.laws import Stribeck
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class StribeckFriction(Effect):
    """``(F_s - F_c) exp(-(v/v_s)^2) sgn(v)`` at each strut, besides Coulomb friction.

    In quadrature ``(4/pi) (F_s - F_c) D(p)/p`` with p = a w/v_s and Dawson's integral D, so it
    falls as 1/p^2; the third harmonic is the larger one for p > 1.30.
    """

    code: ClassVar[str] = "S4"
    name: ClassVar[str] = "stribeck-friction"
    title: ClassVar[str] = "Friction that is larger near standstill"
    stage: ClassVar[StageName] = StageName.STRUCTURE

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

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with the friction at both struts."""
        law = Stribeck(self.excess_n, self.stribeck_speed_m_s)
        added = (Acting(law, Point.AFT), Acting(law, Point.FORE))
        return replace(rig, forces=(*rig.forces, *added))

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
