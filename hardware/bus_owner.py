"""Who has a bus or a serial port of this machine: one process at a time."""

from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from os.path import realpath
from pathlib import Path
from typing import Final

from can.interfaces import BACKENDS

from hardware.bus import BusConfiguration
from hardware.errors import BusOpenError, PortOpenError
from hardware.ownership import OwnedElsewhereError, Ownership, own_on_machine

_SERVERS: Final = ("socket", "rfc2217")  # schemes of serial ports that others can open too


def is_private(configuration: BusConfiguration) -> bool:
    """Tell whether a bus lives in this process, so that no other one can be on it.

    Its class says so by an attribute ``private``; python-can's virtual bus is one.
    """
    if configuration.interface == "virtual":
        return True
    module, name = BACKENDS.get(configuration.interface, ("", ""))
    try:
        return bool(getattr(getattr(import_module(module), name), "private", False))
    except (ImportError, AttributeError, ValueError):
        return False  # opening it says what is wrong


@contextmanager
def owned_bus(configuration: BusConfiguration) -> Iterator[None]:
    """Own a bus for the time of a block, so that no other process of this machine opens it.

    Raises
    ------
    BusOpenError
        If another process has it; the message names it.
    """
    if is_private(configuration):
        yield
        return
    port = configuration.options.get("port", "")  # of a multicast group
    try:
        owned = own_on_machine(_key(f"{configuration.channel}", configuration.interface, port))
    except OwnedElsewhereError as error:
        where = f"bus {configuration.interface}:{configuration.channel}"
        raise BusOpenError(where, f"{error}") from error
    with owned:
        yield


def own_port(name: str, url: str) -> Ownership | None:
    """Own a serial port, so that no other process of this machine opens it.

    ``None`` for one that lives in this process.

    Parameters
    ----------
    name
        Of its device, for the message.
    url
        As pyserial takes it.

    Raises
    ------
    PortOpenError
        If another process has it; the message names it.
    """
    scheme, server, _ = url.partition("://")
    if server and scheme not in _SERVERS:
        return None
    try:
        return own_on_machine(_key(url))
    except OwnedElsewhereError as error:
        raise PortOpenError(name, f"{url} cannot be opened: {error}") from error


def _key(channel: str, *more: object) -> str:
    """Return one key for all names of a thing: a device is itself, however it is reached."""
    device = Path(channel.partition("@")[0])
    if device.is_absolute() and device.exists():
        return realpath(device)
    return " ".join(map(str, (*more, channel))).strip()
