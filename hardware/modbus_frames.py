"""Modbus frames on a port: TCP (also through ``socket://``) or RTU on a serial line.

A port reads lines. A line is here an exchange, written out: unit and request, unit and answer, in
hexadecimal. So a raw log holds both, and a replay needs nobody who asks.
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Literal

from hardware.description.errors import ConfigurationError
from hardware.description.motor import UNKNOWN_KEYS_REFUSED
from hardware.errors import LineError
from hardware.port_lines import Splitter
from hardware.serial_port import PortSettings

if TYPE_CHECKING:
    from pymodbus.framer import FramerBase

Framing = Literal["tcp", "rtu"]
_LONGEST: Final = 260  # of a frame, by either framing


@dataclass(frozen=True)
class ModbusPortSettings(PortSettings):
    """How to open a port to a Modbus device: ``socket://HOST:502``, or a serial line."""

    framing: Framing = "tcp"

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED

    def splitter(self, name: str) -> Splitter:
        """Return what makes exchanges of bytes."""
        return ModbusFrames(name, self.framing)


def framer_of(name: str, framing: Framing) -> "FramerBase":
    """Return what makes frames of requests and answers of frames.

    Raises
    ------
    ConfigurationError
        If pymodbus is not installed.
    """
    try:
        from pymodbus.framer import FramerRTU, FramerSocket
        from pymodbus.pdu import DecodePDU
    except ImportError as error:
        raise ConfigurationError(
            f"{name}: Modbus needs pymodbus; pip install planar-motion-mechanism[modbus]"
        ) from error
    return (FramerSocket if framing == "tcp" else FramerRTU)(DecodePDU(False))


class ModbusFrames:
    """Finds the answer to the frame that was sent last."""

    def __init__(self, name: str, framing: Framing) -> None:
        self._name, self._tcp = name, framing == "tcp"
        self._framer = framer_of(name, framing)
        self._asked = self._rest = self._torn = b""

    def sent(self, data: bytes) -> None:
        """Take a request; what is left of an answer to another one is told as torn."""
        self._torn, self._asked, self._rest = self._rest, data, b""

    def split(self, data: bytes) -> list[bytes]:
        """Return the exchanges that bytes complete; answers to other requests are left out.

        Raises
        ------
        LineError
            If what has come is no frame.
        """
        torn, self._torn = self._torn, b""
        self._rest += data
        exchanges: list[bytes] = []
        while self._rest:
            used, unit, number, answer = self._framer.decode(self._rest)
            if not used:
                break
            frame, self._rest = self._rest[:used], self._rest[used:]
            if not answer:
                raise self._unreadable(frame)
            if not self._tcp or number == int.from_bytes(self._asked[:2], "big"):
                exchanges.append(self._exchange(unit, answer))
        if torn or len(self._rest) > _LONGEST:
            raise self._unreadable(torn or self._rest)
        return exchanges

    def _exchange(self, unit: int, answer: bytes) -> bytes:
        asked = self._asked[6:] if self._tcp else self._asked[:-2]
        return f"{asked.hex()} {unit:02x}{answer.hex()}".encode()

    def _unreadable(self, data: bytes) -> LineError:
        return LineError(
            self._name,
            f"{len(data)} bytes are no whole frame ({data[:16].hex()}); check framing, and on a "
            "serial line speed, parity and wiring",
        )
