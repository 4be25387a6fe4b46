"""Motors with gear and speed loop, as a drive's data sheet and its settings state them.

All is referred to the crank shaft and written as deviation from the commanded motion: the command
is fed forward (voltage for the back-EMF of a shunt motor), so that without load and at constant
speed nothing deviates. Load is what the struts ask, and what the inertia asks during a ramp.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Final

import numpy as np

from hardware.description.arrays import FloatArray

# Parameter classes carry this as ``__pydantic_config__``: whoever validates one from a
# configuration file refuses a key that the class does not have.
UNKNOWN_KEYS_REFUSED: Final = {"extra": "forbid"}


@dataclass(frozen=True)
class SpeedLoop:
    """A controller of the speed: proportional and integral.

    Attributes
    ----------
    proportional
        V s/rad for a shunt motor, A s/rad for a servo, of the crank shaft's speed.
    integral
        V/rad, or A/rad.
    """

    proportional: float = 0.0
    integral: float = 0.0

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED


@dataclass(frozen=True)
class Cogging:
    """A torque that varies with the shaft's angle: ``T sin(k th + psi)`` against the motion."""

    order: int
    torque_n_m: float
    phase_rad: float = 0.0

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED


@dataclass(frozen=True)
class Guides:
    """Friction of the struts' guides above the dynamometers: torque only, no force is measured."""

    coulomb_n: float = 0.0
    viscous_n_s_m: float = 0.0

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED


@dataclass(frozen=True)
class Motor(ABC):
    """A motor with its gear and its speed loop.

    Attributes
    ----------
    inertia_kg_m2
        Of the rotor, at the motor.
    gear_ratio
        Turns of the motor per turn of the crank.
    gear_inertia_kg_m2, bearing_n_m_s
        Flywheel, gear and viscous bearings, at the crank.
    loop
        The speed controller; all zero where the motor runs at what is fed forward.
    cogging
        Torques that vary with the shaft's angle.
    guides
        Friction of the struts' guides.
    """

    inertia_kg_m2: float
    gear_ratio: float = 20.0
    gear_inertia_kg_m2: float = 0.0
    bearing_n_m_s: float = 0.0
    loop: SpeedLoop = SpeedLoop()
    cogging: tuple[Cogging, ...] = ()
    guides: Guides = Guides()

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED

    @property
    def shaft_inertia_kg_m2(self) -> float:
        """Of motor and gear, at the crank shaft."""
        return self.inertia_kg_m2 * self.gear_ratio**2 + self.gear_inertia_kg_m2

    def plant(self, added_inertia_kg_m2: float) -> tuple[FloatArray, FloatArray]:
        """Return A and B of the states (speed, current) under (command, load torque)."""
        inertia = self.shaft_inertia_kg_m2 + added_inertia_kg_m2
        torque, by_speed, by_current, by_command = self._electric()
        A = [
            [-self.bearing_n_m_s / inertia, torque * self.gear_ratio / inertia],
            [by_speed * self.gear_ratio, by_current],
        ]
        return np.array(A), np.array([[0.0, -1.0 / inertia], [by_command, 0.0]])

    @abstractmethod
    def _electric(self) -> tuple[float, float, float, float]:
        """Return torque per ampere, and what speed, current and command add to the current.

        Torque and speed are the motor's own; the last three are rates, per second.
        """


@dataclass(frozen=True)
class ShuntMotor(Motor):
    """A direct-current shunt motor at constant field, with a gear; 1 hp by default.

    Its command is a voltage. Without gains it runs at its voltage and slows down under load.

    Attributes
    ----------
    resistance_ohm, inductance_h, constant_v_s
        Of the armature; volts per rad/s and newton metres per ampere are the same number.
    """

    inertia_kg_m2: float = 0.012
    gear_inertia_kg_m2: float = 0.5
    resistance_ohm: float = 2.5
    inductance_h: float = 0.02
    constant_v_s: float = 1.1

    def _electric(self) -> tuple[float, float, float, float]:
        inductance_h = self.inductance_h
        return (
            self.constant_v_s,
            -self.constant_v_s / inductance_h,
            -self.resistance_ohm / inductance_h,
            1.0 / inductance_h,
        )


@dataclass(frozen=True)
class Servo(Motor):
    """A servo motor with a current loop of its own, and a gear; its command is a current.

    Attributes
    ----------
    constant_n_m_a
        Torque per ampere, at the motor.
    current_loop_hz
        Bandwidth of the current loop, a first-order lag.
    """

    inertia_kg_m2: float = 0.002
    gear_inertia_kg_m2: float = 0.2
    loop: SpeedLoop = SpeedLoop(proportional=2.0, integral=10.0)
    constant_n_m_a: float = 0.8
    current_loop_hz: float = 200.0

    def _electric(self) -> tuple[float, float, float, float]:
        rate = 2.0 * np.pi * self.current_loop_hz
        return self.constant_n_m_a, 0.0, -rate, rate
