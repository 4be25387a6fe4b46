"""What the values of a channel show by themselves: where they are cut off, and their steps."""

import math
from dataclasses import dataclass

import numpy as np

from analysis.readers.conditioning import flat_top
from analysis.recording import Recording
from hardware.description.arrays import FloatArray


@dataclass(frozen=True)
class Plateau:
    """How much of a record is cut off.

    Attributes
    ----------
    share
        Of all samples; 0 where nothing is cut off.
    levels
        The extremes at which samples stand, the highest first, in the channel's unit.
    """

    share: float
    levels: tuple[float, ...]


def plateau(values: FloatArray) -> Plateau:
    """Return what is cut off a channel, whose samples have shape ``(samples,)``."""
    samples = values[np.isfinite(values)]
    counts = {sign: flat_top(sign * samples) for sign in (1.0, -1.0)}
    levels = tuple(sign * float((sign * samples).max()) for sign, count in counts.items() if count)
    return Plateau(sum(counts.values()) / len(values), levels)


def steps_of(recording: Recording) -> dict[str, float]:
    """Return the smallest step of each channel's values; NaN where it does not move."""
    smallest_steps = {}
    for name in recording.channel_names:
        levels = np.unique(recording.values(name))
        steps = np.diff(levels[np.isfinite(levels)])
        smallest_steps[name] = float(steps.min()) if steps.size else math.nan
    return smallest_steps
