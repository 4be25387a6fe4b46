"""S6: viscous friction of guides below the dynamometer."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, OneSign, Signature, StageName, parameter
from sim.effects.friction import UNLIKE, at_both_struts, power_law
from sim.effects.situation import Situation, at_struts
from sim.effects.typical import speed_m_s
from sim.model.laws import Viscous
from sim.rig import SimulatedRig

if TYPE_CHECKING:
    from sim.model.force_law import ForceLaw


@dataclass(frozen=True)
class ViscousGuides(Effect):
    """``b v`` at each strut: damping that is there in air too.

    Grease thins as it is sheared, ``|v|^n`` with n from 0.4 to 1 (W. H. Herschel, R. Bulkley,
    Kolloid-Zeitschrift 39, 1926).
    """

    code = "S6"
    name = "viscous-guides"
    title = "Viscous friction below the dynamometer"
    stage = StageName.STRUCTURE

    viscous_n_s_m: float = parameter(
        2.0, 0.0, 50.0, "N s/m", "at each strut", one_sign=OneSign.DAMPING
    )
    speed_power: float = parameter(
        1.0, 0.3, 2.0, "1", "n, power of the speed", one_sign=OneSign.DAMPING, forms=(0.6,)
    )
    unlike: float = parameter(0.0, -1.0, 1.0, "1", UNLIKE, forms=(0.3,))

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with the friction at both struts."""
        law: ForceLaw = Viscous(self.viscous_n_s_m)
        if self.speed_power != 1.0:
            law = power_law(self.viscous_n_s_m, 1.0, self.speed_power, speed_m_s(rig))
        return at_both_struts(rig, law, self.unlike)

    def signature(self, situation: Situation) -> Signature:
        """Return ``i w b y`` of each strut; exact."""
        factor = 1j * situation.omega * self.viscous_n_s_m
        return at_struts(factor * situation.displacement(), 1)
