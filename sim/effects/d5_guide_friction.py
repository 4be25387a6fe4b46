"""D5: friction of the struts' guides above the dynamometers."""

from dataclasses import dataclass, replace

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, OneSign, Signature, StageName, parameter
from sim.effects.situation import Situation
from sim.effects.typical import power_share, speed_m_s
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class GuideFriction(Effect):
    """A torque, ``F_c e |cos|`` and ``b w e^2 cos^2`` a strut, and nothing in any force.

    What it does to the speed of a motor that yields is that motor's: see speed-droop and
    load-ripple. Oil takes a share of the friction over, which then goes with the speed; it loses as
    much at a typical motion.
    """

    code = "D5"
    name = "guide-friction"
    title = "Friction of the guides above the dynamometers"
    stage = StageName.DRIVE

    friction_n: float = parameter(
        5.0, 0.0, 50.0, "N", "friction force at each strut", one_sign=OneSign.FRICTION
    )
    viscous_n_s_m: float = parameter(
        0.0, 0.0, 200.0, "N s/m", "viscous friction at each strut", one_sign=OneSign.DAMPING
    )

    oil: float = parameter(
        0.0,
        0.0,
        1.0,
        "1",
        "share of the friction force that goes with the speed",
        one_sign=OneSign.SHARE,
        forms=(0.5,),
    )

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with the friction as a load of its shaft."""
        guides = rig.drive.guides
        viscous = self.viscous_n_s_m
        viscous += self.oil * self.friction_n * power_share(0.0) / speed_m_s(rig)
        more = replace(
            guides,
            coulomb_n=guides.coulomb_n + (1.0 - self.oil) * self.friction_n,
            viscous_n_s_m=guides.viscous_n_s_m + viscous,
        )
        return replace(rig, drive=replace(rig.drive, guides=more))

    def signature(self, situation: Situation) -> Signature:
        """Return no change: nothing is below the guides that could measure it."""
        return {}
