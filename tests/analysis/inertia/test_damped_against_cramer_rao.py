"""Period fits against the bound that noise sets, and against poor starts."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.inertia.damped_fit import fit_damped
from analysis.inertia.forms import SwingForm, fit_swing_form
from benchmarks.inertia_rivals import compare_rivals
from hardware.description.errors import DataError
from tests.analysis.inertia.records import FloatArray, damped


def cramer_rao_period(
    t: FloatArray, period: float, decay: float, size: float, phase: float, noise: float
) -> float:
    """Standard deviation bound of the period, by the Fisher information of five parameters."""
    s = t - t[0]
    angle = 2.0 * np.pi * s / period + phase
    fall = np.exp(-decay * s)
    columns = [
        size * fall * np.sin(angle) * 2.0 * np.pi * s / period**2,
        -s * size * fall * np.cos(angle),
        fall * np.cos(angle),
        -size * fall * np.sin(angle),
        np.ones(s.size),
    ]
    jacobian = np.column_stack(columns)
    return float(noise * np.sqrt(np.linalg.inv(jacobian.T @ jacobian)[0, 0]))


@pytest.mark.slow
def test_scatter_of_many_fits_is_within_a_tenth_of_the_bound() -> None:
    rng = np.random.default_rng(1)
    t = np.arange(0.0, 40.0, 0.1)
    truth = (2.846, 0.01, 0.07, 0.4)
    clean, noise = damped(t, *truth), 0.002
    fits = [fit_damped(t, clean + 0.01 + noise * rng.standard_normal(t.size)) for _ in range(800)]
    periods = np.array([fit.modes[0].period_s for fit in fits])
    bound = cramer_rao_period(t, *truth, noise)
    assert periods.std() == pytest.approx(bound, rel=0.10)
    assert abs(periods.mean() - truth[0]) < 4.0 * bound / np.sqrt(800)
    stated = np.array([fit.period_uncertainty_s() for fit in fits])
    assert np.median(stated) == pytest.approx(bound, rel=0.15)


@pytest.mark.slow
def test_poor_starts_always_succeed_and_the_peer_does_not() -> None:
    own, *peers = compare_rivals(60, seed=3)
    assert own.success == 1.0
    assert peers[0].success < own.success
    assert all(own.rms_error < 1.05 * one.rms_error for one in peers if one.success > 0.3)


@given(
    factor=st.floats(0.1, 10.0),
    period=st.floats(0.8, 8.0),
    decay=st.floats(0.0, 0.03),
    phase=st.floats(-3.1, 3.1),
)
def test_any_start_finds_the_same_period(
    factor: float, period: float, decay: float, phase: float
) -> None:
    t = np.arange(0.0, 60.0, 0.05)
    y = damped(t, period, decay, 1.0, phase) + 0.3
    y = y + 1e-3 * np.random.default_rng(7).standard_normal(t.size)
    fit = fit_damped(t, y, start_periods_s=(factor * period,))
    assert fit.converged
    assert fit.modes[0].period_s == pytest.approx(period, rel=1e-4)
    assert fit.modes[0].decay_1_s == pytest.approx(decay, abs=1e-4)
    assert fit.modes[0].amplitude == pytest.approx(1.0, rel=1e-2)
    assert np.cos(fit.modes[0].phase_rad - phase) == pytest.approx(1.0, abs=1e-3)
    assert fit.offset == pytest.approx(0.3, abs=1e-3)


@pytest.mark.slow
@given(ratio=st.floats(1.03, 2.5), share=st.floats(0.2, 5.0), phase=st.floats(-3.0, 3.0))
def test_two_modes_are_told_apart(ratio: float, share: float, phase: float) -> None:
    t = np.arange(0.0, 120.0, 0.05)
    y = damped(t, 3.8, 0.008, 1.0) + damped(t, 3.8 * ratio, 0.002, share, phase)
    y = y + 1e-3 * np.random.default_rng(8).standard_normal(t.size)
    fit = fit_damped(t, y, modes=2)
    assert fit.modes[0].period_s == pytest.approx(3.8 * ratio, rel=1e-3)
    assert fit.modes[1].period_s == pytest.approx(3.8, rel=1e-3)


@pytest.mark.slow
def test_coloured_noise_widens_the_covariance_to_what_is_seen() -> None:
    rng = np.random.default_rng(2)
    t = np.arange(0.0, 60.0, 0.05)
    periods, stated = [], []
    for _ in range(200):
        white = rng.standard_normal(t.size + 500)
        colour = np.zeros(white.size)
        for k in range(1, white.size):
            colour[k] = 0.95 * colour[k - 1] + white[k]
        fit = fit_damped(t, damped(t, 4.0, 0.01, 1.0) + 0.01 * colour[500:])
        periods.append(fit.modes[0].period_s)
        stated.append(fit.period_uncertainty_s())
    assert float(np.median(stated)) == pytest.approx(float(np.std(periods)), rel=0.25)
    assert fit.diagnostics.lag1_correlation > 0.9


@pytest.mark.slow
def test_parameters_covariance_against_scatter() -> None:
    rng = np.random.default_rng(4)
    t = np.arange(0.0, 30.0, 0.1)
    rows, fit = [], None
    for _ in range(500):
        fit = fit_damped(t, damped(t, 3.0, 0.03, 1.0, 0.5) + 0.05 * rng.standard_normal(t.size))
        mode = fit.modes[0]
        rows.append((mode.period_s, mode.decay_1_s, mode.amplitude, mode.phase_rad, fit.offset))
    seen = np.cov(np.array(rows).T)
    assert fit is not None
    assert np.sqrt(np.diag(fit.covariance)) == pytest.approx(np.sqrt(np.diag(seen)), rel=0.2)
    assert _correlation(fit.covariance) == pytest.approx(_correlation(seen), abs=0.15)


def _correlation(covariance: FloatArray) -> FloatArray:
    spread = np.sqrt(np.diag(covariance))
    return np.asarray(covariance / np.outer(spread, spread))


def test_the_four_forms_agree_on_a_clean_record_and_f4_stands_an_offset() -> None:
    t = np.arange(0.0, 160.0, 0.05)
    y = damped(t, 7.2923, 0.0048, 1.1, 0.3)
    for form in SwingForm:
        assert fit_swing_form(t, y, form).modes[0].period_s == pytest.approx(7.2923, rel=2e-4)
    f1, f2 = (fit_swing_form(t, y, form).modes[0] for form in (SwingForm.F1, SwingForm.F2))
    assert f1.decay_1_s == 0.0
    assert f1.amplitude < f2.amplitude == pytest.approx(1.1)
    shifted = fit_swing_form(t, y + 0.4, SwingForm.F4)
    assert shifted.offset == pytest.approx(0.4, abs=1e-9)
    assert shifted.modes[0].decay_1_s == pytest.approx(0.0048, rel=1e-6)


def test_gaps_are_left_out() -> None:
    t = np.arange(0.0, 60.0, 0.05)
    y = damped(t, 3.0, 0.01, 1.0)
    y[200:330] = np.nan
    y[700] = np.nan
    assert fit_damped(t, y).modes[0].period_s == pytest.approx(3.0, rel=1e-9)


def test_a_model_that_is_wrong_is_accused() -> None:
    t = np.arange(0.0, 120.0, 0.05)
    y = damped(t, 3.0, 0.01, 1.0) + damped(t, 3.2, 0.01, 0.1)
    y = y + 1e-3 * np.random.default_rng(0).standard_normal(t.size)
    assert "structured_residual" in {flag.code for flag in fit_damped(t, y).flags}
    assert not fit_damped(t, y, modes=2).flags


@pytest.mark.parametrize(("friction", "severity"), [(0.02, "warning"), (0.0004, "note")])
def test_friction_that_is_hardly_there_is_only_noted(friction: float, severity: str) -> None:
    """Coulomb friction takes an even part of the amplitude away in each swing."""
    t = np.arange(0.0, 120.0, 0.05)
    y = (np.exp(-0.001 * t) - friction * t / 3.0).clip(0.0) * np.cos(2.0 * np.pi * t / 3.0)
    y = y + 1e-5 * np.random.default_rng(0).standard_normal(t.size)
    (flag,) = (one for one in fit_damped(t, y).flags if one.code == "structured_residual")
    assert flag.severity == severity
    assert "pmm gap pendulum" in flag.message


def test_too_few_samples_and_too_few_swings_are_refused() -> None:
    t = np.arange(0.0, 1.0, 0.25)
    with pytest.raises(DataError, match="4 samples for 5 unknowns"):
        fit_damped(t, np.cos(t))
    t = np.arange(0.0, 3.0, 0.01)
    with pytest.raises(DataError, match="too few swings"):
        fit_damped(t, np.cos(2.0 * np.pi * t / 4.0))
    with pytest.raises(DataError, match="constant"):
        fit_damped(t, np.ones(t.size))


@pytest.mark.parametrize("seed", range(10))
@pytest.mark.parametrize(("decay_1_s", "grows"), [(0.0, False), (-0.002, True)])
def test_an_oscillation_grows_where_noise_does_not_explain_it(
    seed: int, decay_1_s: float, grows: bool
) -> None:
    t = np.arange(0.0, 40.0, 0.1)
    noise = 0.002 * np.random.default_rng(seed).standard_normal(t.size)
    fit = fit_damped(t, damped(t, 2.846, decay_1_s, 0.07) + noise)
    assert ("growing" in {flag.code for flag in fit.flags}) == grows
