"""The uncertainty that is expected of runs against how fits of noisy periods scatter."""

import math
from dataclasses import replace

import numpy as np
import pytest

from analysis.coefficients.cycle_fit import FIRST, fit_cycles
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from analysis.design.candidate import CandidateRun
from analysis.design.design_fits import DesignTarget
from analysis.design.expectation import REPEATS, SCATTER, expected_coefficients, made_up
from analysis.design.noise import Noise
from analysis.design.regression import prospects
from benchmarks import coefficients_campaigns as exact
from hardware.description.setpoint import SetPoint
from tests.analysis.design.designs import EXACT, LINEAR, WHOLE, covariance

PERIODS, TRIALS = 12, 40
RUNS = [
    CandidateRun(SetPoint(f, e, phase, 1.2), PERIODS, 1.0)
    for f, e, phase in (
        (0.1, 0.2, 0.0), (0.2, 0.1, 0.0), (0.2, 0.2, 1.2), (0.1, 0.25, 0.6), (0.25, 0.2, 2.0),
    )
]  # fmt: skip
TARGETS = [DesignTarget(name, 1.0) for name in WHOLE.values]


@pytest.mark.slow
def test_fits_of_noisy_periods_scatter_as_expected() -> None:
    """Runs are made sample by sample, each period's harmonics are drawn, and all is fitted."""
    noise = Noise(force_n=2.0, sample_rate_hz=100.0)
    runs, names = RUNS[:3], tuple(LINEAR.values)
    asked = [DesignTarget(name, 1.0) for name in names]
    predicted = {
        one.name: one.standard_uncertainty
        for one in expected_coefficients(runs, made_up(runs, LINEAR, noise), asked, LINEAR, EXACT)
    }
    truth = exact.Made(LINEAR.values, orders=3)
    struts = [exact.made_struts(one.point, truth, f"run {k}") for k, one in enumerate(runs)]
    # By white noise's own formula: of one period and one gauge.
    sizes = [2.0 * math.sqrt(2.0 * one.point.frequency_hz / 100.0) for one in runs]
    generator = np.random.default_rng(27)
    found = []
    for _ in range(TRIALS):
        noisy = [
            exact.scattered(one, generator, exact.Scatter(PERIODS, 0.0, size, correlation=0.0))
            for one, size in zip(struts, sizes, strict=True)
        ]
        fit = fit_cycles([exact.taken(one, truth) for one in noisy], names, FIRST)
        found.append(fit.values)
    ratio = np.log(np.std(found, axis=0) / [predicted[name] for name in names])
    assert np.abs(ratio).max() < 0.45
    assert abs(ratio.mean()) < 0.12


def test_the_search_expects_what_the_fit_does() -> None:
    """Stated uncertainties, drift of the zero, repeats and motion noise, with the fit's weights."""
    noise = Noise(2.0, 100.0, displacement_m=2e-4, corner_hz=0.1, repeat_relative=0.01)
    stated = StatedUncertainties(mass_kg=0.3, lag_s=1e-3, force_gain_relative=2e-3)
    runs = [replace(one, periods=3 + 2 * k) for k, one in enumerate(RUNS)]
    fitted = expected_coefficients(runs, made_up(runs, WHOLE, noise), TARGETS, WHOLE, stated)
    every = list(range(len(runs)))
    searched = prospects(runs, WHOLE, noise, stated).regressions(TARGETS, every)
    spread = np.sqrt(np.concatenate([np.diag(covariance(one, every)) for one in searched]))
    assert [one.name for one in fitted] == [name for one in searched for name in one.names]
    ratio = np.array([one.standard_uncertainty for one in fitted]) / spread
    # The fit widens for weights that luck made, of three periods most; the search knows no luck.
    assert ratio.min() > 0.999
    assert ratio.max() < 1.06
    known = [replace(one, periods=10**6) for one in RUNS]
    fitted = expected_coefficients(known, made_up(known, WHOLE, noise), TARGETS, WHOLE, stated)
    searched = prospects(known, WHOLE, noise, stated).regressions(TARGETS, every)
    spread = np.sqrt(np.concatenate([np.diag(covariance(one, every)) for one in searched]))
    assert spread == pytest.approx([one.standard_uncertainty for one in fitted], rel=1e-3)
    inputs = {label for one in fitted for label in one.shares}
    assert inputs == {SCATTER, REPEATS, "mass_kg", "lag_s", "force_gain_relative"}


def test_a_run_that_does_not_tell_says_which_would() -> None:
    runs = [CandidateRun(SetPoint(0.2, 0.1, 0.0, 1.2), 5, 1.0)]
    noise = Noise(2.0, 100.0)
    rows = expected_coefficients(
        runs, made_up(runs, LINEAR, noise), [DesignTarget("N_r", 1.0)], LINEAR, EXACT
    )
    assert not rows[0].met
    assert np.isinf(rows[0].standard_uncertainty)
    assert "add a run in yaw" in rows[0].message
