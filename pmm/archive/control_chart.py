"""A coefficient over time: each campaign's value against what the others foretell."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

FEWEST = 3  # campaigns: two others tell a scatter


@dataclass(frozen=True)
class ChartPoint:
    """One campaign's value with the limits that the others set; NaN where they are too few."""

    value: float
    low: float
    high: float

    @property
    def outside(self) -> bool:
        """Whether it lies beyond its limits."""
        return not (math.isnan(self.low) or self.low <= self.value <= self.high)


def control_chart(values: Sequence[float], probability: float) -> tuple[ChartPoint, ...]:
    """Return each value with the interval that the other values foretell for it.

    Of n values of one normal distribution the interval of each has the stated probability:
    mean of the others +- t(n - 2) s sqrt(1 + 1 / (n - 1)), s their standard deviation (Student's
    prediction interval; the same as externally studentised residuals). A value that is off does
    not widen its own limits, as it would those of all values' mean +- 3 s, beyond which nothing
    can lie for n up to 10.

    Parameters
    ----------
    probability
        Two-sided, of the limits of one value.
    """
    from scipy.special import stdtrit

    n = len(values)
    if n < FEWEST:
        return tuple(ChartPoint(one, math.nan, math.nan) for one in values)
    factor = float(stdtrit(n - 2, 0.5 + 0.5 * probability)) * math.sqrt(1.0 + 1.0 / (n - 1))
    all_values = np.asarray(values, float)
    off = all_values - all_values.mean()
    middle = all_values - off * n / (n - 1)
    squares = np.sum(off**2) - off**2 * n / (n - 1)  # of the others about their own mean
    half = factor * np.sqrt(np.maximum(squares, 0.0) / (n - 2))
    return tuple(
        ChartPoint(*map(float, one))
        for one in zip(all_values, middle - half, middle + half, strict=True)
    )
