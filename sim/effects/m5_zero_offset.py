"""M5: a zero that is not zero."""

from dataclasses import dataclass, replace

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, Signature, StageName, parameter
from sim.effects.measurement import with_gauges
from sim.effects.situation import RECORDED_FORCES, Situation, at_struts
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class ZeroOffset(Effect):
    """A constant reading: in the mean only.

    While the model moves, friction that differs from one direction to the other looks the same;
    only a record at rest tells them apart.
    """

    code = "M5"
    name = "zero-offset"
    title = "Zero offset of the dynamometers"
    stage = StageName.DYNAMOMETERS

    aft_n: float = parameter(0.3, -5.0, 5.0, "N", "offset of the aft dynamometer")
    fore_n: float = parameter(0.0, -5.0, 5.0, "N", "offset of the fore dynamometer")

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with these offsets on top of what the gauges have."""
        offsets = (self.aft_n, self.fore_n)
        return with_gauges(
            rig, lambda gauge, i: replace(gauge, offset_n=gauge.offset_n + offsets[i])
        )

    def signature(self, situation: Situation) -> Signature:
        """Return the offsets as means."""
        return at_struts(np.array([self.aft_n, self.fore_n]), 0, RECORDED_FORCES)
