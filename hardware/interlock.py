"""The interlock: what is set stays while shaft or carriage move, and the other way round.

Wrapped around whatever driver a rig has, so that no driver can forget it.
"""

from collections.abc import Callable, Sequence
from typing import Any, Final, cast

from hardware.errors import HardwareError, InterlockError, NotReadyError
from hardware.roles import Carriage, PositionAxis, Powered, Shaft

_RUNS: Final = "moves; stop it first"
Faults = Callable[[], Sequence[HardwareError]]


class _Guarded:
    """Hands everything on to a device, but refuses commands while faults are latched."""

    def __init__(self, inner: Any, devices: Sequence[Powered], faults: Faults) -> None:
        self._inner = inner
        self._others = devices
        self._faults = faults

    def __getattr__(self, name: str) -> Any:
        return getattr(self._inner, name)

    def enable(self) -> None:
        """Enable, unless a fault is latched."""
        self._refuse_in_fault("enable")
        self._inner.enable()

    def _refuse_in_fault(self, command: str) -> None:
        faults = self._faults()
        if faults:
            raise NotReadyError(
                self._inner.name, f"cannot {command}: reset first what is latched ({faults[0]})"
            )

    def _refuse(self, command: str, limit: str) -> None:
        self._refuse_in_fault(command)
        moving = [device.name for device in self._others if device.moving]
        if moving:
            raise InterlockError(
                self._inner.name, f"cannot {command} while {' and '.join(moving)} {limit}"
            )


class _GuardedShaft(_Guarded):
    """A shaft that does not start while eccentricity or phase move."""

    def turn(self, frequency_hz: float) -> None:
        """Turn, if the axes stand still."""
        self._refuse(f"turn at {frequency_hz:g} Hz", "moves; let it arrive first")
        self._inner.turn(frequency_hz)


class _GuardedCarriage(_Guarded):
    """A carriage that does not start while an axis moves."""

    def run_at(self, speed_m_s: float, turn_rate_rad_s: float = 0.0) -> None:
        """Run, if the axes stand still."""
        self._refuse(f"run at {speed_m_s:g} m/s", "moves; let it arrive first")
        self._inner.run_at(speed_m_s, turn_rate_rad_s)

    def go_back(self) -> None:
        """Go back, if nothing is latched."""
        self._refuse("go back", "moves; let it arrive first")
        self._inner.go_back()


class _GuardedAxis(_Guarded):
    """An axis that stays while the shaft turns or the carriage runs."""

    def home(self) -> None:
        """Home, if both stand."""
        self._refuse("home", _RUNS)
        self._inner.home()

    def move_to(self, position: float) -> None:
        """Move, if both stand."""
        self._refuse(f"move to {position:g} {self._inner.unit}", _RUNS)
        self._inner.move_to(position)


def guard_shaft(shaft: Shaft, axes: Sequence[PositionAxis], faults: Faults) -> Shaft:
    """Return a shaft that refuses to turn while an axis moves or a fault is latched."""
    return cast("Shaft", _GuardedShaft(shaft, axes, faults))


def guard_carriage(carriage: Carriage, axes: Sequence[PositionAxis], faults: Faults) -> Carriage:
    """Return a carriage that refuses to run while an axis moves or a fault is latched."""
    return cast("Carriage", _GuardedCarriage(carriage, axes, faults))


def guard_axis(axis: PositionAxis, drives: Sequence[Powered], faults: Faults) -> PositionAxis:
    """Return an axis behind the interlock; ``drives`` are shaft and carriage, if there."""
    return cast("PositionAxis", _GuardedAxis(axis, drives, faults))
