"""D3: a speed that varies with the load over a revolution."""

from dataclasses import dataclass, replace

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.drive.motor import droop
from sim.effects.effect import DeviationTrace, Effect, OneSign, Signature, StageName, parameter
from sim.effects.shaft import Yielding
from sim.effects.situation import Situation
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class LoadRipple(Effect):
    """The load torque, at twice the frequency, moves the shaft: ``y_3 = e^3 |Z_1|/(16 J w^2)``.

    As a force it grows with the amplitude cubed. At a strut phase of 90 degrees the torques of
    equal struts cancel, but for what one strut's motion asks of the other. Guides' friction is part
    of the torque. To first order in ``M e^2/J``. What holds the mean speed may swing, or creep.
    """

    code = "D3"
    name = "load-ripple"
    title = "Speed that varies with the load over a revolution"
    stage = StageName.DRIVE
    shows_in = (DeviationTrace.MOTION,)

    inertia_kg_m2: float = parameter(
        5.0, 0.5, 1e6, "kg m2", "motor, gear and flywheel, at crank", one_sign=OneSign.MASS
    )
    hold_hz: float = parameter(
        0.05,
        0.001,
        2.0,
        "Hz",
        "bandwidth of what brings the mean speed back",
        one_sign=OneSign.RATE,
    )
    damping_ratio: float = parameter(
        1.0, 0.1, 10.0, "1", "of it", one_sign=OneSign.DAMPING, forms=(0.5, 2.0)
    )

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with a motor of this inertia.

        A motor that the rig has and that droops goes on to do so.
        """
        old, shaft = rig.drive.motor, self._shaft
        if old is None:
            motor = shaft.motor()
        else:
            lost = -droop(old)
            held = shaft if lost == 0.0 else Yielding(self.inertia_kg_m2, 1.0 / lost)
            motor = replace(held.motor(), guides=old.guides, cogging=old.cogging)
        return replace(rig, drive=replace(rig.drive, motor=motor))

    def signature(self, situation: Situation) -> Signature:
        """Return the modulated motion and the model's reaction, against a drive that holds."""
        return self._shaft.signature(situation, {})

    @property
    def _shaft(self) -> Yielding:
        rate = 2.0 * np.pi * self.hold_hz
        inertia = self.inertia_kg_m2
        return Yielding(inertia, 2.0 * self.damping_ratio * rate * inertia, rate**2 * inertia)
