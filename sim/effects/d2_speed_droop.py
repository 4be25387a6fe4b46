"""D2: a mean speed that falls under load."""

from dataclasses import dataclass, replace

from hardware.description.setpoint import SetPoint
from sim.drive.motor import droop
from sim.effects.effect import DeviationTrace, Effect, OneSign, Signature, StageName, parameter
from sim.effects.shaft import Yielding
from sim.effects.situation import Situation
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class SpeedDroop(Effect):
    """The speed falls by the droop times the mean torque, ``B w e^2/2 + 2 e F_c/pi`` a strut.

    Who analyses at the measured period sees a frequency that is not as set; who uses the set speed
    sees ``2 M w dw e``. Present in water more than in air. A flywheel leaves little of the ripple
    at twice the frequency, which is part of the prediction.
    """

    code = "D2"
    name = "speed-droop"
    title = "Mean speed that falls under load"
    stage = StageName.DRIVE
    shows_in = (DeviationTrace.MOTION,)

    droop_rad_s_n_m: float = parameter(
        0.02,
        1e-7,
        0.5,
        "rad/(s N m)",
        "speed lost per mean torque",
        one_sign="a motor that a load made faster would run away",
    )
    inertia_kg_m2: float = parameter(
        20.0,
        0.5,
        1e5,
        "kg m2",
        "of the flywheel, where the rig says nothing of its motor",
        one_sign=OneSign.MASS,
    )

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with a motor that nothing brings back to its speed.

        A motor that the rig has keeps its inertia, and its droop is added to.
        """
        old = rig.drive.motor
        inertia = self.inertia_kg_m2 if old is None else old.shaft_inertia_kg_m2
        total_droop = self.droop_rad_s_n_m + (0.0 if old is None else -droop(old))
        motor = Yielding(inertia, 1.0 / total_droop).motor()
        if old is not None:
            motor = replace(motor, guides=old.guides, cogging=old.cogging)
        return replace(rig, drive=replace(rig.drive, motor=motor))

    def signature(self, situation: Situation) -> Signature:
        """Return what slower turning does to the model, against a drive that holds its speed."""
        return Yielding(self.inertia_kg_m2, 1.0 / self.droop_rad_s_n_m).signature(situation, {})
