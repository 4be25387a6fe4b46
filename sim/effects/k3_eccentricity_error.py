"""K3: an eccentricity that is not what was set."""

from dataclasses import dataclass, replace

from hardware.description.setpoint import SetPoint
from sim.effects.crank import linkage_signature
from sim.effects.effect import Effect, Signature, StageName, parameter
from sim.effects.situation import Situation
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class EccentricityError(Effect):
    """``Z_1 d`` whatever the amplitude: an intercept of both phases, in the ratio of Z."""

    code = "K3"
    name = "eccentricity-error"
    title = "Eccentricity of a strut not as set"
    stage = StageName.MECHANISM

    error_aft_m: float = parameter(1e-4, -1e-3, 1e-3, "m", "added to the aft strut's eccentricity")
    error_fore_m: float = parameter(0.0, -1e-3, 1e-3, "m", "added to the fore strut's eccentricity")

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with these errors in its settings."""
        aft, fore = rig.linkage_aft, rig.linkage_fore
        aft_m = aft.eccentricity_error_m + self.error_aft_m
        fore_m = fore.eccentricity_error_m + self.error_fore_m
        return replace(
            rig,
            linkage_aft=replace(aft, eccentricity_error_m=aft_m),
            linkage_fore=replace(fore, eccentricity_error_m=fore_m),
        )

    def signature(self, situation: Situation) -> Signature:
        """Return the change of the motion, and the model's reaction to it; exact for a yoke."""
        e = situation.amplitude_m
        real = (e + self.error_aft_m, e + self.error_fore_m)
        return linkage_signature(situation, real, (0.0, 0.0))
