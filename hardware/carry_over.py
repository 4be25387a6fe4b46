"""What a rig's devices carry over from before a run begins.

A count that has wrapped, a tare, the marks of a clock: with them a raw log that begins in the
middle of a rig's life is decoded to the very same samples again. A driver of a lab that carries
something over offers the two methods of :class:`Carrying`.
"""

from collections.abc import Mapping
from typing import Any, Protocol, runtime_checkable

from hardware.rig import Rig


@runtime_checkable
class Carrying(Protocol):
    """A device whose samples depend on what came before."""

    name: str

    def carried(self) -> dict[str, Any]:
        """Return the state that its samples depend on, in what JSON can hold."""
        ...

    def carry_on(self, carried: Mapping[str, Any]) -> None:
        """Take up the state of the last recording, before the first cycle."""
        ...


def opening_of(rig: Rig) -> dict[str, dict[str, Any]]:
    """Return what the devices carry over now, by their names; ask between two cycles."""
    return {device.name: device.carried() for device in rig.devices if isinstance(device, Carrying)}


def carry_on(rig: Rig, opening: Mapping[str, Mapping[str, Any]]) -> None:
    """Let the devices of a fresh rig go on where others stood."""
    for device in rig.devices:
        if isinstance(device, Carrying) and device.name in opening:
            device.carry_on(opening[device.name])
