"""K1: a crank with a connecting rod of finite length in place of a yoke."""

from dataclasses import dataclass, replace

from hardware.description.setpoint import SetPoint
from sim.effects.crank import linkage_signature
from sim.effects.effect import Effect, Signature, StageName, parameter
from sim.effects.situation import Situation
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class ConnectingRod(Effect):
    """``e sin + sqrt(L^2 - (e cos + o)^2)``: even harmonics, locked to the crank's dead centre.

    The second one, ``-e (r/4 + r^3/16) cos(2 theta)`` with r = e/L, grows with the amplitude
    squared; as inertia it is r times the first harmonic of the force. A guide that misses the
    crank's centre by o adds ``-e (o/L) cos(theta)`` and a third harmonic r^2/8 as large. A yoke
    whose slot is bowed to a radius L moves its strut likewise, so that L may be far longer than any
    rod: the range ends where no sensor tells the slot from a straight one. A rod to the other side
    of the crank, or a slot that is bowed the other way, has a negative length: the root is then
    taken off, and the even harmonics change their sign.
    """

    code = "K1"
    name = "connecting-rod"
    title = "Crank with a connecting rod of finite length"
    stage = StageName.MECHANISM

    rod_length_m: float = parameter(
        1.5,
        -1e4,
        1e4,
        "m",
        "length of the rod, or the slot's radius; negative to the other side of the crank",
        least=0.1,
    )
    rod_offset_m: float = parameter(
        0.0, -0.05, 0.05, "m", "by how much the rod's guide misses the crank's centre"
    )

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with this rod on both cranks."""
        aft, fore = (
            replace(setting, rod_offset_m=setting.rod_offset_m + self.rod_offset_m)
            for setting in (rig.linkage_aft, rig.linkage_fore)
        )
        oscillator = replace(rig.oscillator, rod_length_m=self.rod_length_m)
        return replace(rig, oscillator=oscillator, linkage_aft=aft, linkage_fore=fore)

    def signature(self, situation: Situation) -> Signature:
        """Return the Fourier series of the motion, and the model's reaction to it."""
        e = situation.amplitude_m
        return linkage_signature(
            situation, (e, e), (0.0, 0.0), self.rod_length_m, self.rod_offset_m
        )
