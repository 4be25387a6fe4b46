"""D1b: a torque that varies with the shaft's angle, on a motor that yields to it."""

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.drive.motor import Cogging
from sim.drive.prescribed_drive import SpeedRipple
from sim.effects.effect import Effect, OneSign, Signature, StageName, parameter
from sim.effects.shaft import uneven_signature
from sim.effects.situation import Situation
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class TorqueCogging(Effect):
    """``T sin(k th + psi)`` against the motion moves the shaft by ``T/(J k^2 w^2)``.

    Like a ripple of the speed that falls with the frequency squared. Without a motor in the rig it
    is just that, of a shaft with this inertia: what the load does to such a shaft is load-ripple.
    """

    code: ClassVar[str] = "D1b"
    name: ClassVar[str] = "torque-cogging"
    title: ClassVar[str] = "Torque that varies with the shaft's angle"
    stage: ClassVar[StageName] = StageName.DRIVE

    torque_n_m: float = parameter(
        0.5, 0.0, 20.0, "N m", "amplitude of the torque, at the crank", one_sign=OneSign.AMPLITUDE
    )
    order: float = parameter(
        1.0,
        1.0,
        10.0,
        "1",
        "times a revolution, a whole number",
        starts=(1.0, 2.0, 3.0),
        held=True,
        one_sign=OneSign.COUNT,
    )
    phase_rad: float = parameter(0.0, -np.pi, np.pi, "rad", "phase at the shaft's zero")
    inertia_kg_m2: float = parameter(
        5.0,
        0.5,
        500.0,
        "kg m2",
        "of the motor, at the crank, where the rig has none",
        held=True,
        one_sign=OneSign.MASS,
    )

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with this torque on its motor, or with the ripple that it makes."""
        order, drive = round(self.order), rig.drive
        if drive.motor is not None:
            torque = Cogging(order, self.torque_n_m, self.phase_rad)
            motor = replace(drive.motor, cogging=(*drive.motor.cogging, torque))
            return replace(rig, drive=replace(drive, motor=motor))
        relative = order * self._angle_rad(2.0 * np.pi * set_point.frequency_hz)
        ripple = (*drive.ripple, SpeedRipple(order, relative, self.phase_rad))
        return replace(rig, drive=replace(drive, ripple=ripple))

    def signature(self, situation: Situation) -> Signature:
        """Return the modulated motion and the model's reaction, of a shaft that no load moves."""
        wave = -1j * self._angle_rad(situation.omega) * np.exp(1j * self.phase_rad)
        return uneven_signature(situation, {round(self.order): complex(wave)})

    def _angle_rad(self, omega_rad_s: float) -> float:
        """Return by how much the shaft is moved to either side."""
        return self.torque_n_m / (self.inertia_kg_m2 * (round(self.order) * omega_rad_s) ** 2)
