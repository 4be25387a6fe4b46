"""D1b: a torque that varies with the shaft's angle, on a motor that yields to it."""

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, Signature, StageName, parameter
from sim.effects.shaft import Yielding
from sim.effects.situation import Situation
from sim.motor import Cogging
from sim.rig import SimulatedRig

_HOLD_RAD_S = 0.3  # what brings the mean speed back of a motor that the rig does not have yet


@dataclass(frozen=True)
class TorqueCogging(Effect):
    """``T sin(k th + psi)`` against the motion moves the shaft by ``T/(J k^2 w^2)``.

    Like a ripple of the speed that falls with the frequency squared. A rig without a motor gets one
    of this inertia, which yields to the struts' load too: see load-ripple.
    """

    code: ClassVar[str] = "D1b"
    name: ClassVar[str] = "torque-cogging"
    title: ClassVar[str] = "Torque that varies with the shaft's angle"
    stage: ClassVar[StageName] = StageName.DRIVE

    torque_n_m: float = parameter(0.5, 0.0, 20.0, "N m", "amplitude of the torque, at the crank")
    order: float = parameter(1.0, 1.0, 10.0, "1", "times a revolution, a whole number")
    phase_rad: float = parameter(0.0, -np.pi, np.pi, "rad", "phase at the shaft's zero")
    inertia_kg_m2: float = parameter(
        5.0, 0.5, 500.0, "kg m2", "of the motor, at the crank, where the rig has none"
    )

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with this torque on its motor."""
        motor = self._shaft.motor() if rig.drive.motor is None else rig.drive.motor
        torque = Cogging(round(self.order), self.torque_n_m, self.phase_rad)
        motor = replace(motor, cogging=(*motor.cogging, torque))
        return replace(rig, drive=replace(rig.drive, motor=motor))

    def signature(self, situation: Situation) -> Signature:
        """Return the modulated motion and the model's reaction, against a drive that holds."""
        wave = -1j * self.torque_n_m * complex(np.exp(1j * self.phase_rad))
        return self._shaft.signature(situation, {round(self.order): wave})

    @property
    def _shaft(self) -> Yielding:
        inertia = self.inertia_kg_m2
        return Yielding(inertia, 2.0 * _HOLD_RAD_S * inertia, _HOLD_RAD_S**2 * inertia)
