"""Serial ports: local, or on a device server (``socket://``, ``rfc2217://``), read by lines."""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from typing import Final, Literal, Protocol, TypeAlias

import serial
from serial.tools import list_ports

from hardware.bus_owner import own_port
from hardware.errors import PortOpenError, PortOpeningError, UnpluggedError
from hardware.installed import installed
from hardware.ownership import Ownership
from hardware.port_lines import LineSplitter, Splitter
from hardware.port_opening import PortOpening

# A package that brings URLs of its own for pyserial has an entry point here, named by the scheme;
# loading it makes them known.
URL_GROUP: Final = "pmm.serial_urls"
_CHUNK: Final = 65536
_FIRST_BACK_OFF_S, _LAST_BACK_OFF_S = 0.5, 8.0


@dataclass(frozen=True)
class PortSettings:
    """How to open a port.

    Attributes
    ----------
    url
        A device (best by id: ``/dev/serial/by-id/...``), a URL that pyserial opens, or
        ``usb:SERIAL`` for the adapter with that serial number.
    """

    url: str
    baud_rate: int = 115200
    write_timeout_s: float = 0.2
    parity: Literal["none", "even", "odd"] = "none"

    def splitter(self, name: str) -> Splitter:
        """Return what makes lines of bytes, for the device of a name."""
        return LineSplitter(name)


class Port(Protocol):
    """What a serial device reads and writes; :class:`SerialPort` says what each does."""

    @property
    def is_open(self) -> bool:
        """Whether the port is open, as far as is known."""
        ...

    def open(self) -> None:
        """Open the port if it is not."""
        ...

    def lines(self) -> list[bytes]:
        """Return the whole lines that have arrived."""
        ...

    def write(self, data: bytes) -> None:
        """Write."""
        ...

    def recover(self, now_s: float) -> bool:
        """Try to open a lost port again."""
        ...

    def close(self) -> None:
        """Close the port."""
        ...


Ports: TypeAlias = Callable[[str, PortSettings], Port]
"""Opens a port from its device's name and its settings."""


@dataclass(frozen=True)
class PluggedPort:
    """A port of this machine: its device, the name to put into ``url``, and what it says it is."""

    device: str
    url: str
    description: str


def plugged_ports() -> tuple[PluggedPort, ...]:
    """Return the ports of this machine; those with a serial number are named by it."""
    return tuple(
        PluggedPort(
            port.device,
            f"usb:{port.serial_number}" if port.serial_number else port.device,
            port.description or "",
        )
        for port in sorted(list_ports.comports(), key=lambda port: port.device)
    )


@cache
def know(scheme: str) -> None:
    """Load what the installed packages bring for the URLs of a scheme; once is enough.

    Raises
    ------
    OSError
        If a package cannot be loaded.
    """
    for entry_point in installed(URL_GROUP, scheme):
        try:
            entry_point.load()
        except Exception as error:  # a foreign package may raise anything while it is imported
            raise OSError(
                f"{entry_point.value}, which {scheme}:// needs, cannot be loaded: {error}"
            ) from (error)


def resolve(url: str) -> str:
    """Return the device of a ``usb:SERIAL`` name; anything else as it is.

    Raises
    ------
    PortOpenError
        If no adapter with that serial number is plugged in.
    """
    if not url.startswith("usb:"):
        return url
    ports = {port.serial_number: port.device for port in list_ports.comports()}
    number = url.removeprefix("usb:")
    if number not in ports:
        numbers = ", ".join(str(key) for key in ports if key) or "none"
        raise PortOpenError(url, f"no such adapter; plugged in: {numbers}")
    device: str = ports[number]
    return device


_Opened: TypeAlias = tuple[serial.Serial | None, Ownership | None]


def _let_go(opened: _Opened) -> None:
    """Close a port, and let other processes have it."""
    port, owned = opened
    if port is not None:
        link = getattr(port, "_socket", None)  # pyserial leaves it where its other end is gone
        with suppress(OSError):  # an unplugged port has nothing left to close
            port.close()
        if link is not None:
            link.close()
    if owned is not None:
        owned.release()


