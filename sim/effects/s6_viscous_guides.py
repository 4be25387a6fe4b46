"""S6: viscous friction of guides below the dynamometer."""

from dataclasses import dataclass, replace
from typing import ClassVar

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, OneSign, Signature, StageName, parameter
from sim.effects.situation import Situation, at_struts
from sim.model.law_point import Acting, Point
from sim.model.laws import Viscous
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class ViscousGuides(Effect):
    """``b v`` at each strut: damping that is there in air too."""

    code: ClassVar[str] = "S6"
    name: ClassVar[str] = "viscous-guides"
    title: ClassVar[str] = "Viscous friction below the dynamometer"
    stage: ClassVar[StageName] = StageName.STRUCTURE

    viscous_n_s_m: float = parameter(
        2.0, 0.0, 50.0, "N s/m", "at each strut", one_sign=OneSign.DAMPING
    )

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with the friction at both struts."""
        law = Viscous(self.viscous_n_s_m)
        added = (Acting(law, Point.AFT), Acting(law, Point.FORE))
        return replace(rig, forces=(*rig.forces, *added))

    def signature(self, situation: Situation) -> Signature:
        """Return ``i w b y`` of each strut; exact."""
        factor = 1j * situation.omega * self.viscous_n_s_m
        return at_struts(factor * situation.displacement(), 1)
