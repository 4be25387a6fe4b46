"""Commands against the limits of the axis or shaft that they are for, and whether it may move."""

from hardware.errors import LimitError, NotReadyError
from hardware.roles import PositionAxis, Powered, Shaft


def check_position(axis: PositionAxis, position: float, *, remark: str = "") -> None:
    """Refuse a position beyond an axis's limits, or that is no number.

    Parameters
    ----------
    remark
        What is said besides the value and the limits.

    Raises
    ------
    LimitError
        With value and limits.
    """
    if position not in axis.limits:
        raise LimitError(
            axis.name,
            f"{position:g} {axis.unit} is outside {axis.limits.low:g} to {axis.limits.high:g} "
            f"{axis.unit}{remark}",
        )


def check_enabled(device: Powered) -> None:
    """Refuse a command to a device that is not under power.

    Raises
    ------
    NotReadyError
        If it is not enabled.
    """
    if not device.enabled:
        raise NotReadyError(device.name, "is not enabled; enable it first")


def check_move(axis: PositionAxis, position: float) -> None:
    """Refuse a move as :func:`check_position` and :func:`check_enabled`, and before homing.

    Raises
    ------
    LimitError, NotReadyError
        As these two; the latter if it does not know where it is, too.
    """
    check_position(axis, position)
    check_enabled(axis)
    if not axis.homed:
        raise NotReadyError(axis.name, "is not homed; home it before it moves")


def check_speed(shaft: Shaft, frequency_hz: float, *, remark: str = "") -> None:
    """Refuse a shaft speed outside its limits, or not above 0; raises LimitError."""
    low, high = shaft.frequency_hz.low, shaft.frequency_hz.high
    if not (frequency_hz > 0.0 and frequency_hz in shaft.frequency_hz):
        raise LimitError(
            shaft.name,
            f"{frequency_hz:g} Hz is outside {low:g} to {high:g} Hz (and above 0){remark}",
        )
