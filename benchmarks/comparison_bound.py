"""The least errors of lag and clock rate that noise allows: Cramer and Rao's bound.

Unknown are gain, lag and clock rate, and of every sine of the motion its two parts and its
frequency: with known frequencies the second channel alone would tell its clock. Noise with a memory
of one sample is made white by taking that memory off both samples and derivatives.
"""

import numpy as np

from benchmarks.comparison_motion import MEMORY, SPREAD, Seen, Sines
from hardware.description.arrays import FloatArray


def least_errors(
    motion: Sines, seen: Seen, first_s: FloatArray, second_s: FloatArray, memory: float = 0.0
) -> FloatArray:
    """Return the least standard deviations of lag (s, at ``seen.mid_s``) and clock rate.

    Parameters
    ----------
    first_s, second_s
        Times of the samples of both channels, even ones.
    memory
        Of the noise, from a sample to the next: 0 for white noise.
    """
    first = np.zeros((3 + 3 * len(motion.turn), len(first_s)))
    first[3:] = _slopes(motion, first_s, 0)
    at_s = seen.times_s(second_s)
    shown, moves = motion.at(at_s, seen.order), motion.at(at_s, seen.order + 1)
    own = np.array([shown, -seen.gain * moves, -seen.gain * (second_s - seen.mid_s) * moves])
    second = np.concatenate((own, seen.gain * _slopes(motion, at_s, seen.order)))
    spreads = (SPREAD * motion.at(first_s).std(), SPREAD * seen.gain * shown.std())
    white = [
        _whitened(one, memory) / spread
        for one, spread in zip((first, second), spreads, strict=True)
    ]
    information = sum(one @ one.T for one in white)
    scale = np.sqrt(np.diag(information))
    inverse = np.linalg.pinv(information / np.outer(scale, scale), hermitian=True)
    return np.asarray((np.sqrt(np.diag(inverse)) / scale)[1:3])


def memory_of(kind: str) -> float:
    """Return the memory of a kind's noise."""
    return MEMORY if kind == "coloured" else 0.0


def _slopes(motion: Sines, time_s: FloatArray, order: int) -> FloatArray:
    """Return the derivatives by both parts and the frequency of each sine, for sines of size 1."""
    angle = motion.turn[:, None] * time_s + motion.phase[:, None] + order * np.pi / 2.0
    power = motion.turn[:, None] ** order
    sine, cosine = power * np.sin(angle), power * np.cos(angle)
    grows = np.zeros_like(sine) if not order else sine * order / motion.turn[:, None]
    return np.concatenate((sine, cosine, time_s * cosine + grows))


def _whitened(rows: FloatArray, memory: float) -> FloatArray:
    if not memory:
        return rows
    later = (rows[:, 1:] - memory * rows[:, :-1]) / np.sqrt(1.0 - memory**2)
    return np.concatenate((rows[:, :1], later), axis=1)
