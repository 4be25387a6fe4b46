"""S1: struts and dynamometers that give way."""

from dataclasses import dataclass, replace

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, OneSign, Signature, StageName, parameter
from sim.effects.friction import UNLIKE
from sim.effects.situation import Situation
from sim.effects.springs import in_series, yielding_signature
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class GaugeCompliance(Effect):
    """``-Z^2 y / k``: as inertia, M (1 + w^2/w_n^2) and B (1 + 2 w^2/w_n^2) in place of M and B.

    In phase it grows with w^4, in quadrature with w^3, both with the amplitude; the model rings at
    w_n after a knock, and a harmonic near w_n is magnified. Present in air.
    """

    code = "S1"
    name = "gauge-compliance"
    title = "Struts and dynamometers give way"
    stage = StageName.STRUCTURE

    stiffness_n_m: float = parameter(
        5e5, 2e4, 1e8, "N/m", "stiffness of each strut and gauge", one_sign=OneSign.SPRING
    )
    damping_n_s_m: float = parameter(
        200.0, 0.0, 5e3, "N s/m", "its damping", one_sign=OneSign.DAMPING
    )
    unlike: float = parameter(0.0, -0.9, 0.9, "1", UNLIKE, forms=(0.3,))

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig on these springs, in series with those that it has."""
        mounting = rig.mounting
        stiffness = in_series(mounting.gauge_stiffness_n_m, self.stiffness_n_m)
        damping = mounting.gauge_damping_n_s_m + self.damping_n_s_m
        before, added = (1.0 - stiffness / self.stiffness_n_m), stiffness / self.stiffness_n_m
        soft = replace(
            mounting,
            gauge_stiffness_n_m=stiffness,
            gauge_damping_n_s_m=damping,
            gauge_unlike=before * mounting.gauge_unlike + added * self.unlike,
        )
        return replace(rig, mounting=soft)

    def signature(self, situation: Situation) -> Signature:
        """Return the force of the model on springs; exact."""

        def give(s: complex) -> np.ndarray:
            return np.eye(2) / (self.stiffness_n_m + s * self.damping_n_s_m)

        return yielding_signature(situation, give)
