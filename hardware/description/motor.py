"""Motors with gear and speed loop, as a drive's data sheet and its settings state them.

All is referred to the crank shaft and written as deviation from the commanded motion: the command
is fed forward (voltage for the back-EMF of a shunt motor), so that without load and at constant
speed nothing deviates. Load is what the struts ask, and what the inertia asks during a ramp.
"""

from collections.abc import Hashable
from dataclasses import dataclass
from typing import Final, Protocol

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


class Motor(Hashable, Protocol):
    """What every motor states for the drive."""

    @property
    def cogging(self) -> tuple[Cogging, ...]:
        """Torques that vary with the angle."""
        ...

    @property
    def guides(self) -> Guides:
        """Friction of the struts' guides."""
        ...

    @property
    def shaft_inertia_kg_m2(self) -> float:
        """Of motor and gear, at the crank shaft."""
        ...

    def plant(self, added_inertia_kg_m2: float) -> tuple[FloatArray, FloatArray]:
        """Return A and B of the states (speed, current) under (command, load torque)."""
        ...

    @property
    def loop(self) -> SpeedLoop:
        """The speed controller."""
        ...


@dataclass(frozen=True)
class ShuntMotor:
    """A direct-current shunt motor at constant field, with a gear; 1 hp by default.

    Attributes
    ----------
    resistance_ohm, inductance_h, constant_v_s
        Of the armature; volts per rad/s and newton metres per ampere are the same number.
    inertia_kg_m2
        Of the rotor, at the motor.
    gear_ratio
        Turns of the motor per turn of the crank.
    gear_inertia_kg_m2, bearing_n_m_s
        Flywheel, gear and viscous bearings, at the crank.
    loop
        Nothing by default: the motor runs at its voltage and slows down under load.
    """

    resistance_ohm: float = 2.5
    inductance_h: float = 0.02
    constant_v_s: float = 1.1
    inertia_kg_m2: float = 0.012
    gear_ratio: float = 20.0
    gear_inertia_kg_m2: float = 0.5
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
        """Return A and B of the states (speed, current) under (voltage, load torque)."""
        inertia = self.shaft_inertia_kg_m2 + added_inertia_kg_m2
        constant = self.constant_v_s * self.gear_ratio
        resistance, inductance = self.resistance_ohm, self.inductance_h
        A = [
            [-self.bearing_n_m_s / inertia, constant / inertia],
            [-constant / inductance, -resistance / inductance],
        ]
        return np.array(A), np.array([[0.0, -1.0 / inertia], [1.0 / inductance, 0.0]])


@dataclass(frozen=True)
class Servo:
    """A servo motor with a current loop of its own, and a gear.

    Attributes
    ----------
    constant_n_m_a
        Torque per ampere, at the motor.
    current_loop_hz
        Bandwidth of the current loop, a first-order lag.
    """

    constant_n_m_a: float = 0.8
    current_loop_hz: float = 200.0
    inertia_kg_m2: float = 0.002
    gear_ratio: float = 20.0
    gear_inertia_kg_m2: float = 0.2
    bearing_n_m_s: float = 0.0
    loop: SpeedLoop = SpeedLoop(proportional=2.0, integral=10.0)
    cogging: tuple[Cogging, ...] = ()
    guides: Guides = Guides()

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED

    @property
    def shaft_inertia_kg_m2(self) -> float:
        """Of motor and gear, at the crank shaft."""
        return self.inertia_kg_m2 * self.gear_ratio**2 + self.gear_inertia_kg_m2

    def plant(self, added_inertia_kg_m2: float) -> tuple[FloatArray, FloatArray]:
        """Return A and B of the states (speed, current) under (current command, load torque)."""
        inertia = self.shaft_inertia_kg_m2 + added_inertia_kg_m2
        rate = 2.0 * np.pi * self.current_loop_hz
        constant = self.constant_n_m_a * self.gear_ratio
        A = [[-self.bearing_n_m_s / inertia, constant / inertia], [0.0, -rate]]
        return np.array(A), np.array([[0.0, -1.0 / inertia], [rate, 0.0]])
