"""Variance in white noise against the Cramer-Rao bound of the same model.

The estimator is linear in the samples, so its exact variance is the sum of the squares of its
response to each sample alone: a record whose channels are the rows of the identity gives all of
them at once, and no random number is needed.
"""

import numpy as np
import pytest

from analysis.resolver.basis import harmonic_basis
from analysis.resolver.estimate import resolve
from analysis.resolver.hann import resolve_hann
from analysis.resolver.reference import from_frequency
from analysis.resolver.sums import period_sums
from tests.analysis.resolver.signals import FloatArray, recording

FREQUENCY_HZ = 1.037
RATE_HZ = 100.0
HARMONICS = 3


def bound(first_s: float, last_s: float, opening_cycle: float) -> FloatArray:
    """Smallest variance of mean and harmonics from the samples in the gate, for noise of 1."""
    numbers = np.arange(np.ceil(first_s * RATE_HZ), np.floor(last_s * RATE_HZ) + 1.0)
    cycles = opening_cycle + FREQUENCY_HZ * (numbers / RATE_HZ - first_s)
    basis = harmonic_basis(cycles, np.arange(1.0, HARMONICS + 1.0))
    return np.diagonal(np.linalg.inv(basis @ basis.T))


def variance(periods: int, *, drift: bool, opening: float = 1.0, hann: bool = False) -> FloatArray:
    """Exact variance of each coefficient over the bound."""
    samples = int(RATE_HZ * (periods + 3) / FREQUENCY_HZ)
    run = recording(np.eye(samples))
    reference = from_frequency(FREQUENCY_HZ, 0.0, run.end_s)
    edges = opening + np.arange(periods + 1.0)
    if hann:
        result = resolve_hann(run, reference, edges, HARMONICS, take_out_drift=drift)
    else:
        sums = period_sums(run, reference, HARMONICS, edges_cycles=edges)
        result = resolve(run, sums, take_out_drift=drift)
    limit = bound(result.opened_s, result.closed_s, opening)
    return np.asarray((result.coefficients**2).sum(axis=0) / limit)


@pytest.mark.sample(4)
@pytest.mark.parametrize("periods", [1, 3, 6])
@pytest.mark.parametrize("opening", [1.0, 1.21, 1.68])
def test_without_drift_the_bound_is_reached(periods: int, opening: float) -> None:
    ratio = variance(periods, drift=False, opening=opening)
    assert ratio == pytest.approx(np.ones(2 * HARMONICS + 1), rel=0.05)


@pytest.mark.sample(1)
@pytest.mark.parametrize("periods", [2, 3, 5, 10])
def test_drift_costs_what_the_closed_form_says(periods: int) -> None:
    """Gate opened at theta = 0, s^2 = 1, P samples a period.

    The slope per period from m means of variance 1/P has the variance 12 / (P m (m^2 - 1)). It
    shifts S1 by -1/pi per unit, and is uncorrelated with S1 itself, whose variance is 2 / (P m).
    Together 2 / (P m) times 1 + 6 / (pi^2 (m^2 - 1)).
    """
    ratio = variance(periods, drift=True)
    assert ratio[1] == pytest.approx(1.0 + 6.0 / (np.pi**2 * (periods**2 - 1.0)), rel=0.05)
    assert ratio[2] == pytest.approx(1.0, rel=0.05)  # in quadrature a drift leaves no trace


@pytest.mark.parametrize("harmonic", [2, 3])
def test_drift_costs_higher_harmonics_less(harmonic: int) -> None:
    ratio = variance(2, drift=True)[2 * harmonic - 1]
    assert ratio == pytest.approx(1.0 + 2.0 / (np.pi * harmonic) ** 2, rel=0.05)


@pytest.mark.slow
def test_hann_costs_half_as_much_again() -> None:
    ratio = variance(10, drift=False, hann=True)
    assert ratio[1:] == pytest.approx(1.5 * np.ones(2 * HARMONICS), rel=0.05)


@pytest.mark.slow
def test_random_noise_agrees_with_the_exact_variance() -> None:
    """The oracle itself: 4000 channels of noise scatter as the squared responses say."""
    noise = np.random.default_rng(2).normal(size=(4000, 600))
    run = recording(noise)
    reference = from_frequency(FREQUENCY_HZ, 0.0, run.end_s)
    sums = period_sums(run, reference, HARMONICS, edges_cycles=1.0 + np.arange(4.0))
    result = resolve(run, sums, take_out_drift=False)
    limit = bound(result.opened_s, result.closed_s, 1.0)
    ratio = result.coefficients.var(axis=0) / limit
    assert ratio.mean() == pytest.approx(1.0, rel=0.03)
    # The interval's own variance is right on average, too, before the memory that it allows for.
    own = (result.standard_uncertainty / result.widening) ** 2
    own = own.mean(axis=0) / limit
    assert own.mean() == pytest.approx(1.0, rel=0.05)
