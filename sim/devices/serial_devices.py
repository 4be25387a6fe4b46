"""Simulated serial devices: each writes lines to the far end of the port it is plugged into."""

from collections.abc import Callable
from typing import Protocol

from hardware.lines import LineKind, SerialLine, encode
from sim.chain import Chain
from sim.devices.plant import Passage

_MARK_EVERY_S = 1.0
_CLOCK_RATE = 1.0 + 20e-6  # of the timestamper's clock over the rig's
_CLOCK_BEGAN_S = 100.0  # what it shows when the simulation begins
_BLOCK = 256


class SerialCable:
    """Bytes on the line that nobody has read yet, and whether the plug is in.

    Attributes
    ----------
    plugged
        Fault: with the plug out, reading and writing fail as pyserial fails.
    """

    def __init__(self) -> None:
        self.waiting = bytearray()
        self.heard = bytearray()
        self.plugged = True


class Talker(Protocol):
    """A serial device.

    ``mute`` is a fault: it says nothing, but goes on living.
    """

    cable: SerialCable
    mute: bool

    def tick(self, time_s: float, passages: tuple[Passage, ...]) -> None:
        """Say what there is to say up to a time."""
        ...


class _Sayer:
    def __init__(self) -> None:
        self.cable = SerialCable()
        self.mute = False
        self._sequence = 0

    def say(self, kind: LineKind, ticks_us: int, value: float) -> None:
        line = SerialLine(kind, self._sequence, ticks_us, value)
        self._sequence += 1
        if not self.mute and self.cable.plugged:
            self.cable.waiting += encode(line)


class Timestamper(_Sayer):
    """Stamps the photocell's pulses with its own clock."""

    def __init__(self) -> None:
        super().__init__()
        self._pulses = 0
        self._marked_s = -_MARK_EVERY_S

    def tick(self, time_s: float, passages: tuple[Passage, ...]) -> None:
        """Say the pulses, and once a second the time."""
        for passage in passages:
            self._pulses += 1
            self.say(LineKind.PULSE, self._ticks(passage.time_s), self._pulses)
        if time_s >= self._marked_s + _MARK_EVERY_S:
            self._marked_s = time_s
            self.say(LineKind.TIME, self._ticks(time_s), self._pulses)

    def _ticks(self, time_s: float) -> int:
        return round((_CLOCK_BEGAN_S + time_s * _CLOCK_RATE) * 1e6)


Angles = Callable[[int], float]


def constant_angle(angle_rad: float = 0.0) -> Angles:
    """Return the angles of an inclinometer that nobody moves."""
    return lambda _number: angle_rad


class Swinging:
    """The angles of a swing: a recorded channel of a pendulum's chain, in radians, in blocks."""

    def __init__(self, chain: Chain, signal: str, sample_rate_hz: float, seed: int) -> None:
        self._chain, self._signal = chain, signal
        self._state = chain.start(sample_rate_hz, seed)
        self._first = 0
        self._angles: list[float] = []

    def __call__(self, number: int) -> float:
        """Return the angle of a sample; samples are asked for in order."""
        while number >= self._first + len(self._angles):
            self._first += len(self._angles)
            self._state, run = self._chain.run(self._state, _BLOCK)
            self._angles = run[self._signal].tolist()
        return self._angles[number - self._first]


class SimulatedInclinometer(_Sayer):
    """Says its angle at its own rate.

    Attributes
    ----------
    angles
        The angle of each sample; a push by hand replaces it.
    """

    def __init__(self, sample_rate_hz: float, rad_per_unit: float, angles: Angles) -> None:
        super().__init__()
        self.angles = angles
        self._rate_hz, self._rad_per_unit = sample_rate_hz, rad_per_unit
        self._number = 0

    def tick(self, time_s: float, passages: tuple[Passage, ...]) -> None:
        """Say the samples up to a time."""
        while self._number <= time_s * self._rate_hz:
            angle = self.angles(self._number) / self._rad_per_unit
            self.say(LineKind.ANGLE, round(self._number / self._rate_hz * 1e6), angle)
            self._number += 1
