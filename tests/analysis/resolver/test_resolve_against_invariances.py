"""What must hold for any record: scale, order of channels, superposition, shifts in time."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.resolver.estimate import resolve
from analysis.resolver.hann import resolve_hann
from analysis.resolver.harmonics import Harmonics
from analysis.resolver.photocell import from_photocell
from analysis.resolver.sums import period_sums
from tests.analysis.resolver.signals import FloatArray, recording

EDGES = 0.3 + np.cumsum(0.97 + 0.01 * np.sin(np.arange(9.0)))
VALUES = np.random.default_rng(12).normal(size=(5, 1000)) + np.linspace(0.0, 3.0, 1000)
ESTIMATORS = ("one period", "six periods", "Hann taper")

estimators = st.sampled_from(ESTIMATORS)


def resolved(values: FloatArray, estimator: str, start_s: float = 0.0) -> Harmonics:
    run = recording(values, start_s=start_s)
    reference = from_photocell(EDGES + start_s)
    if estimator == "Hann taper":
        return resolve_hann(run, reference, np.arange(1.0, 8.0), 3)
    sums = period_sums(run, reference)
    return resolve(run, sums[1:2] if estimator == "one period" else sums[1:7], around=sums)


@given(estimators, st.floats(1e-9, 1e9), st.booleans())
def test_scale(estimator: str, factor: float, negative: bool) -> None:
    factor = -factor if negative else factor
    plain, scaled = resolved(VALUES, estimator), resolved(factor * VALUES, estimator)
    assert scaled.coefficients / factor == pytest.approx(plain.coefficients, abs=1e-12)
    assert scaled.covariance / factor**2 == pytest.approx(plain.covariance, abs=1e-12)
    assert scaled.drift_per_s / factor == pytest.approx(plain.drift_per_s, abs=1e-12)


@given(estimators, st.permutations(range(5)))
def test_order_of_channels(estimator: str, order: list[int]) -> None:
    plain, mixed = resolved(VALUES, estimator), resolved(VALUES[order], estimator)
    assert mixed.coefficients == pytest.approx(plain.coefficients[order], abs=1e-13)
    assert mixed.covariance == pytest.approx(plain.covariance[order], abs=1e-13)
    assert mixed.drift_per_s == pytest.approx(plain.drift_per_s[order], abs=1e-13)


@given(estimators, st.floats(-5.0, 5.0), st.floats(-5.0, 5.0))
def test_superposition(estimator: str, a: float, b: float) -> None:
    plain = resolved(VALUES, estimator).coefficients
    both = resolved(a * VALUES[:1] + b * VALUES[1:2], estimator)
    assert both.coefficients[0] == pytest.approx(a * plain[0] + b * plain[1], abs=1e-12)


@given(estimators, st.floats(-1e6, 1e6))
def test_a_constant_goes_into_the_mean_alone(estimator: str, level: float) -> None:
    plain, raised = resolved(VALUES, estimator), resolved(VALUES + level, estimator)
    expected = plain.coefficients.copy()
    expected[:, 0] += level
    tolerance = 1e-12 * (1.0 + abs(level))
    assert raised.coefficients == pytest.approx(expected, abs=tolerance)
    assert raised.half_width() == pytest.approx(plain.half_width(), abs=100.0 * tolerance)


@given(estimators, st.floats(-1e4, 1e4))
def test_the_clock_s_zero(estimator: str, start_s: float) -> None:
    plain, later = resolved(VALUES, estimator), resolved(VALUES, estimator, start_s)
    assert later.coefficients == pytest.approx(plain.coefficients, abs=1e-8)
    assert later.opened_s - start_s == pytest.approx(plain.opened_s, abs=1e-9)


@given(st.sampled_from(ESTIMATORS[1:]), st.floats(-3.0, 3.0))
def test_a_drift_goes_into_the_mean_and_the_slope_alone(estimator: str, slope: float) -> None:
    time = np.arange(1000) / 100.0
    plain, tilted = resolved(VALUES, estimator), resolved(VALUES + slope * time, estimator)
    assert tilted.coefficients[:, 1:] == pytest.approx(plain.coefficients[:, 1:], abs=1e-6)
    assert tilted.drift_per_s - slope == pytest.approx(plain.drift_per_s, abs=1e-6)


def test_turning_the_reference_turns_harmonic_n_by_n_times_as_much() -> None:
    run = recording(VALUES)
    plain = resolve(run, period_sums(run, from_photocell(EDGES)))
    turned = resolve(run, period_sums(run, from_photocell(EDGES, angle_offset_rad=0.3)))
    assert turned.amplitude == pytest.approx(plain.amplitude, abs=1e-12)
    turn = np.angle(np.exp(1j * (plain.phase_rad - turned.phase_rad)))
    assert turn == pytest.approx(np.tile(0.3 * np.arange(1.0, 4.0), (5, 1)), abs=1e-12)
    along, across = plain.polar_uncertainty()
    assert turned.polar_uncertainty()[0] == pytest.approx(along, rel=1e-9)
    assert turned.polar_uncertainty()[1] == pytest.approx(across, rel=1e-9)
