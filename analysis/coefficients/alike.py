"""Values that count as one: what is set or measured again is never the same to the last digit."""

import math
from collections.abc import Callable, Sequence
from statistics import median_low
from typing import Final, TypeVar

_Item = TypeVar("_Item")

# Within these two runs count as set to the same.
SAME_FREQUENCY: Final = 5e-3  # relative
SAME_SPEED: Final = 1e-2  # relative, as far as a carriage may stray
SLOWEST_M_S: Final = 0.01  # below, speeds are the same by what they would be at this one
SAME_ANGLE_RAD: Final = 1e-3  # of drift, heel and rudder: 0.06 degrees


def is_same_speed(first_m_s: float, second_m_s: float) -> bool:
    """Return whether two runs count as set to the same carriage speed."""
    slack = SAME_SPEED * max(abs(first_m_s), SLOWEST_M_S)
    return abs(second_m_s - first_m_s) <= slack


def speed_classes(
    items: Sequence[_Item], speed_m_s_of: Callable[[_Item], float]
) -> list[tuple[tuple[_Item, ...], float]]:
    """Return the items of one speed, each once, with the median speed; rising."""
    return classes(items, speed_m_s_of, SAME_SPEED, SAME_SPEED * SLOWEST_M_S)


def frequency_classes(
    items: Sequence[_Item], frequency_hz_of: Callable[[_Item], float]
) -> list[tuple[tuple[_Item, ...], float]]:
    """Return the items of one frequency, each once, with the median frequency; rising."""
    return classes(items, frequency_hz_of, SAME_FREQUENCY)


def classes(
    items: Sequence[_Item],
    value_of: Callable[[_Item], float],
    relative: float,
    absolute: float = 0.0,
) -> list[tuple[tuple[_Item, ...], float]]:
    """Return the items whose values are alike, each once, with the median value; rising.

    Parameters
    ----------
    relative, absolute
        How far a value may lie from the lowest of its class; the larger of both counts.
    """
    values = [value_of(item) for item in items]
    groups: list[list[int]] = []
    for at in sorted(range(len(items)), key=values.__getitem__):
        lowest = values[groups[-1][0]] if groups else math.nan
        if abs(values[at] - lowest) <= max(relative * abs(lowest), absolute):
            groups[-1].append(at)
        else:
            groups.append([at])
    return [
        (tuple(items[at] for at in sorted(group)), median_low(values[at] for at in group))
        for group in groups
    ]
