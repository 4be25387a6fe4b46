"""Motions that are exact at any time, seen by two channels, and the noise in them."""

from dataclasses import dataclass
from typing import Final

import numpy as np

from hardware.description.arrays import FloatArray

MEMORY: Final = 0.95  # of coloured noise, from a sample to the next: twenty samples
SPREAD: Final = 0.01  # of the noise, over that of the signal: 40 dB


@dataclass(frozen=True)
class Sines:
    """A sum of sines: rad/s, sizes and phases, shape ``(n,)`` each."""

    turn: FloatArray
    size: FloatArray
    phase: FloatArray

    def at(self, time_s: FloatArray, order: int = 0) -> FloatArray:
        """Return the motion, or a derivative of it."""
        total = np.zeros(len(time_s))
        for w, a, p in zip(self.turn, self.size, self.phase, strict=True):
            total += a * w**order * np.sin(w * time_s + p + order * np.pi / 2.0)
        return total


@dataclass(frozen=True)
class Seen:
    """The second channel is ``gain`` times derivative ``order`` of the motion, later by the lag.

    ``lag_s`` is that at ``mid_s`` on the second channel's clock; it grows by ``rate``.
    """

    gain: float
    lag_s: float
    rate: float
    mid_s: float
    order: int

    def times_s(self, time_s: FloatArray) -> FloatArray:
        """Return the motion's own times."""
        times: FloatArray = time_s - self.lag_s - self.rate * (time_s - self.mid_s)
        return times


def sines(kind: str, rng: np.random.Generator) -> Sines:
    """Draw a motion of one frequency, of three harmonics, or an irregular one."""
    if kind.startswith(("one", "harm")):
        size = np.array([1.0]) if kind.startswith("one") else np.array([1.0, 0.2, 0.05])
        turn = 2.0 * np.pi * rng.uniform(0.5, 1.5) * np.arange(1.0, len(size) + 1.0)
    else:
        turn = 2.0 * np.pi * rng.uniform(0.3, 1.5, 40)
        size = np.exp(-(((turn / 2.0 / np.pi - 0.8) / 0.25) ** 2)) * rng.rayleigh(size=40)
    return Sines(turn, size, rng.uniform(0.0, 2.0 * np.pi, len(turn)))


def noise(
    kind: str, values: FloatArray, rng: np.random.Generator, spread: float = SPREAD
) -> FloatArray:
    """Draw the noise of a channel, white or with a memory of twenty samples."""
    drawn = rng.standard_normal(len(values))
    if kind == "coloured":
        for k in range(1, len(drawn)):
            drawn[k] = MEMORY * drawn[k - 1] + np.sqrt(1.0 - MEMORY**2) * drawn[k]
    return np.asarray(spread * values.std() * drawn)
