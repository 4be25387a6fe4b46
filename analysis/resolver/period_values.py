"""Each period's harmonics by themselves, from its sums."""

from dataclasses import dataclass

import numpy as np

from analysis.resolver.sums import PeriodSums
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError

LEAST_EIGENVALUE = 0.25
"""Below it uneven samples tell a period's harmonics badly: one combination of them has four times
the variance that even samples give. Drift and steadiness are seen in periods' own values; the
harmonics and their scatter do without."""


@dataclass(frozen=True)
class PeriodValues:
    """Each period solved alone.

    Attributes
    ----------
    coefficients
        Shape ``(periods, channels, K)``.
    ramp
        Coefficients of the time itself, shape ``(periods, K)``: what a drift of 1 per second does.
    """

    coefficients: FloatArray
    ramp: FloatArray

    def __getitem__(self, periods: slice) -> "PeriodValues":
        """Return the values of some of the periods."""
        return PeriodValues(self.coefficients[periods], self.ramp[periods])


def solve_periods(sums: PeriodSums) -> PeriodValues:
    """Solve each period's normal equations alone; a void period gives NaN.

    One that uneven stamps tell badly is solved with those beside it.
    """
    gram, right = sums.gram, np.concatenate((sums.moment, sums.ramp[:, None, :]), axis=1)
    if sums.uneven:
        gram, right = _with_neighbours(gram, right)
    solved = np.asarray(np.linalg.solve(gram, right.transpose(0, 2, 1)), dtype=np.float64)
    solved = solved.transpose(0, 2, 1)
    return PeriodValues(solved[:, :-1], solved[:, -1])


def _with_neighbours(gram: FloatArray, right: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Add to periods that are told badly as few of those beside them as it takes."""
    parts, sides, reach = (gram, right), (gram.copy(), right.copy()), 0
    while (badly := np.flatnonzero(_least_eigenvalue(sides[0]) < LEAST_EIGENVALUE)).size:
        reach += 1
        for k in badly:
            neighbours = slice(max(k - reach, 0), k + reach + 1)
            for total, part in zip(sides, parts, strict=True):
                total[k] = part[neighbours].sum(axis=0)
        if reach >= len(gram):
            break
    return sides


def _least_eigenvalue(gram: FloatArray) -> FloatArray:
    """Return how well samples tell all harmonics, shape ``(periods,)``: 1 for many even ones."""
    size = gram.shape[-1]
    scale = np.where(np.arange(size) == 0, 1.0, np.sqrt(2.0))
    count = np.maximum(gram[:, 0, 0], 1.0)[:, None, None]
    return np.asarray(np.linalg.eigvalsh(gram * np.outer(scale, scale) / count)[:, 0])


def usable(sums: PeriodSums) -> PeriodSums:
    """Return the periods without missing samples.

    Raises
    ------
    DataError
        If none is left.
    """
    good = np.asarray(np.isfinite(sums.moment).all(axis=(1, 2)))
    if not good.any():
        raise DataError(
            f"all {sums.period_count} periods from {sums.opened_s[0]:.3f} s to "
            f"{sums.closed_s[-1]:.3f} s have missing samples; take other channels or another window"
        )
    return sums[good]
