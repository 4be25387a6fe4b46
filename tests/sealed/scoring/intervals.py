"""Figures with 95 % intervals: Wilson's for shares, the bootstrap's for everything else."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

_Z: Final = 1.959963984540054
_DRAWS: Final = 1000
_SEED: Final = 20261


@dataclass(frozen=True)
class Figure:
    """A measured figure.

    Attributes
    ----------
    low, high
        95 % interval; equal to the value where nothing can be said.
    count
        Cases that it was measured on.
    ceiling
        What a linear matcher reaches on the same cases; ``None`` where there is none.
    """

    value: float
    low: float
    high: float
    count: int
    ceiling: float | None = None

    def beside(self, ceilings: Sequence[float]) -> "Figure":
        """Return the figure with the mean of these beside it."""
        return replace(self, ceiling=math.fsum(ceilings) / len(ceilings)) if ceilings else self


def wilson(hits: float, count: int) -> tuple[float, float]:
    """Return Wilson's 95 % interval of a share (1927); half hits are allowed."""
    share, z2 = hits / count, _Z**2
    middle = share + z2 / (2.0 * count)
    half = _Z * math.sqrt(share * (1.0 - share) / count + z2 / (4.0 * count**2))
    scale = 1.0 + z2 / count
    # The ends at none and at all of them are exact; rounding would leave crumbs there.
    low = (middle - half) / scale if hits > 0.0 else 0.0
    high = (middle + half) / scale if hits < count else 1.0
    return low, high


def share(hits: Sequence[float]) -> Figure | None:
    """Return the share of hits (1, 0, or a half for a tie); ``None`` without cases."""
    if not hits:
        return None
    total = math.fsum(hits)
    return Figure(total / len(hits), *wilson(total, len(hits)), len(hits))


def mean(values: Sequence[float]) -> Figure | None:
    """Return the mean with its bootstrap interval; ``None`` without cases."""
    return _bootstrapped(values, lambda drawn: np.asarray(drawn.mean(axis=1)))


def median(values: Sequence[float]) -> Figure | None:
    """Return the median with its bootstrap interval; ``None`` without cases."""
    return _bootstrapped(values, lambda drawn: np.asarray(np.median(drawn, axis=1)))


def _bootstrapped(
    values: Sequence[float], figure: Callable[[FloatArray], FloatArray]
) -> Figure | None:
    if not values:
        return None
    own = np.asarray(values, dtype=np.float64)
    places = np.random.default_rng(_SEED).integers(0, len(own), (_DRAWS, len(own)))
    low, high = np.quantile(figure(own[places]), (0.025, 0.975))
    return Figure(float(figure(own[None, :])[0]), float(low), float(high), len(own))


def ranked(inside: Sequence[float], outside: Sequence[float]) -> FloatArray:
    """Return for each pair whether the first is above the second, 1 or 0, a half for a tie."""
    one, two = np.asarray(inside)[:, None], np.asarray(outside)
    return np.asarray((one > two) + 0.5 * (one == two))


def auroc(inside: Sequence[float], outside: Sequence[float]) -> Figure | None:
    """Return how often one of ``inside`` is above one of ``outside``, ties counting half.

    The area under the receiver's operating curve, by Mann and Whitney (1947). ``None`` where one of
    the two is empty.
    """
    if not inside or not outside:
        return None
    one, two, above = inside, outside, ranked(inside, outside)
    rng = np.random.default_rng(_SEED)
    drawn = [
        above[np.ix_(rng.integers(0, len(one), len(one)), rng.integers(0, len(two), len(two)))]
        for _ in range(_DRAWS // 4)
    ]
    low, high = np.quantile([part.mean() for part in drawn], (0.025, 0.975))
    return Figure(float(above.mean()), float(low), float(high), len(one))
