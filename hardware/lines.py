r"""Lines of the small serial devices: ``kind,sequence,ticks,value*checksum`` and a line feed.

``P,17,4294967295,3*44`` is line 17: pulse number 3 at 4294967295 microseconds of the device's own
counter. The sequence is of 16 bits and counts every line; ticks are of 32 bits and wrap after
71.6 minutes; the checksum is the exclusive or of all bytes before the asterisk, in two hexadecimal
digits, as in NMEA 0183.
"""

from dataclasses import dataclass
from enum import StrEnum
from functools import reduce
from operator import xor
from typing import Final

from hardware.errors import LineError

SEQUENCE_MODULUS: Final = 2**16
TICK_MODULUS: Final = 2**32


class Kind(StrEnum):
    """What a line says; ``value`` is a count of pulses, or an angle."""

    PULSE = "P"  # a pulse; value: pulses so far
    TIME = "T"  # a mark of time, once a second or so; value: pulses so far
    ANGLE = "A"  # a sample of the inclinometer; value: in the device's unit


@dataclass(frozen=True)
class Line:
    """One line."""

    kind: Kind
    sequence: int
    ticks_us: int
    value: float


def checksum(body: bytes) -> int:
    """Return the exclusive or of all bytes."""
    return reduce(xor, body, 0)


def encode(line: Line) -> bytes:
    """Return a line as its device sends it."""
    value = f"{line.value:.10g}"
    ticks, sequence = line.ticks_us % TICK_MODULUS, line.sequence % SEQUENCE_MODULUS
    body = f"{line.kind},{sequence},{ticks},{value}".encode("ascii")
    return body + b"*%02X\r\n" % checksum(body)


def decode(raw: bytes, device: str) -> Line:
    """Return what a line says.

    Raises
    ------
    LineError
        If the checksum is wrong, a field is missing or is no number.
    """
    body, star, given = raw.strip().rpartition(b"*")
    try:
        right = bool(star) and int(given, 16) == checksum(body)
    except ValueError:
        right = False
    if not right:
        raise LineError(
            device, f"{raw!r} has a wrong checksum (its body gives {checksum(body):02X})"
        )
    fields = body.split(b",")
    try:
        kind, sequence, ticks, value = fields
        return Line(Kind(kind.decode("ascii")), int(sequence), int(ticks), float(value))
    except ValueError as error:
        raise LineError(device, f"{raw!r} is no line: {error}") from error


class Unwrapped:
    """Makes a counter of limited width count on; ``value`` is the full count so far."""

    def __init__(self, modulus: int) -> None:
        self._modulus = modulus
        self.value: int | None = None

    def take(self, raw: int) -> int:
        """Return the full count for a raw value, which lies less than half a turn from the last."""
        if self.value is None:
            self.value = raw
        half = self._modulus // 2
        self.value += (raw - self.value + half) % self._modulus - half
        return self.value
