"""A3: a photocell whose mark is not where the shaft angle is zero."""

from dataclasses import dataclass, replace

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, Signature, StageName, parameter
from sim.effects.measurement import of_waves
from sim.effects.situation import Situation
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class PhotocellAngle(Effect):
    """A mark that comes late by an angle turns order n of every channel by n times that angle.

    Force and displacement alike, at all frequencies alike; a late pulse takes ``alpha C`` off the
    in-phase part and adds ``alpha S`` to the quadrature.
    """

    code = "A3"
    name = "photocell-angle"
    title = "Angular offset of the photocell's mark"
    stage = StageName.PHOTOCELL

    late_rad: float = parameter(0.01, -0.2, 0.2, "rad", "shaft angle at which the pulse comes")

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with the mark moved; one without a photocell stays as it is."""
        if rig.photocell is None:
            return rig
        mark = rig.photocell.mark_angle_rad + self.late_rad
        return replace(rig, photocell=replace(rig.photocell, mark_angle_rad=mark))

    def signature(self, situation: Situation) -> Signature:
        """Return ``(exp(i n alpha) - 1) H_n`` for every channel."""
        if situation.rig.photocell is None:
            return {}
        turn = np.exp(1j * self.late_rad)
        return of_waves(
            situation, lambda name, order: (turn**order - 1.0) * situation.phasor(name, order)
        )
