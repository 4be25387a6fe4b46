"""Where a model lies at rest, read before and after a run, is the mean of both readings."""

import math

import pytest

from analysis.attitude import RestPosition, common_rest


def test_each_sensor_has_its_own_mean_and_the_uncertainty_of_it() -> None:
    before = RestPosition((1e-3, -2e-3), (3e-5, 6e-5))
    after = RestPosition((2e-3, -6e-3), (4e-5, 8e-5))
    found = common_rest((before, after))
    assert found.mean_m == pytest.approx((1.5e-3, -4e-3))
    expected = (math.hypot(3e-5, 4e-5) / 2.0, math.hypot(6e-5, 8e-5) / 2.0)
    assert found.uncertainty_m == pytest.approx(expected)
