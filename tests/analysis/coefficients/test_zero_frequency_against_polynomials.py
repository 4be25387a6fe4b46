"""Extrapolation to zero frequency of polynomials in its square, and how often it holds."""

import numpy as np
import pytest

from analysis.coefficients.zero_frequency import extrapolate
from analysis.uncertainty.values import Contribution, UncertainValues
from hardware.description.errors import DataError

FREQUENCIES = np.array([0.1, 0.2, 0.3, 0.4, 0.5])


def values(exact: np.ndarray, spread: float, shared: float = 0.0) -> UncertainValues:
    own = tuple(
        Contribution(f"scatter {k}", 8.0, np.array([k]), np.array([[spread]]))
        for k in range(len(exact))
    )
    return UncertainValues(exact, own).plus("mass", np.full(len(exact), shared))


@pytest.mark.parametrize("shape", [(75.0, 0.0, 0.0), (75.0, 60.0, 0.0), (75.0, 60.0, -200.0)])
def test_polynomials_come_back(shape: tuple[float, float, float]) -> None:
    exact = shape[0] + shape[1] * FREQUENCIES**2 + shape[2] * FREQUENCIES**4
    found = extrapolate("a33", FREQUENCIES, values(exact, 1e-3))
    assert found.uncertain.values[0] == pytest.approx(75.0, abs=0.01)
    degree = sum(one != 0.0 for one in shape[1:])
    assert int(np.argmax(found.weights)) == degree


def test_what_all_frequencies_share_does_not_average_out() -> None:
    found = extrapolate("a33", FREQUENCIES, values(np.full(5, 75.0), 1e-6, shared=0.3))
    assert found.uncertain.standard_uncertainty[0] == pytest.approx(0.3, rel=1e-3)
    assert found.uncertain.shares(0)["mass"] > 0.99


@pytest.mark.slow
def test_intervals_hold_the_value_at_zero() -> None:
    generator = np.random.default_rng(11)
    exact = 75.0 + 30.0 * FREQUENCIES**2
    hits = 0
    for _ in range(300):
        drawn = exact + 0.5 * generator.standard_normal(5)
        one = extrapolate("a33", FREQUENCIES, values(drawn, 0.5)).uncertain
        hits += abs(one.values[0] - 75.0) <= one.half_width()[0]
    assert 0.90 <= hits / 300 <= 0.99


def test_one_frequency_is_refused() -> None:
    with pytest.raises(DataError, match=r"a33 at zero frequency needs .* 0\.3 Hz; add runs at a"):
        extrapolate("a33", [0.3], values(np.array([1.0]), 0.1))
