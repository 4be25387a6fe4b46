"""Samples that stand at a channel's extreme: a range that ended before the signal did."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analysis.readers.conditioning import flat_top

FloatArray = NDArray[np.float64]


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
    known = values[np.isfinite(values)]
    counts = {sign: flat_top(sign * known) for sign in (1.0, -1.0)}
    levels = tuple(sign * float((sign * known).max()) for sign, count in counts.items() if count)
    return Plateau(sum(counts.values()) / len(values), levels)
