"""M1: a dynamometer whose gain is not the one it was calibrated to."""

from dataclasses import dataclass, replace

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, Signature, StageName, parameter
from sim.effects.measurement import of_forces, with_gauges
from sim.effects.situation import Situation
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class GainError(Effect):
    """``F (1 + g)``: all orders alike, the mean among them.

    A static check weight shows it; on one strut only, it couples heave and pitch.
    """

    code = "M1"
    name = "gain-error"
    title = "Gain error of the dynamometers"
    stage = StageName.DYNAMOMETERS

    aft: float = parameter(0.005, -0.05, 0.05, "1", "gain error of the aft dynamometer")
    fore: float = parameter(0.0, -0.05, 0.05, "1", "gain error of the fore dynamometer")

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with these gains on top of what the gauges have."""
        errors = (self.aft, self.fore)
        return with_gauges(
            rig, lambda gauge, i: replace(gauge, gain=gauge.gain * (1.0 + errors[i]))
        )

    def signature(self, situation: Situation) -> Signature:
        """Return ``g F_n`` of each strut."""
        errors = np.array([self.aft, self.fore])
        return of_forces(situation, lambda _, force: errors * force)
