"""Which simulated rig is behind a name: shared by its bus and its serial lines."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

import serial

from sim.devices.world import World

_WORLDS: Final[dict[str, World]] = {}


def world_named(name: str) -> World:
    """Return the simulated rig of a name.

    Raises
    ------
    ValueError
        If there is none, which python-can and pyserial hand on as they do for unknown ports.
    """
    if name not in _WORLDS:
        known = ", ".join(sorted(_WORLDS)) or "none"
        raise ValueError(f"no simulated rig {name!r} runs in this process; running: {known}")
    return _WORLDS[name]


@contextmanager
def running(name: str, world: World) -> Iterator[World]:
    """Let a simulated rig be found under a name, by its bus and as ``sim://name/part``.

    Raises
    ------
    ValueError
        If the name is taken.
    """
    if name in _WORLDS:
        raise ValueError(f"a simulated rig {name!r} runs already")
    if __package__ not in serial.protocol_handler_packages:
        serial.protocol_handler_packages.append(__package__)
    _WORLDS[name] = world
    try:
        yield world
    finally:
        del _WORLDS[name]
