"""How a rig is left: at rest and without power, as far as its bus still carries anything."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Final

from hardware.errors import HardwareError, Reaction

if TYPE_CHECKING:
    from hardware.rig import Rig

_PROFILE_STOP_S: Final = 30.0  # for devices without a deadline of their own
_QUICK_STOP_S: Final = 2.0
_LAST_CYCLES: Final = 5  # for the drives to show that they have obeyed


def come_to_rest(rig: "Rig") -> None:
    """Stop the axes along their profile, take their power off, and wait for both.

    A severe fault on the way makes it a quick stop; a lost bus ends it at once, because its drives
    stop by themselves as soon as the heartbeat stays away. Nothing is raised: closing is often what
    an error has led to, and that error is the one to be told. The time is bounded in cycles.
    """
    if not rig.powered() or _is_lost(rig):
        return
    rate_hz = rig.configuration.sample_rate_hz
    if not _obeyed(rig, rig.stop, round(_PROFILE_STOP_S * rate_hz)):
        _obeyed(rig, rig.quick_stop, round(_QUICK_STOP_S * rate_hz))
    for one in rig.powered():
        one.disable()
    for _ in range(_LAST_CYCLES):
        if _is_lost(rig):
            return
        _cycle(rig)


def _obeyed(rig: "Rig", command: Callable[[], None], cycles: int) -> bool:
    """Give a command and tell whether all axes stand then, without a fault."""
    command()
    for _ in range(cycles):
        if not any(one.moving for one in rig.powered()):
            return True
        if _is_lost(rig) or not _cycle(rig):
            return False
    return False


def _cycle(rig: "Rig") -> bool:
    """Run a cycle; tell whether it went without a fault that asks for a quick stop."""
    try:
        rig.cycle()
    except HardwareError as error:
        return error.reaction < Reaction.QUICK_STOP
    return True


def _is_lost(rig: "Rig") -> bool:
    return any(one.reaction is Reaction.END_RUN for one in rig.faults)
