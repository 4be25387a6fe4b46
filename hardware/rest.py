"""How a rig is left: at rest and without power, as far as its bus still carries anything."""

from typing import Final, Protocol

from hardware.errors import HardwareError, Reaction
from hardware.limits import REST_DEADLINE_S
from hardware.rig_configuration import RigConfiguration
from hardware.roles import Powered

_PROFILE_STOP_S: Final = 30.0  # for devices without a deadline of their own
_LAST_CYCLES: Final = 5  # for the drives to show that they have obeyed


class Moving(Protocol):
    """A rig in operation, as far as it takes to bring it to rest."""

    configuration: RigConfiguration
    faults: list[HardwareError]

    def powered(self) -> tuple[Powered, ...]:
        """Return the devices with power that are to be without it."""

    def stop(self) -> None:
        """Stop the axes along their profile."""

    def cycle(self) -> object:
        """Run one cycle of the loop."""


def come_to_rest(rig: Moving) -> None:
    """Stop the axes along their profile, take their power off, and wait for both.

    A severe fault on the way, or a profile that does not come to its end, makes it a quick stop,
    with which every drive begins that is to be without power; a lost bus ends it at once, because
    its drives stop by themselves as soon as the heartbeat stays away. Nothing is raised: closing is
    often what an error has led to, and that error is the one to be told. The time is bounded in
    cycles.
    """
    if not rig.powered() or _is_lost(rig):
        return
    rate_hz = rig.configuration.sample_rate_hz
    if not any(fault.reaction >= Reaction.QUICK_STOP for fault in rig.faults):
        rig.stop()
        _wait(rig, round(_PROFILE_STOP_S * rate_hz), gently=True)
    for axis in rig.powered():
        axis.disable()
    _wait(rig, round(REST_DEADLINE_S * rate_hz))
    for _ in range(_LAST_CYCLES):
        if _is_lost(rig):
            return
        _cycle(rig)


def _wait(rig: Moving, cycles: int, *, gently: bool = False) -> None:
    """Wait until nothing moves, or the bus is lost; ``gently`` no longer than to the next fault."""
    for _ in range(cycles):
        moves = any(axis.moving for axis in rig.powered())
        if not moves or _is_lost(rig) or (not _cycle(rig) and gently):
            return


def _cycle(rig: Moving) -> bool:
    """Run a cycle; tell whether it went without a fault that asks for a quick stop."""
    try:
        rig.cycle()
    except HardwareError as error:
        return error.reaction < Reaction.QUICK_STOP
    return True


def _is_lost(rig: Moving) -> bool:
    return any(fault.reaction is Reaction.END_RUN for fault in rig.faults)
