"""One quantity that was predicted: its value, its interval from draws, and what is asked of it."""

import math
from dataclasses import dataclass

import numpy as np

from hardware.description.arrays import FloatArray


@dataclass(frozen=True)
class ManoeuvreQuantity:
    """One quantity of the values themselves and of the draws.

    Attributes
    ----------
    low, high
        Ends of the interval, from the draws; NaN without any.
    full_scale, full_scale_unit
        At the ship's size by Froude; NaN where it is the same.
    limit
        Of IMO MSC.137(76); NaN where there is none.
    within
        Share of the draws that keep to it.
    failed
        Draws in which the manoeuvre did not come to its end.
    """

    manoeuvre: str
    name: str
    unit: str
    value: float
    low: float
    high: float
    full_scale: float
    full_scale_unit: str
    limit: float
    within: float
    failed: int


@dataclass(frozen=True)
class FullScale:
    """What a quantity is at full scale: so many times its value, in a unit."""

    factor: float
    unit: str


def quantity_of(
    manoeuvre: str,
    name: str,
    unit: str,
    values: FloatArray,
    level: float,
    size: FullScale | None = None,
    limit: float = math.nan,
) -> ManoeuvreQuantity:
    """Return a quantity; ``values`` has the value itself first, and behind it each draw."""
    draws = values[1:]
    finite_draws = draws[np.isfinite(draws)]
    tail = 0.5 * (1.0 - level)
    low, high = (
        np.quantile(finite_draws, (tail, 1.0 - tail)) if finite_draws.size else (np.nan, np.nan)
    )
    is_judged = draws.size and math.isfinite(limit)
    return ManoeuvreQuantity(
        manoeuvre,
        name,
        unit,
        float(values[0]),
        float(low),
        float(high),
        float(values[0]) * size.factor if size else math.nan,
        size.unit if size else "",
        limit,
        float(np.mean(draws <= limit)) if is_judged else math.nan,
        int(draws.size - finite_draws.size),
    )
