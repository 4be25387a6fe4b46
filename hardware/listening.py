"""What talks on a serial port: the lines of our devices, other text, or nothing."""

import math
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field

from hardware.errors import LineError
from hardware.lines import SEQUENCE_MODULUS, LineKind, SerialLine, Unwrapped, decode
from hardware.serial_port import Port

_POLL_S = 0.01


@dataclass
class PortLines:
    """What was heard on a port.

    Attributes
    ----------
    counts
        Lines of each kind.
    refused
        Lines that are none of ours, and the first of them.
    lost
        Lines whose numbers are missing between those that came.
    last
        The last line of each kind.
    device_s
        Seconds of the device's own clock between the first line and the last.
    """

    counts: Counter[LineKind] = field(default_factory=Counter)
    refused: int = 0
    first_refused: str = ""
    lost: int = 0
    last: dict[LineKind, SerialLine] = field(default_factory=dict)
    device_s: float = 0.0
    _sequence: Unwrapped = field(default_factory=lambda: Unwrapped(SEQUENCE_MODULUS))
    _before: int | None = None
    _began_us: int | None = None
    _has_begun: bool = False

    @property
    def device_kind(self) -> str:
        """What the device is, told from its lines."""
        if self.counts[LineKind.ANGLE]:
            return "inclinometer"
        if self.counts[LineKind.PULSE] or self.counts[LineKind.TIME]:
            return "timestamper"
        return "unknown: its lines are none of ours" if self.first_refused else "silent"

    @property
    def rate_hz(self) -> float:
        """Lines per second of the device's own clock; NaN for fewer than two."""
        number = sum(self.counts.values())
        return (number - 1) / self.device_s if number > 1 and self.device_s > 0.0 else math.nan

    def take(self, raw: bytes) -> SerialLine | None:
        """Take a line; return it if it is one of ours."""
        try:
            line = decode(raw, "port")
        except LineError:
            self._refuse(raw[:60].decode("latin-1").strip())
            return None
        self._has_begun = True
        number = self._sequence.take(line.sequence)
        if self._before is not None:
            self.lost += max(number - self._before - 1, 0)
        self._before = number
        if self._began_us is None:
            self._began_us = line.ticks_us
        self.device_s = (line.ticks_us - self._began_us) % 2**32 * 1e-6
        self.counts[line.kind] += 1
        self.last[line.kind] = line
        return line

    def _refuse(self, text: str) -> None:
        """Count a refused line; the very first may have begun before the port was opened."""
        self.refused += self._has_begun
        self._has_begun = True
        self.first_refused = self.first_refused or text


def listen(
    port: Port,
    seconds: float,
    clock: Callable[[], float],
    sleep: Callable[[float], None],
    heard: PortLines | None = None,
) -> PortLines:
    """Listen to a port for a time; what is heard is added to ``heard``, if that is given.

    Raises
    ------
    UnpluggedError
        If the port fails meanwhile.
    """
    heard, end = heard or PortLines(), clock() + seconds
    while clock() < end:
        try:
            lines = port.lines()
        except LineError as error:
            heard.refused += 1
            heard.first_refused = heard.first_refused or error.args[0]
            lines = []
        for raw in lines:
            heard.take(raw)
        sleep(_POLL_S)
    return heard
