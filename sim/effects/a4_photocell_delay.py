"""A4: a photocell, or the logic behind it, that is slow."""

from dataclasses import dataclass, replace

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, Signature, StageName, parameter
from sim.effects.measurement import of_waves
from sim.effects.situation import Situation
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class PhotocellDelay(Effect):
    """A pulse that comes a time after the mark turns order n of every channel by ``n w t``.

    As an angular offset, but rising with the frequency; as an amplifier's lag with the opposite
    sign, but in the displacements too. Where the channels are later than the pulse, as behind the
    same filter each, the delay is negative.
    """

    code = "A4"
    name = "photocell-delay"
    title = "Delay of the photocell's pulse"
    stage = StageName.PHOTOCELL

    delay_s: float = parameter(
        1e-3, -0.05, 0.05, "s", "from the mark to the pulse, beyond that of the channels"
    )

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with the pulse delayed; one without a photocell stays as it is."""
        if rig.photocell is None:
            return rig
        latency = rig.photocell.latency_s + self.delay_s
        return replace(rig, photocell=replace(rig.photocell, latency_s=latency))

    def signature(self, situation: Situation) -> Signature:
        """Return ``(exp(i n w t) - 1) H_n`` for every channel."""
        if situation.rig.photocell is None:
            return {}
        turn = np.exp(1j * situation.omega * self.delay_s)
        return of_waves(
            situation, lambda name, order: (turn**order - 1.0) * situation.phasor(name, order)
        )
