"""A Rayleigh loop: what a force leaves behind depends on where it turned last."""

from typing import NamedTuple

import numpy as np

from hardware.description.arrays import FloatArray


class LoopState(NamedTuple):
    """Last value, which way it went (-1, 0, 1), and where it turned last, above and below."""

    last: float
    direction: float
    highest: float
    lowest: float


def loop(state: LoopState | None, values: FloatArray) -> tuple[LoopState, FloatArray]:
    """Return the lag of a Rayleigh loop behind each value, not yet multiplied by beta/2.

    On the way up from F1, where F2 was the last upper turning point, it is (F2 - F)(F - F1); on the
    way down as much with the opposite sign. Beyond F2, and before the first two turns, it is zero.

    Parameters
    ----------
    values
        Shape ``(samples,)``, at least one.
    """
    if state is None:
        first = float(values[0])
        state = LoopState(first, 0.0, first, first)
    joined = np.concatenate([[state.last], values])
    steps = np.sign(np.diff(joined))
    direction = _carried(steps, steps != 0.0, state.direction)
    before = np.concatenate([[state.direction], direction[:-1]])
    highest = _carried(joined[:-1], (before > 0.0) & (direction < 0.0), state.highest)
    lowest = _carried(joined[:-1], (before < 0.0) & (direction > 0.0), state.lowest)
    lag = direction * np.maximum((highest - values) * (values - lowest), 0.0)
    last = (values[-1], direction[-1], highest[-1], lowest[-1])
    return LoopState(*(float(value) for value in last)), lag


def _carried(values: FloatArray, renewed: np.ndarray, before: float) -> FloatArray:
    """Return at each sample the value at the latest one that is renewed."""
    at = np.maximum.accumulate(np.where(renewed, np.arange(values.size), -1))
    return np.where(at < 0, before, values[at])