class SerialPort:
    """A port that is read by lines, never waiting.

    pyserial's own ``readline`` reads byte by byte; this reads what is there and splits it.

    Raises
    ------
    PortOpenError
        If the port cannot be opened.
    """

    def __init__(self, name: str, settings: PortSettings) -> None:
        self._name = name
        self._settings = settings
        self._splitter = settings.splitter(name)
        self._back_off_s = _FIRST_BACK_OFF_S
        self._again_s = 0.0
        self._opening: PortOpening[_Opened] | None = None
        self._port: serial.Serial | None
        self._port, self._owned = self._opened()

    @property
    def is_open(self) -> bool:
        """Whether the port is open, as far as is known."""
        return self._port is not None

    def open(self) -> None:
        """Open the port if it is not, in a thread of its own: to connect may take seconds.

        Raises
        ------
        PortOpeningError
            If it is still being opened; ask again in a later cycle.
        PortOpenError
            As the constructor does.
        """
        if self._port is not None:
            return
        self._opening = opening = self._opening or PortOpening(self._opened, _let_go)
        if not opening.is_over():
            raise PortOpeningError(self._name, f"{self._settings.url} is still being opened")
        self._opening = None
        opened = opening.result()
        self._splitter = self._settings.splitter(self._name)
        self._port, self._owned = opened

    def _opened(self) -> _Opened:
        owned: Ownership | None = None
        try:
            know(self._settings.url.partition("://")[0])
            url = resolve(self._settings.url)
            owned = own_port(self._name, url)
            port = serial.serial_for_url(
                url,
                baudrate=self._settings.baud_rate,
                parity=self._settings.parity[0].upper(),
                timeout=0,
                write_timeout=self._settings.write_timeout_s,
                exclusive=True,
            )
        except (OSError, ValueError) as error:
            _let_go((None, owned))
            raise PortOpenError(
                self._name, f"{self._settings.url} cannot be opened: {error}"
            ) from error
        return port, owned

    def lines(self) -> list[bytes]:
        """Return the whole lines that have arrived, without their line feed; none if closed.

        Raises
        ------
        UnpluggedError
            If the port fails; it is closed then.
        LineError
            If what arrived cannot be a line.
        """
        if self._port is None:
            return []
        try:
            # The count of waiting bytes first: on an unplugged adapter it fails where a read of
            # nothing would not.
            arrived = self._port.read(_CHUNK) if self._port.in_waiting else b""
        except OSError as error:  # SerialException is one
            raise self._lost_port("reading", error) from error
        return self._splitter.split(arrived)

    def write(self, data: bytes) -> None:
        """Write.

        Raises
        ------
        UnpluggedError
            If the port fails or does not take the data in time; it is closed then.
        """
        if self._port is None:
            raise UnpluggedError(self._name, f"{self._settings.url} is closed; plug in and reset")
        try:
            self._port.write(data)
            self._splitter.sent(data)
        except OSError as error:
            raise self._lost_port("writing", error) from error

    def recover(self, now_s: float) -> bool:
        """Try to open a lost port again, ever less often; for idle times. Tell whether it is open.

        Parameters
        ----------
        now_s
            The rig's time.
        """
        if self._port is not None or now_s < self._again_s:
            return self.is_open
        try:
            self.open()
            self._back_off_s = _FIRST_BACK_OFF_S
        except PortOpeningError:
            return False
        except PortOpenError:
            self._again_s = now_s + self._back_off_s
            self._back_off_s = min(2.0 * self._back_off_s, _LAST_BACK_OFF_S)
        return self.is_open

    def close(self) -> None:
        """Close the port, also one that is being opened; may be called twice."""
        opening, self._opening = self._opening, None
        if opening is not None:
            opening.abandon()
        opened = self._port, self._owned
        self._port = self._owned = None
        _let_go(opened)

    def _lost_port(self, action: str, error: OSError) -> UnpluggedError:
        self.close()
        return UnpluggedError(
            self._name, f"{action} {self._settings.url} failed: {error}; plug in and reset"
        )
