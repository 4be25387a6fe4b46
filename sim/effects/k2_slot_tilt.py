"""K2: a yoke whose slot is not square to the motion."""

import math
from dataclasses import dataclass, replace

from hardware.description.setpoint import SetPoint
from sim.effects.crank import linkage_signature
from sim.effects.effect import Effect, Signature, StageName, parameter
from sim.effects.situation import Situation
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class SlotTilt(Effect):
    """A tilt g turns a strut's motion by g and makes it 1/cos(g) as large: ``i tan(g)`` of it.

    No harmonics; in proportion to the amplitude, at all frequencies.
    """

    code = "K2"
    name = "slot-tilt"
    title = "Yoke's slot not square to the motion"
    stage = StageName.MECHANISM

    tilt_aft_rad: float = parameter(0.005, -0.02, 0.02, "rad", "tilt of the aft strut's slot")
    tilt_fore_rad: float = parameter(0.0, -0.02, 0.02, "rad", "tilt of the fore strut's slot")

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with the slots tilted."""
        aft, fore = rig.linkage_aft, rig.linkage_fore
        return replace(
            rig,
            linkage_aft=replace(aft, slot_tilt_rad=aft.slot_tilt_rad + self.tilt_aft_rad),
            linkage_fore=replace(fore, slot_tilt_rad=fore.slot_tilt_rad + self.tilt_fore_rad),
        )

    def signature(self, situation: Situation) -> Signature:
        """Return the rotated motion, and the model's reaction to it; exact."""
        aft, fore = self.tilt_aft_rad, self.tilt_fore_rad
        e = situation.amplitude_m
        return linkage_signature(situation, (e / math.cos(aft), e / math.cos(fore)), (aft, fore))
