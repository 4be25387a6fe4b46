"""Which unit was taken for another, by the ratio of a recording to its expectation."""

import math
from collections import defaultdict
from functools import cache

from hardware.description.units import units_of


@cache
def mistaken_units(si: str) -> dict[float, str]:
    """Return, by the factor that the values are too large by, which units were mixed up.

    The units are those that a recording may come in, so that the one that is meant can be said.

    Parameters
    ----------
    si
        The unit in which the values should be; they were in another one, or already in it while
        another was stated.
    """
    units = defaultdict(list)
    for name, factor in units_of(si).items():
        if factor != 1.0:
            units[1.0 / factor].append(f"{name} in place of {si}")
            units[factor].append(f"{si} in place of {name}")
    return {factor: " or ".join(mixtures) for factor, mixtures in units.items()}


def mistaken(factor: float, si: str, tolerance: float) -> str:
    """Return in words which units were mixed up; empty where none is off by that factor.

    Parameters
    ----------
    factor
        What was found over what was expected, positive.
    tolerance
        How far it may be from a unit's own factor, in the natural logarithm.
    """
    if not 0.0 < factor < math.inf:
        return ""
    units = mistaken_units(si)
    nearest = min(units, key=lambda ratio: abs(math.log(ratio / factor)))
    return units[nearest] if abs(math.log(nearest / factor)) < tolerance else ""
