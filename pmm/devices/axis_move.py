"""One axis moved by hand, within its limits and behind the interlock."""

from typing import Final

from hardware.command_limits import check_position, check_speed
from hardware.description.errors import ConfigurationError
from hardware.rig import Rig
from hardware.roles import PositionAxis, Reading, Shaft

NOTHING_MOVED: Final = "; nothing was moved"
_AXES: Final = ("eccentricity", "phase")
_ENABLE_S: Final = 5.0
_PATIENCE_S: Final = 600.0  # a person may be at the dial; drives have deadlines of their own
_LOOK_CYCLES: Final = 5


def axis_of(rig: Rig, name: str) -> PositionAxis:
    """Return an axis by its table's name.

    Raises
    ------
    ConfigurationError
        If the rig has none of that name.
    """
    axes: dict[str, PositionAxis] = {
        key: axis for key in _AXES if (axis := getattr(rig, key)) is not None
    } | rig.angles
    if name not in axes:
        choices = ", ".join(axes) or "none"
        raise ConfigurationError(
            f"no axis {name!r} that moves to a position; the rig has {choices}"
        )
    return axes[name]


def look(rig: Rig) -> None:
    """Let a few cycles pass, so that every device has said where it stands."""
    for _ in range(_LOOK_CYCLES):
        rig.cycle()


def move(rig: Rig, axis: PositionAxis, position: float) -> Reading:
    """Put the axis under power, home it if it is not, and move it; return where it is then.

    Raises
    ------
    LimitError, InterlockError
        If the position is beyond the limits, or the shaft turns.
    HardwareError
        What the drives report on the way.
    """
    check_position(axis, position, remark=NOTHING_MOVED)
    rate_hz = rig.configuration.sample_rate_hz
    axis.enable()
    rig.run_until(lambda: axis.enabled, round(_ENABLE_S * rate_hz), f"{axis.name} enables")
    patience = round(_PATIENCE_S * rate_hz)
    if not axis.homed:
        axis.home()
        rig.run_until(lambda: axis.homed and not axis.moving, patience, f"{axis.name} homes")
    axis.move_to(position)
    rig.run_until(lambda: axis.settled, patience, f"{axis.name} arrives")
    reading = axis.reading
    if reading is None:  # a driver that has settled without knowing where
        raise ConfigurationError(f"{axis.name}: settled without a reading; its driver is wrong")
    return reading


def turn(rig: Rig, shaft: Shaft, frequency_hz: float) -> None:
    """Put the shaft under power and run it up to a speed; raises as :func:`move`."""
    check_speed(shaft, frequency_hz, remark=NOTHING_MOVED)
    rate_hz = rig.configuration.sample_rate_hz
    shaft.enable()
    rig.run_until(lambda: shaft.enabled, round(_ENABLE_S * rate_hz), f"{shaft.name} enables")
    shaft.turn(frequency_hz)
    patience = round(_PATIENCE_S * rate_hz)
    rig.run_until(lambda: shaft.at_speed, patience, f"{shaft.name} reaches {frequency_hz:g} Hz")
