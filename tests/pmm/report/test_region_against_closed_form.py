"""The 95 % region of a phasor against F tables, limits and its own promise."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.special import fdtri, stdtrit

from pmm.report.region import confidence_ellipse, region_factor


@pytest.mark.parametrize("nu", [2.0, 3.0, 9.0, 30.5, 1e3])
@pytest.mark.parametrize("level", [0.68, 0.95, 0.99])
def test_the_factor_is_hotelling_s(nu: float, level: float) -> None:
    expected = np.sqrt(2.0 * nu / (nu - 1.0) * fdtri(2.0, nu - 1.0, level))
    assert region_factor(nu, level) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("nu", [1.0, 4.0, 16.0])
def test_one_variance_for_both_parts_gives_plain_f(nu: float) -> None:
    expected = np.sqrt(2.0 * fdtri(2.0, nu, 0.95))
    assert region_factor(nu, one_variance=True) == pytest.approx(expected, rel=1e-9)


def test_many_periods_come_down_to_chi_squared() -> None:
    assert region_factor(1e9) == pytest.approx(np.sqrt(-2.0 * np.log(0.05)), rel=1e-7)


def test_two_periods_span_no_region() -> None:
    assert region_factor(1.0) == np.inf
    assert confidence_ellipse(np.eye(2), region_factor(1.0)) is None
    assert confidence_ellipse(np.full((2, 2), np.nan), 2.0) is None


@given(st.floats(1.5, 1e6))
def test_the_region_is_wider_than_an_interval_of_one_part(nu: float) -> None:
    assert region_factor(nu) > stdtrit(nu, 0.975)


@given(st.floats(1e-6, 1e6), st.floats(1e-6, 1.0), st.floats(-1.5, 1.5), st.floats(1.0, 30.0))
def test_half_axes_are_the_roots_of_the_covariance(
    major: float, ratio: float, angle: float, factor: float
) -> None:
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    covariance = turn @ np.diag([major**2, (ratio * major) ** 2]) @ turn.T
    ellipse = confidence_ellipse(covariance, factor)
    assert ellipse is not None
    assert ellipse.half_major == pytest.approx(factor * major, rel=1e-6)
    assert ellipse.half_minor == pytest.approx(factor * ratio * major, abs=1e-6 * factor * major)
    if ratio < 0.9:
        assert np.sin(ellipse.angle_rad - angle) == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("periods", [3, 5, 10])
def test_the_region_holds_the_truth_in_95_of_100_trials(periods: int) -> None:
    rng = np.random.default_rng(7)
    mix = np.array([[2.0, 0.0], [1.5, 0.3]])
    singles = rng.normal(size=(20_000, periods, 2)) @ mix.T
    mean = singles.mean(axis=1)
    left = singles - mean[:, None]
    covariance = np.einsum("tpi,tpj->tij", left, left) / (periods - 1) / periods
    distance = np.einsum("ti,ti->t", mean, np.linalg.solve(covariance, mean[..., None])[..., 0])
    held = (distance < region_factor(periods - 1.0) ** 2).mean()
    assert held == pytest.approx(0.95, abs=0.006)
