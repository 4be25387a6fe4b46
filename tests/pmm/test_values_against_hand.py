"""A value and its half-width as text: digits as the half-width bears, checked by hand."""

import math
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pmm.document.notation import between, degrees, is_open, rounded
from pmm.harmonics.rows import floored


@pytest.mark.parametrize(
    ("value", "half_width", "text"),
    [
        (15.80790, 0.12543, "15.81 ± 0.13"),
        (-12.3, 4.449, "−12.3 ± 4.4"),
        (0.0, 0.0, "0"),
        (1.0, 0.0996, "1.00 ± 0.10"),
        (1.0, 0.0994, "1.000 ± 0.099"),
        (-102.3, 149.2, "−102 ± 149"),
        (0.02, 3.1e-7, "0.02000000 ± 0.00000031"),
        (1.3e-8, 2.11e-7, "(0.1 ± 2.1)·10^−7"),
        (1.2345e7, 2.5e4, "(1.2345 ± 0.0025)·10^7"),
        (12345.0, 1e4, "12345 ± 10000"),
        (3.14159265, math.nan, "3.142"),
        (math.nan, 1.0, "–"),
    ],
)
def test_against_hand(value: float, half_width: float, text: str) -> None:
    assert rounded(value, half_width) == text


@pytest.mark.parametrize(
    ("low", "high", "text"),
    [
        (1.0894, 1.0906, "1.0894 to 1.0906"),
        (-0.01453, -0.01171, "−0.0145 to −0.0117"),
        (984.7, 1020.1, "985 to 1020"),
        (98470.0, 102010.0, "98500 to 102000"),
        (1.2345e-9, 1.2346e-9, "1.2345e−09 to 1.2346e−09"),
        (2.5, 2.5, "2.5 to 2.5"),
        (math.nan, 1.0, "–"),
    ],
)
def test_ends_have_the_digits_of_their_width(low: float, high: float, text: str) -> None:
    assert between(low, high) == text


@given(
    value=st.floats(-1e9, 1e9),
    half_width=st.floats(1e-9, 1e9),
)
def test_what_is_printed_is_the_value_within_its_interval(value: float, half_width: float) -> None:
    text = rounded(value, half_width).replace("−", "-")
    match = re.fullmatch(r"\(?(\S+) ± ([^)]+)\)?(?:·10\^(-?\d+))?", text)
    assert match
    scale = 10.0 ** int(match[3] or 0)
    assert abs(float(match[1]) * scale - value) <= 0.051 * half_width + 1e-8 * abs(value)
    assert float(match[2]) * scale == pytest.approx(half_width, rel=0.051)


@pytest.mark.parametrize(
    ("value", "half_width", "text"),
    [
        (6.6e-17, 1e-17, "(0.0 ± 2.0)·10^−11"),
        (20.0, 0.0, "20 ± 2.0e−11"),
        (20.0, 0.3, "20.00 ± 0.30"),
        (1e-9, 2e-9, "(1.0 ± 2.0)·10^−9"),
        (6.6e-17, float("nan"), "0"),
    ],
)
def test_what_rounding_leaves_is_floored(value: float, half_width: float, text: str) -> None:
    assert rounded(*floored(value, half_width, 20.0)) == text


@pytest.mark.parametrize(
    ("angle_rad", "text"),
    [(8.8e-17, "0"), (-8.8e-17, "0"), (-0.0, "0"), (math.radians(-8.0), "-8"),
     (math.radians(12.3456), "12.35"), (math.radians(1e-4), "0.0001")],
)  # fmt: skip
def test_an_angle_of_rounding_is_none(angle_rad: float, text: str) -> None:
    assert degrees(angle_rad) == text


def test_a_phase_is_open_beyond_a_right_angle_or_without_an_amplitude() -> None:
    assert is_open(90.0, 1.0)
    assert is_open(1.0, 0.0)
    assert not is_open(89.9, 1e-9)
    assert not is_open(float("nan"), 1.0)
