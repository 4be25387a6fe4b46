"""The drive of a strut that follows a path: cyclic synchronous position, a loop, a load.

The set-point that came before a SYNC is where the reference is at the next one; it goes there on
the parabola through this set-point and the two before. What moves follows it by a position loop
around a speed loop, against the force that the strut exerts on the model:

    x'' = kv e + ki integral of e dt - F / M,    e = r' + kp (r - x) - x'

with the reference r. Within a period r'' and F are constant, and the step is exact.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from hardware.axis_settings import PositionAxisSettings
from hardware.cia402 import DriveState, Mode, StatusWord
from hardware.description.arrays import FloatArray
from hardware.drive import MODE_DISPLAY, TARGET_POSITION
from sim.devices.axis_drive import AxisDrive
from sim.devices.network import Wire
from sim.devices.node import Number

Motion = tuple[float, float, float]  # displacement, velocity, acceleration of a strut
LATE_CODE: Final = 0x8250
SYNC_CODE: Final = 0x8700
_ALLOWED: Final = 1  # set-points or SYNCs in a row that the drive bridges on its parabola


@dataclass(frozen=True)
class PositionLoop:
    """A strut's drive: loop gains, and what it moves.

    Attributes
    ----------
    position_per_s, speed_per_s, integral_per_s2
        Gains kp, kv and ki.
    moved_kg
        M: strut, slide and the motor's rotor at the strut, without the model.
    """

    position_per_s: float = 30.0
    speed_per_s: float = 250.0
    integral_per_s2: float = 7800.0
    moved_kg: float = 300.0

    def step(self, period_s: float) -> tuple[FloatArray, FloatArray]:
        """Return what takes (x, x', integral of e) over a period, and (r, r', r'', F) in it."""
        from scipy.linalg import expm

        kp, kv, ki = self.position_per_s, self.speed_per_s, self.integral_per_s2
        error = np.array([-kp, -1.0, 0.0, kp, 1.0, 0.0, 0.0])
        rates = np.zeros((7, 7))
        rates[0, 1] = rates[3, 4] = rates[4, 5] = 1.0
        rates[1] = kv * error
        rates[1, 2] += ki
        rates[1, 6] -= 1.0 / self.moved_kg
        rates[2] = error
        exponential = expm(rates * period_s)
        return exponential[:3, :3], exponential[:3, 3:]


class StrutDrive(AxisDrive):
    """Moves one strut.

    Parameters
    ----------
    led
        Told the strut's true motion for the next sample, in every sample.
    load
        The force of the strut on the model now, in newtons.

    Attributes
    ----------
    late
        Fault: so many of the next set-points come after their SYNC.
    """

    modes = (Mode.CYCLIC_SYNCHRONOUS_POSITION, Mode.HOMING)

    def __init__(
        self,
        wire: Wire,
        name: str,
        settings: PositionAxisSettings,
        sample_rate_hz: float,
        position: float,
        led: Callable[[Motion], None],
        load: Callable[[], float],
        loop: PositionLoop,
    ) -> None:
        self.late = 0
        self._loop, self._load, self._led = loop, load, led
        self._own, self._given = loop.step(1.0 / sample_rate_hz)
        self._moved_to = np.array([position, 0.0, 0.0])
        self._reference = self._next = position
        self._way = self._bend = self._mean = 0.0
        self._following = False
        self._new = False
        self._missed = 0
        super().__init__(wire, name, settings, sample_rate_hz, position, _ignore_position)

    @property
    def standing(self) -> bool:
        """Whether the strut neither moves nor is told to."""
        still = abs(self._moved_to[1]) < _STILL_M_S
        return (still if self._following else True) and super().standing

    def commanded(self) -> None:
        """Take an RPDO: its set-point holds from the next SYNC on."""
        super().commanded()
        if self.values.get(MODE_DISPLAY) == Mode.CYCLIC_SYNCHRONOUS_POSITION:
            self._new = True

    def obey(self, control: int, risen: int) -> None:
        """Take homing's start; set-points count at SYNC."""
        if self.values[MODE_DISPLAY] == Mode.HOMING:
            self._leave()
            super().obey(control, risen)

    def ramp_down(self, deceleration: Number) -> None:
        """Decelerate to rest off the path."""
        self._leave()
        super().ramp_down(deceleration)

    def coast(self) -> None:
        """Leave the strut to its inertia and friction."""
        self._leave()
        super().coast()

    def move(self) -> None:
        """Go on by one sample."""
        led = self.values[MODE_DISPLAY] == Mode.CYCLIC_SYNCHRONOUS_POSITION
        if led and self.state is DriveState.OPERATION_ENABLED:
            self._follow()
        else:
            self._new = False
            before = self._speed
            super().move()
            gained = (self._speed - before) / self._dt
            self._led((self.position, self.speed, gained))

    def unblock(self) -> None:
        """Let the strut go from where it stands."""
        self._leave()
        super().unblock()

    def _leave(self) -> None:
        """Go on, for the ramps, from where the loop has brought the strut."""
        if self._following:
            self._following = False
            self._demand, self._speed = self.position, float(self._moved_to[1])

    def _follow(self) -> None:
        """Go to the newest set-point for a period."""
        if not self._following:
            self._following = True
            self._goal, self._speed, self._missed = None, 0.0, 0
            self._moved_to = np.array([self.position, 0.0, 0.0])
            self._reference = self._next = self.position
            self._way = self._bend = self._mean = 0.0
        if not self._bridged():
            return
        self.show_motion(float(self._moved_to[1]))
        self.bits = int(StatusWord.FOLLOWS_COMMAND)
        self.stray((self._reference - self.position) * self._per_unit)
        if self.state is DriveState.OPERATION_ENABLED:
            self._go_on()

    def _go_on(self) -> None:
        """Have the loop bring the strut to where it is at the next sample."""
        before, self._way = self._way, self._next - self._reference
        self._bend = self._way - before
        speed, gain = (before + self._way) / 2.0 / self._dt, self._bend / self._dt**2
        inputs = np.array([self._reference, speed, gain, self._load()])
        speed_before = float(self._moved_to[1])
        self._moved_to = self._own @ self._moved_to + self._given @ inputs
        self._reference = self._next
        if self.blocked:
            self._moved_to = np.array([self.position, 0.0, 0.0])
        self.position = float(self._moved_to[0])
        # What the loop does within a period is more than samples hold: the mean acceleration of
        # this period and of the one before, carried on to the sample, is what they hold.
        mean_before = self._mean
        self._mean = (float(self._moved_to[1]) - speed_before) / self._dt
        self._led((self.position, float(self._moved_to[1]), 1.5 * self._mean - 0.5 * mean_before))

    def _bridged(self) -> bool:
        """Take the newest set-point, or one on the parabola; tell whether the drive goes on."""
        new, self._new = self._new and not self.late, False
        self.late = max(self.late - 1, 0)
        heard = self.wire.synchronous
        if new and heard:
            self._missed = 0
            self._next = self.limited_position(self.values[TARGET_POSITION])
            return True
        self._missed += 1
        if self._missed > _ALLOWED:
            self.fault(LATE_CODE if heard else SYNC_CODE)
            super().move()
            self._led((self.position, self._speed, 0.0))
            return False
        self._next = self._reference + self._way + self._bend
        return True


_STILL_M_S = 1e-4


def _ignore_position(_position: float) -> None:
    """Stand where an axis tells its position alone: a strut tells its whole motion."""
