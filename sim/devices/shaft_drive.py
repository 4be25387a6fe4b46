"""The drive of the shaft: profile velocity, encoder, touch probe."""

import math
from typing import Final

from hardware.cia402 import Mode, StatusWord
from hardware.dictionary import Entry
from hardware.drive import (
    POSITION,
    PROBE_EDGES,
    PROBE_POSITION,
    PROBE_STATUS,
    TARGET_VELOCITY,
    VELOCITY,
)
from hardware.shaft import ShaftSettings
from sim.devices.drive import (
    ACCELERATION,
    DECELERATION,
    QUICK_STOP_DECELERATION,
    SimulatedDrive,
    halting,
    wrapped,
)
from sim.devices.network import Wire
from sim.devices.node import Number
from sim.devices.plant import Passage, Plant
from sim.devices.profile import SpeedProfile

_FUNCTION, _SOURCE = Entry(0x60B8), Entry(0x60D0, 1)
_TOP_SPEED = Entry(0x607F)
_ON, _CONTINUOUS, _POSITIVE_EDGE = 0x01, 0x02, 0x10
_INPUT_1: Final = 1
_AT_ONCE: Final = 1e9  # rad/s2
_FORCED: Final = 60.0  # rad/s2: a drive that runs away
_REACHED, _STANDSTILL = int(StatusWord.TARGET_REACHED), int(StatusWord.STANDSTILL)


class ShaftDrive(SimulatedDrive):
    """Turns the plant's shaft."""

    modes = (Mode.PROFILE_VELOCITY,)

    def __init__(self, wire: Wire, name: str, settings: ShaftSettings, plant: Plant) -> None:
        self._plant = plant
        self._armed = self._limit = 0
        self._forced: tuple[float, bool] | None = None
        self._set_demand(plant.profile)
        self._counts_per_rad = settings.counts_per_turn / (2.0 * math.pi)
        self._per_rad_s = self._counts_per_rad * settings.velocity_per_count
        encoder = "recorded_shaft_angle"
        self._angle = encoder if plant.knows(encoder) else "shaft_angle"
        self._told: tuple[float, float] = (0.0, 0.0)
        super().__init__(wire, name, settings.node, settings.eds, plant.sample_rate_hz)
        self.move()

    @property
    def standing(self) -> bool:
        """Whether the shaft is told to stand, and the ramp down is over."""
        return self._demand.target_rad_s == 0.0 and self._arrived

    @property
    def speed(self) -> float:
        """How fast the shaft really turns, in Hz."""
        return self._plant.speed_rad_s / (2.0 * math.pi)

    def force(self, frequency_hz: float, *, dragged: bool) -> None:
        """Turn the shaft whatever is commanded, while there is torque; ``dragged``: always."""
        self._forced = (2.0 * math.pi * frequency_hz, dragged)
        if dragged or self.torque:
            self._turn(0.0, 0)

    @property
    def _arrived(self) -> bool:
        return self._plant.time_s >= self._arrives_s

    def obey(self, control: int, risen: int) -> None:
        """Follow the target velocity, or halt."""
        wanted = 0.0 if halting(control) else self.values[TARGET_VELOCITY] / self._per_rad_s
        top = abs(self.number(_TOP_SPEED) / self._per_rad_s)
        limited = min(max(wanted, -top), top) if top else wanted
        self._limit = int(StatusWord.INTERNAL_LIMIT) if limited != wanted else 0
        faster = abs(limited) > abs(self._demand.target_rad_s)
        self._turn(limited, self.number(ACCELERATION if faster else DECELERATION))

    def ramp_down(self, deceleration: Number) -> None:
        """Bring the shaft to rest."""
        self._turn(0.0, deceleration)

    def coast(self) -> None:
        """Leave the shaft to its inertia and friction."""
        if self._forced is not None and self._forced[1]:
            return
        self._told = (math.nan, math.nan)
        if not self.blocked:
            self._plant.coast()
            self._set_demand(self._plant.profile)

    def move(self) -> None:
        """Read the encoder; say whether the target is reached."""
        plant, values = self._plant, self.values
        values[POSITION] = wrapped(plant.value(self._angle) * self._counts_per_rad)
        values[VELOCITY] = round(plant.speed_rad_s * self._per_rad_s)
        arrived = self._arrived and not self.blocked
        self.bits = self._limit | (_REACHED if arrived else 0)
        if arrived and self._demand.target_rad_s == 0.0:
            self.bits |= _STANDSTILL
        if self.blocked:
            self._hold()

    def pulse(self, passage: Passage) -> None:
        """Take an edge at the touch probe's input."""
        function = self._armed
        wired = int(self.number(_SOURCE)) == _INPUT_1
        if not (wired and function & _ON and function & _POSITIVE_EDGE):
            return
        values = self.values
        values[PROBE_EDGES] = (int(self.number(PROBE_EDGES)) + 1) % 2**16
        if function & _CONTINUOUS or not int(self.number(PROBE_STATUS)) & 0x02:
            values[PROBE_POSITION] = wrapped(passage.angle_rad * self._counts_per_rad)
            values[PROBE_STATUS] = 0x03

    def written(self, at: Entry, value: Number) -> None:
        """Arm the probe: a new function is taken only after a zero."""
        if at == _FUNCTION and (value == 0 or self._armed == 0):
            self._armed = int(value)
            self.values[PROBE_STATUS] = self._armed & _ON

    def _begin(self) -> None:
        super()._begin()
        self._armed = self._limit = 0
        self.values[PROBE_EDGES] = self.values[PROBE_POSITION] = self.values[PROBE_STATUS] = 0

    def _turn(self, target_rad_s: float, deceleration: Number) -> None:
        """Command a speed; a repetition of the last command changes nothing."""
        acceleration = deceleration / abs(self._per_rad_s) if deceleration else _AT_ONCE
        if self._forced is not None:
            target_rad_s, acceleration = self._forced[0], _FORCED
        command = (target_rad_s, acceleration)
        if target_rad_s == self._demand.target_rad_s and (self._arrived or command == self._told):
            return
        self._told = command
        if self.blocked:
            self._set_demand(self._demand.then(self._plant.time_s, *command))
        else:
            self._plant.turn(*command)
            self._set_demand(self._plant.profile)

    def _set_demand(self, profile: SpeedProfile) -> None:
        self._demand = profile
        self._arrives_s = profile.start_s + profile.ramp_s

    def _hold(self) -> None:
        """Hold the shaft, blocked, while the demand runs away from it."""
        plant = self._plant
        if plant.profile.target_rad_s != 0.0:
            plant.turn(0.0, _AT_ONCE)
        now = plant.time_s
        angle_rad = plant.profile.angle_and_speed(now)[0]
        self.stray((self._demand.angle_and_speed(now)[0] - angle_rad) * self._counts_per_rad)

    def unblock(self) -> None:
        """Let the shaft go: the demand begins where it stands, or what forced it ends."""
        self.blocked = False
        if self._forced is not None:
            self._forced, self._told = None, (math.nan, math.nan)
            if self.torque:
                self.ramp_down(self.number(QUICK_STOP_DECELERATION))
            else:
                self.coast()
            return
        angle, _ = self._plant.profile.angle_and_speed(self._plant.time_s)
        self._set_demand(SpeedProfile(self._plant.time_s, angle))
