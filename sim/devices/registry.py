"""Which simulated rig is behind a name: shared by its bus and its serial lines.

A name that ends in ``.toml`` is a file (:mod:`sim.devices.bench_file`): its rig comes to life with
the first bus or port that is opened on it and ends with the last. Importing this module makes
``sim://`` known to pyserial.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Final

import serial

from hardware.description.errors import ConfigurationError
from sim.devices.bench_file import read_bench
from sim.devices.world import World

_WORLDS: Final[dict[str, World]] = {}
_USERS: Final[dict[str, int]] = {}
_PACKAGE: Final = __name__.rpartition(".")[0]
if _PACKAGE not in serial.protocol_handler_packages:
    serial.protocol_handler_packages.append(_PACKAGE)


def take(name: str) -> World:
    """Return the simulated rig of a name; :func:`give_back` follows.

    Raises
    ------
    ValueError
        If there is none, or its file is wrong: python-can and pyserial hand that on as they do for
        unknown ports.
    """
    if name not in _WORLDS:
        if not name.endswith(".toml"):
            names = ", ".join(sorted(_WORLDS)) or "none"
            raise ValueError(f"no simulated rig {name!r} runs in this process; running: {names}")
        try:
            _WORLDS[name] = read_bench(Path(name)).world()
        except ConfigurationError as error:
            raise ValueError(str(error)) from error
        _USERS[name] = 0
    if name in _USERS:
        _USERS[name] += 1
    return _WORLDS[name]


def give_back(name: str) -> None:
    """Let go of a rig; one from a file ends with its last user."""
    if name in _USERS:
        _USERS[name] -= 1
        if not _USERS[name]:
            del _USERS[name], _WORLDS[name]


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
    _WORLDS[name] = world
    try:
        yield world
    finally:
        del _WORLDS[name]
