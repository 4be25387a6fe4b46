"""H8: suction that grows towards the free surface: a model that is not the same up and down."""

from dataclasses import dataclass

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, OneSign, Signature, StageName, parameter
from sim.effects.hydrodynamics import AT_STRUTS, along_hull, of_hull_law
from sim.effects.situation import Situation
from sim.model.laws import Exponential
from sim.rig import SimulatedRig

HIGHEST = 4


@dataclass(frozen=True)
class SurfaceSuction(Effect):
    """``F U^2 (exp(2 k y) - 1)``: even orders that go with U^2, not in air.

    With Bessel's functions of q = 2 k a: ``I_0 - 1`` as a mean, ``2 I_1`` in phase, ``-2 I_2`` as
    the cosine at order 2.
    """

    code = "H8"
    name = "surface-suction"
    title = "Asymmetry by the free surface"
    stage = StageName.MODEL

    suction_n_s2_m2: float = parameter(5.0, -200.0, 200.0, "N s2/m2", "F: force at rest over U^2")
    rate_1_m: float = parameter(
        8.0, 0.5, 60.0, "1/m", "2 k: twice the wave number", one_sign="a wave number"
    )
    at_struts: float = parameter(1.0, 0.0, 1.0, "1", AT_STRUTS, one_sign=OneSign.SHARE)

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with the suction along the hull."""

        def suction(share: float) -> Exponential:
            return Exponential(share * self.suction_n_s2_m2, self.rate_1_m, reference_speed_m_s=1.0)

        return along_hull(rig, suction, self.at_struts)

    def signature(self, situation: Situation) -> Signature:
        """Return the series of ``exp(q sin)`` in Bessel's functions."""
        from scipy.special import iv

        force = self.suction_n_s2_m2 * situation.flow_m_s**2

        def wave(order: int, size: float, phase: float) -> complex:
            bessel = float(iv(order, self.rate_1_m * size))
            if order == 0:
                return force * (bessel - 1.0)
            # cos(n (th + phase - pi/2)): all crests lie where the displacement is largest.
            return complex(force * 2.0 * bessel * 1j * np.exp(1j * order * (phase - np.pi / 2.0)))

        return of_hull_law(situation, self.at_struts, wave, HIGHEST)
