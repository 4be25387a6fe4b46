"""Values in one unit, read as another, are off by a factor that names both."""

import math

import pytest

from analysis.mistaken_units import mistaken
from hardware.description.units import unit, units_of

PAIRS = [
    (si, name)
    for si in ("N", "m", "m/s", "rad")
    for name, factor in units_of(si).items()
    if factor != 1.0
]


@pytest.mark.parametrize(("si", "name"), PAIRS)
@pytest.mark.parametrize("off", [0.93, 1.07])
def test_both_ways_are_named(si: str, name: str, off: float) -> None:
    factor = unit(name).factor
    assert f"{name} in place of {si}" in mistaken(off / factor, si, 0.1)
    assert f"{si} in place of {name}" in mistaken(off * factor, si, 0.1)


@pytest.mark.parametrize("factor", [1.0, 0.5, 30.0, 0.0, -1000.0, math.inf, math.nan])
def test_other_factors_are_no_unit(factor: float) -> None:
    assert mistaken(factor, "N", 0.1) == ""
    assert mistaken(factor, "rad", 0.1) == ""
