"""K4: a phase between the struts that is not what was set."""

from dataclasses import dataclass, replace

from hardware.description.setpoint import SetPoint
from sim.effects.crank import linkage_signature
from sim.effects.effect import Effect, Signature, StageName, parameter
from sim.effects.situation import Situation
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class StrutPhaseError(Effect):
    """The fore strut is ``eps`` further ahead: ``exp(i eps) - 1`` of its motion, at order n n eps.

    A constant angle, in proportion to the amplitude. Seen from the mean of both struts heave turns
    to pitch in quadrature, ``e sin(eps/2)``, and loses eps^2/8.
    """

    code = "K4"
    name = "strut-phase-error"
    title = "Phase between the struts not as set"
    stage = StageName.MECHANISM

    error_rad: float = parameter(0.005, -0.02, 0.02, "rad", "added to the fore strut's phase")

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with this error in the fore strut's phase."""
        fore = rig.linkage_fore
        turned = replace(fore, phase_error_rad=fore.phase_error_rad + self.error_rad)
        return replace(rig, linkage_fore=turned)

    def signature(self, situation: Situation) -> Signature:
        """Return the change of the fore strut's motion, and the model's reaction to it; exact."""
        e = situation.amplitude_m
        return linkage_signature(situation, (e, e), (0.0, self.error_rad))
