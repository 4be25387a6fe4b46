"""D6: a frequency that is not what was set, or a clock that is wrong."""

from dataclasses import dataclass, replace

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, Signature, StageName, parameter
from sim.effects.situation import Situation
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class SetFrequencyError(Effect):
    """``-2 d M w^2 y`` in phase and ``d B w y`` in quadrature, for the real over the set frequency.

    Analysed at the wrong frequency over N periods a harmonic is also sinc(n N d) as large.
    """

    code = "D6"
    name = "frequency-error"
    title = "Frequency not as set"
    stage = StageName.DRIVE

    relative: float = parameter(1e-3, -0.02, 0.02, "1", "real over set frequency, less 1")

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig whose drive turns at another speed than it is told."""
        ratio = (1.0 + rig.drive.speed_error) * (1.0 + self.relative)
        return replace(rig, drive=replace(rig.drive, speed_error=ratio - 1.0))

    def signature(self, situation: Situation) -> Signature:
        """Return ``(Z(w (1 + d)) - Z(w)) y``; exact."""
        return situation.moved({}, 1.0 + self.relative)
