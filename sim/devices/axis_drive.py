"""The drives of eccentricity and phase: profile position and homing."""

import math
from collections.abc import Callable

from hardware.axis_settings import PositionAxisSettings
from hardware.cia402 import ControlWord, DriveState, Mode, StatusWord
from hardware.dictionary import Entry
from hardware.drive import MODE_DISPLAY, POSITION, TARGET_POSITION, VELOCITY
from sim.devices.drive import ACCELERATION, DECELERATION, SimulatedDrive, halting, wrapped
from sim.devices.network import Wire
from sim.devices.node import Number

_TOP_SPEED = Entry(0x607F)
_SPEED, _HOME_OFFSET, _METHOD = Entry(0x6081), Entry(0x607C), Entry(0x6098)
_LOWEST, _HIGHEST = Entry(0x607D, 1), Entry(0x607D, 2)
_HOMING_SPEED, _HOMING_ACCELERATION = Entry(0x6099, 1), Entry(0x609A)
_HERE = (35, 37)  # methods that take the present position
_COASTS_S = 0.5  # from its speed to rest without torque: a spindle's inertia in its dry friction


class AxisDrive(SimulatedDrive):
    """Moves one setting of the linkage.

    Parameters
    ----------
    position
        Where the axis really is at power-on, in its unit; the drive does not know before homing.
    moved
        Told the axis's true position whenever it changes.
    """

    modes = (Mode.PROFILE_POSITION, Mode.HOMING)

    def __init__(
        self,
        wire: Wire,
        name: str,
        settings: PositionAxisSettings,
        sample_rate_hz: float,
        position: float,
        moved: Callable[[float], None],
    ) -> None:
        self.position = position
        self._moved = moved
        self._demand = position
        self._goal: float | None = None
        self._speed = self._top = self._slope = 0.0
        self._friction = settings.speed / _COASTS_S
        self._reference = settings.home_position
        self._per_unit = settings.counts_per_unit
        self._per_speed = abs(settings.counts_per_unit) * settings.velocity_per_count
        self._dt = 1.0 / sample_rate_hz
        super().__init__(wire, name, settings.node, settings.eds, sample_rate_hz)

    @property
    def standing(self) -> bool:
        """Whether the axis neither moves nor is told to."""
        return self._goal is None and self._speed == 0.0

    @property
    def speed(self) -> float:
        """How fast the axis really moves, in its unit per second."""
        return 0.0 if self.blocked else self._speed

    def obey(self, control: int, risen: int) -> None:
        """Take a set-point or start homing."""
        if halting(control):
            self.ramp_down(self.number(DECELERATION))
        elif self.values[MODE_DISPLAY] == Mode.HOMING:
            if risen & ControlWord.START_HOMING:
                self._home()
        elif risen & ControlWord.NEW_SET_POINT:
            self._take_set_point()
        elif not control & ControlWord.NEW_SET_POINT:
            self.bits &= ~StatusWord.SET_POINT_ACKNOWLEDGED

    def ramp_down(self, deceleration: Number) -> None:
        """Decelerate to rest where it is."""
        self._goal = None
        self._slope = deceleration / self._per_speed

    def coast(self) -> None:
        """Leave the axis to its inertia and friction."""
        self._goal, self._slope = None, self._friction

    def move(self) -> None:
        """Go on by one sample."""
        if self._goal is None and self._speed == 0.0 and not self.blocked:
            return
        if not self.standing:
            self._step()
            if not self.blocked:
                self.position = self._demand
                self._moved(self.position)
            if self._goal == self._demand and self.state is DriveState.OPERATION_ENABLED:
                self._arrive()
        self.show_motion(self._speed)
        if self.blocked:
            self.stray((self._demand - self.position) * self._per_unit)

    def show_motion(self, speed: float) -> None:
        """Bring position and velocity up to date."""
        values, sense = self.values, math.copysign(1.0, self._per_unit)
        values[POSITION] = wrapped(self.position * self._per_unit + self._shift)
        values[VELOCITY] = round(speed * self._per_speed * sense)

    def limited_position(self, counts: Number) -> float:
        """Return where a set-point leads, the position limits kept."""
        low, high = self.number(_LOWEST), self.number(_HIGHEST)
        limited = min(max(counts, low), high) if low < high else counts
        if limited != counts:
            self.bits |= StatusWord.INTERNAL_LIMIT
        return (limited - self._shift) / self._per_unit

    def unblock(self) -> None:
        """Let the axis go: the demand begins where it stands."""
        self.blocked, self._goal, self._speed = False, None, 0.0
        self._demand = self.position

    def _begin(self) -> None:
        super()._begin()
        self._shift = -self.position * self._per_unit  # at power-on the drive counts from 0

    def _take_set_point(self) -> None:
        self.bits = int(StatusWord.SET_POINT_ACKNOWLEDGED)
        self._go(self.limited_position(self.values[TARGET_POSITION]), _SPEED, ACCELERATION)

    def _home(self) -> None:
        self.bits = 0
        is_here = int(self.number(_METHOD)) in _HERE
        goal = self._demand if is_here else self._reference
        self._go(goal, _HOMING_SPEED, _HOMING_ACCELERATION)

    def _go(self, goal: float, speed: Entry, acceleration: Entry) -> None:
        self._goal = goal
        self._top = min(self.number(speed), self.number(_TOP_SPEED)) / self._per_speed
        self._slope = self.number(acceleration) / self._per_speed

    def _step(self) -> None:
        """Go on by one sample on a trapezoid that ends at the goal."""
        dt, slope = self._dt, self._slope
        if self._goal is None:
            self._speed = math.copysign(max(abs(self._speed) - slope * dt, 0.0), self._speed)
            self._demand += self._speed * dt
            return
        way = self._goal - self._demand
        distance = abs(way)
        fastest = min(self._top, abs(self._speed) + slope * dt, math.sqrt(2.0 * slope * distance))
        if fastest * dt >= distance or distance < 1e-3 / abs(self._per_unit):
            self._demand, self._speed = self._goal, 0.0
        else:
            self._speed = math.copysign(fastest, way)
            self._demand += self._speed * dt

    def _arrive(self) -> None:
        self._goal = None
        self.bits |= StatusWord.TARGET_REACHED
        if self.values[MODE_DISPLAY] == Mode.HOMING:
            self.bits |= StatusWord.HOMING_ATTAINED
            self._shift = self.number(_HOME_OFFSET) - self._demand * self._per_unit
