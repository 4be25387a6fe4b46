"""The speed that a drive is told: a ramp, then constant, as a function of time alone."""

import math
from dataclasses import dataclass, field, fields

import numpy as np

from hardware.description.arrays import FloatArray
from sim.drive.prescribed_drive import DriveSettings, ShaftMotion


@dataclass(frozen=True)
class SpeedProfile:
    """A shaft that runs from one speed to another at a constant acceleration, and goes on at it.

    Attributes
    ----------
    start_s, angle_rad, speed_rad_s
        When and where the ramp begins, and at what speed.
    target_rad_s, acceleration_rad_s2
        Where the ramp ends (any sign), and how steep it is (above 0).
    """

    start_s: float = 0.0
    angle_rad: float = 0.0
    speed_rad_s: float = 0.0
    target_rad_s: float = 0.0
    acceleration_rad_s2: float = 1.0

    @property
    def ramp_s(self) -> float:
        """Duration of the ramp."""
        return abs(self.target_rad_s - self.speed_rad_s) / self.acceleration_rad_s2

    def at(self, time_s: FloatArray) -> ShaftMotion:
        """Return angle, speed and acceleration at each time, none before the start."""
        since = time_s - self.start_s
        in_ramp = np.minimum(since, self.ramp_s)
        slope = math.copysign(self.acceleration_rad_s2, self.target_rad_s - self.speed_rad_s)
        angle = self.angle_rad + (self.speed_rad_s + slope / 2.0 * in_ramp) * in_ramp
        ramping = since < self.ramp_s
        return ShaftMotion(
            angle + self.target_rad_s * (since - in_ramp),
            np.where(ramping, self.speed_rad_s + slope * in_ramp, self.target_rad_s),
            np.where(ramping, slope, 0.0),
        )

    def angle_and_speed(self, time_s: float) -> tuple[float, float]:
        """Return both at one time."""
        shaft = self.at(np.array([time_s]))
        return float(shaft.angle[0]), float(shaft.speed[0])

    def then(
        self, time_s: float, target_rad_s: float, acceleration_rad_s2: float
    ) -> "SpeedProfile":
        """Return what follows if another speed is commanded at ``time_s``."""
        angle, speed = self.angle_and_speed(time_s)
        return SpeedProfile(time_s, angle, speed, target_rad_s, acceleration_rad_s2)

    def without_torque(self, time_s: float, friction: "Friction") -> "Coasting":
        """Return what follows if the torque is taken off at ``time_s``."""
        angle, speed = self.angle_and_speed(time_s)
        return Coasting(time_s, angle, speed, friction=friction)


@dataclass(frozen=True)
class Friction:
    """What slows an axis whose drive makes no torque.

    Attributes
    ----------
    time_constant_s
        Inertia over viscous friction (water, oil): the speed falls to 1/e in it.
    deceleration
        By dry friction (seals, gears), in the axis's unit per second squared.
    """

    time_constant_s: float
    deceleration: float

    def stops_after_s(self, speed: float) -> float:
        """Return how long an axis coasts from a speed to rest."""
        dry = self.deceleration * self.time_constant_s
        return self.time_constant_s * math.log1p(abs(speed) / dry)


@dataclass(frozen=True)
class Coasting(SpeedProfile):
    """A shaft without torque: viscous and dry friction bring it to rest; ``target`` is 0."""

    friction: Friction = field(default_factory=lambda: Friction(1.0, 1.0))

    @property
    def ramp_s(self) -> float:
        """Time from the loss of torque to rest."""
        return self.friction.stops_after_s(self.speed_rad_s)

    def at(self, time_s: FloatArray) -> ShaftMotion:
        """Return angle, speed and acceleration at each time, none before the start."""
        tau = self.friction.time_constant_s
        dry = math.copysign(self.friction.deceleration * tau, self.speed_rad_s)
        since = np.minimum(time_s - self.start_s, self.ramp_s)
        decay = np.exp(-since / tau)
        coasting = time_s - self.start_s < self.ramp_s
        return ShaftMotion(
            self.angle_rad + (self.speed_rad_s + dry) * tau * (1.0 - decay) - dry * since,
            np.where(coasting, (self.speed_rad_s + dry) * decay - dry, 0.0),
            np.where(coasting, -(self.speed_rad_s + dry) * decay / tau, 0.0),
        )


@dataclass(frozen=True)
class ProfiledDrive(DriveSettings):
    """A drive of the chain that follows a profile in place of the run's set frequency."""

    profile: SpeedProfile = field(default_factory=SpeedProfile)

    def commanded(self, set_hz: float, time_s: FloatArray) -> ShaftMotion:
        """Return the motion that the drive is told to make, its ripple and speed error included."""
        motion, share = self.profile.at(time_s), 1.0 + self.speed_error
        return self._rippled(
            ShaftMotion(
                self.initial_angle_rad + share * motion.angle,
                share * motion.speed,
                share * motion.acceleration,
            )
        )


def following(settings: DriveSettings, profile: SpeedProfile) -> ProfiledDrive:
    """Return a drive as it is in ``settings``, but told by a profile."""
    values = {item.name: getattr(settings, item.name) for item in fields(DriveSettings)}
    return ProfiledDrive(**values, profile=profile)
