"""S2: a carriage or frame that gives way to the force of both struts."""

from dataclasses import dataclass, replace

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, OneSign, Signature, StageName, parameter
from sim.effects.situation import Situation
from sim.effects.springs import in_series, yielding_signature
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class FrameCompliance(Effect):
    """The frame moves by ``-sum F / (K - M w^2)``: like yielding gauges, but with the sum.

    So it vanishes where the struts move against each other.
    """

    code = "S2"
    name = "frame-compliance"
    title = "Carriage or frame gives way"
    stage = StageName.STRUCTURE

    stiffness_n_m: float = parameter(
        5e6, 2e5, 1e9, "N/m", "stiffness of the frame", one_sign=OneSign.SPRING
    )
    mass_kg: float = parameter(
        500.0, 10.0, 5e3, "kg", "what of the frame moves", one_sign=OneSign.MASS
    )
    damping_n_s_m: float = parameter(
        2e3, 0.0, 1e5, "N s/m", "its damping", one_sign=OneSign.DAMPING
    )

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig on this frame, in series with the stiffness that it has."""
        mounting = rig.mounting
        soft = replace(
            mounting,
            frame_stiffness_n_m=in_series(mounting.frame_stiffness_n_m, self.stiffness_n_m),
            frame_damping_n_s_m=mounting.frame_damping_n_s_m + self.damping_n_s_m,
            frame_mass_kg=self.mass_kg,
        )
        return replace(rig, mounting=soft)

    def signature(self, situation: Situation) -> Signature:
        """Return the force of the model below a frame with one mode; exact."""

        def give(s: complex) -> np.ndarray:
            dynamic = self.stiffness_n_m + s * self.damping_n_s_m + s**2 * self.mass_kg
            return np.ones((2, 2)) / dynamic

        return yielding_signature(situation, give)
