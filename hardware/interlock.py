"""The interlock: eccentricity and phase stay while the shaft turns, and the other way round.

Wrapped around whatever driver a rig has, so that no driver can forget it.
"""

from collections.abc import Callable, Sequence
from typing import Any, cast

from hardware.errors import HardwareError, InterlockError, NotReadyError
from hardware.roles import PositionAxis, Powered, Shaft

Faults = Callable[[], Sequence[HardwareError]]


class _Guarded:
    """Hands everything on to a device, but refuses commands while faults are latched."""

    def __init__(self, inner: Any, others: Sequence[Powered], faults: Faults) -> None:
        self._inner = inner
        self._others = others
        self._faults = faults

    def __getattr__(self, name: str) -> Any:
        return getattr(self._inner, name)

    def enable(self) -> None:
        """Enable, unless a fault is latched."""
        self._refuse_in_fault("enable")
        self._inner.enable()

    def _refuse_in_fault(self, what: str) -> None:
        faults = self._faults()
        if faults:
            raise NotReadyError(
                self._inner.name, f"cannot {what}: reset first what is latched ({faults[0]})"
            )

    def _refuse(self, what: str, limit: str) -> None:
        self._refuse_in_fault(what)
        moving = [other.name for other in self._others if other.moving]
        if moving:
            raise InterlockError(
                self._inner.name, f"cannot {what} while {' and '.join(moving)} {limit}"
            )


class _GuardedShaft(_Guarded):
    """A shaft that does not start while eccentricity or phase move."""

    def turn(self, frequency_hz: float) -> None:
        """Turn, if the axes stand still."""
        self._refuse(f"turn at {frequency_hz:g} Hz", "moves; let it arrive first")
        self._inner.turn(frequency_hz)


class _GuardedAxis(_Guarded):
    """An eccentricity or phase axis that stays while the shaft turns."""

    def home(self) -> None:
        """Home, if the shaft stands."""
        self._refuse("home", "turns; stop it first")
        self._inner.home()

    def move_to(self, position: float) -> None:
        """Move, if the shaft stands."""
        self._refuse(f"move to {position:g} {self._inner.unit}", "turns; stop it first")
        self._inner.move_to(position)


def guard_shaft(shaft: Shaft, axes: Sequence[PositionAxis], faults: Faults) -> Shaft:
    """Return the shaft behind the interlock."""
    return cast("Shaft", _GuardedShaft(shaft, axes, faults))


def guard_axis(axis: PositionAxis, shaft: Shaft | None, faults: Faults) -> PositionAxis:
    """Return an axis behind the interlock."""
    others = () if shaft is None else (shaft,)
    return cast("PositionAxis", _GuardedAxis(axis, others, faults))
