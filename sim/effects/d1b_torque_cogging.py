"""D1b: a torque that varies with the shaft's angle, on a motor that yields to it."""

from dataclasses import dataclass, replace

import numpy as np

from hardware.description.motor import Cogging
from hardware.description.setpoint import SetPoint
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
    Poles and slots make no pure sine: its double is beside it.
    """

    code = "D1b"
    name = "torque-cogging"
    title = "Torque that varies with the shaft's angle"
    stage = StageName.DRIVE

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

    double: float = parameter(
        0.0,
        0.0,
        1.0,
        "1",
        "torque at twice the order, over that at the order",
        held=True,
        one_sign=OneSign.AMPLITUDE,
    )
    double_phase_rad: float = parameter(
        0.0, -np.pi, np.pi, "rad", "its phase at the shaft's zero", held=True
    )

    def forms(self) -> tuple[Effect, ...]:
        """Return waves that are no sine: a third at twice the order, in two phases."""
        with_double = replace(self, double=0.3)
        return (with_double, replace(with_double, double_phase_rad=np.pi / 2.0))

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with this torque on its motor, or with the ripple that it makes."""
        waves, drive = self._waves, rig.drive
        if drive.motor is not None:
            motor = replace(drive.motor, cogging=(*drive.motor.cogging, *waves))
            return replace(rig, drive=replace(drive, motor=motor))
        omega = 2.0 * np.pi * set_point.frequency_hz
        ripples = [
            SpeedRipple(wave.order, wave.order * self._angle_rad(wave, omega), wave.phase_rad)
            for wave in waves
        ]
        return replace(rig, drive=replace(drive, ripple=(*drive.ripple, *ripples)))

    def signature(self, situation: Situation) -> Signature:
        """Return the modulated motion and the model's reaction, of a shaft that no load moves."""
        angle = self._angle_rad(self._waves[0], situation.omega)
        wave = -1j * angle * np.exp(1j * self.phase_rad)
        return uneven_signature(situation, {round(self.order): complex(wave)})

    @property
    def _waves(self) -> tuple[Cogging, ...]:
        """The torque, and its double if there is one."""
        order = round(self.order)
        first = Cogging(order, self.torque_n_m, self.phase_rad)
        if not self.double:
            return (first,)
        return first, Cogging(2 * order, self.double * self.torque_n_m, self.double_phase_rad)

    def _angle_rad(self, wave: Cogging, omega_rad_s: float) -> float:
        """Return by how much the shaft is moved to either side."""
        return wave.torque_n_m / (self.inertia_kg_m2 * (wave.order * omega_rad_s) ** 2)
