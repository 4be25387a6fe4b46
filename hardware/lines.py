r"""Lines of the small serial devices: ``kind,sequence,ticks,value*checksum`` and a line feed.

``P,17,4294967295,3*44`` is line 17: pulse number 3 at 4294967295 microseconds of the device's own
counter. The sequence is of 16 bits and counts every line; ticks are of 32 bits and wrap after
71.6 minutes; the checksum is the exclusive or of all bytes before the asterisk, in two hexadecimal
digits, as in NMEA 0183. A value is a decimal number, of a pulse or a mark a whole one.
"""

import re
from dataclasses import dataclass
from enum import StrEnum
from functools import reduce
from operator import xor
from typing import Final

from hardware.errors import LineError

SEQUENCE_MODULUS: Final = 2**16
TICK_MODULUS: Final = 2**32
# No count of 32 bits and no angle in any unit is larger; twice or half of it would serve as well.
LARGEST_VALUE: Final = 2.0**32
_BODY: Final = re.compile(
    rb"([PTA]),(\d{1,5}),(\d{1,10}),([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)"
)
_SHOWN: Final = 64  # bytes of a malformed line in its message
_CHECKSUM: Final = re.compile(rb"[0-9A-Fa-f]{2}")


class LineKind(StrEnum):
    """What a line says; ``value`` is a count of pulses, or an angle."""

    PULSE = "P"  # a pulse; value: pulses so far
    TIME = "T"  # a mark of time, once a second or so; value: pulses so far
    ANGLE = "A"  # a sample of the inclinometer; value: in the device's unit


@dataclass(frozen=True)
class SerialLine:
    """One line: its kind, its count, the device's clock in microseconds, and what it measured."""

    kind: LineKind
    sequence: int
    ticks_us: int
    value: float


def checksum(body: bytes) -> int:
    """Return the exclusive or of all bytes."""
    return reduce(xor, body, 0)


def encode(line: SerialLine) -> bytes:
    """Return a line as its device sends it."""
    value = f"{line.value:.10g}"
    ticks, sequence = line.ticks_us % TICK_MODULUS, line.sequence % SEQUENCE_MODULUS
    body = f"{line.kind},{sequence},{ticks},{value}".encode("ascii")
    return body + b"*%02X\r\n" % checksum(body)


def decode(raw: bytes, device: str) -> SerialLine:
    """Return what a line says.

    Raises
    ------
    LineError
        If the checksum is wrong, a field is missing, is no number, or is out of its range.
    """
    return Decoder(device).decode(raw)


class Decoder:
    """Decodes the lines of a device.

    Attributes
    ----------
    malformed
        How many were none so far.
    """

    def __init__(self, device: str) -> None:
        self.malformed = 0
        self._device = device

    def decode(self, raw: bytes) -> SerialLine:
        """Return what a line says; raises as :func:`decode`, which counts from 1."""
        try:
            return _parsed(raw)
        except ValueError as error:
            self.malformed += 1
            shown = repr(raw if len(raw) <= _SHOWN else raw[:_SHOWN] + b"...")
            raise LineError(
                self._device, f"{shown} {error}; malformed line {self.malformed}"
            ) from None


def _parsed(raw: bytes) -> SerialLine:
    """Return what a line says; a ValueError tells why it is none."""
    body, _, digits = raw.strip().rpartition(b"*")
    if not _CHECKSUM.fullmatch(digits) or int(digits, 16) != checksum(body):
        raise ValueError(f"has a wrong checksum (its body gives {checksum(body):02X})")
    match = _BODY.fullmatch(body)
    if match is None:
        raise ValueError("is no line: not kind,sequence,ticks,value in decimal digits")
    line = SerialLine(LineKind(match[1].decode()), int(match[2]), int(match[3]), float(match[4]))
    fault = _out_of_range(line)
    if fault:
        raise ValueError(f"is no line: {fault}")
    return line


def _out_of_range(line: SerialLine) -> str:
    """Say which field is beyond what a device can count; empty if none is."""
    if line.sequence >= SEQUENCE_MODULUS:
        return f"sequence {line.sequence} (limit {SEQUENCE_MODULUS - 1})"
    if line.ticks_us >= TICK_MODULUS:
        return f"ticks {line.ticks_us} (limit {TICK_MODULUS - 1})"
    if not abs(line.value) < LARGEST_VALUE:
        return f"value {line.value:g} (limit {LARGEST_VALUE:g})"
    if line.kind is not LineKind.ANGLE and not (line.value >= 0.0 and line.value.is_integer()):
        return f"value {line.value:g} is no count of pulses"
    return ""


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
