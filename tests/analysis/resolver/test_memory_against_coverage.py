"""An interval holds the truth where the noise remembers, and stays narrow where it does not.

The truth is nought: the sequences are drawn, not resolved, and every channel is a trial.
"""

import numpy as np
import pytest
from scipy.integrate import dblquad
from scipy.special import stdtrit

from analysis.resolver.autocorrelation import (
    _beat,
    _fading,
    _flicker,
    _mean_covariance,
    _parts,
    widened,
)
from tests.analysis.resolver.signals import FloatArray, autoregressive

TRIALS = 1000
SAMPLES = 50  # a period
THREE_SIGMA = 3.0 * np.sqrt(0.95 * 0.05 / TRIALS)


def resolved(samples: FloatArray) -> FloatArray:
    """Mean and three harmonics of each period by their sums, shape ``(periods, channels, 7)``."""
    angle = 2.0 * np.pi * np.arange(SAMPLES) / SAMPLES
    parts = [f(n * angle) * 2.0 for n in (1, 2, 3) for f in (np.sin, np.cos)]
    basis = np.array([np.ones(SAMPLES), *parts]) / SAMPLES
    periods = samples.reshape(len(samples), -1, SAMPLES)
    return np.asarray(np.einsum("cps,ks->pck", periods, basis))


def intervals(values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Whether each interval holds nought, and how much wider than the scatter's it is."""
    count = len(values)
    left = values - values.mean(axis=0)
    wider = widened(left, np.arange(float(count)), count, line=False)
    factor = np.sqrt((wider**2).sum(axis=0) / (left**2).sum(axis=0))
    own = np.sqrt((wider**2).sum(axis=0) / (count - 1) / count)
    held = np.abs(values.mean(axis=0)) <= float(stdtrit(count - 1, 0.975)) * own
    return held, factor


def noise(kind: str, periods: int) -> FloatArray:
    rng = np.random.default_rng(2024)
    shape = (TRIALS, periods * SAMPLES)
    if kind == "white":
        return np.asarray(rng.standard_normal(shape))
    if kind == "slow":  # a memory of two periods
        return autoregressive(rng, shape, np.exp(-1.0 / (2.0 * SAMPLES)))
    cycles = np.arange(shape[1]) / SAMPLES
    order, decay = {"beside": (1.05, np.inf), "dying": (1.02, 5.0)}[kind]
    phase = rng.uniform(0.0, 2.0 * np.pi, (TRIALS, 1))
    wave = np.exp(-cycles / decay) * np.cos(2.0 * np.pi * order * cycles + phase)
    return np.asarray(wave + 0.2 * rng.standard_normal(shape))


@pytest.mark.slow
@pytest.mark.parametrize("periods", [10, 20])
@pytest.mark.parametrize(("kind", "part"), [("slow", 0), ("beside", 1), ("dying", 1)])
def test_intervals_hold_where_the_noise_remembers(kind: str, part: int, periods: int) -> None:
    held, _ = intervals(resolved(noise(kind, periods)))
    assert held[:, part].mean() >= 0.95 - THREE_SIGMA


@pytest.mark.slow
@pytest.mark.parametrize("periods", [10, 20, 40])
def test_white_noise_costs_little(periods: int) -> None:
    held, factor = intervals(resolved(noise("white", periods)))
    assert 0.95 - THREE_SIGMA <= held.mean() <= 0.97
    assert np.median(factor) <= 1.1


def test_another_zero_of_the_phase_turns_the_deviations_and_no_more() -> None:
    left = resolved(noise("dying", 10))[:, :50]
    left = left - left.mean(axis=0)
    turn = np.array([[np.cos(0.7), np.sin(0.7)], [-np.sin(0.7), np.cos(0.7)]])
    turned = left.copy()
    turned[:, :, 1:3] = left[:, :, 1:3] @ turn
    numbers = np.arange(10.0)
    wider = widened(left, numbers, 10, line=True)
    np.testing.assert_allclose(
        widened(turned, numbers, 10, line=True)[:, :, 1:3],
        wider[:, :, 1:3] @ turn,
        atol=1e-9,
    )


def test_units_scale_and_constants_stay() -> None:
    left = resolved(noise("slow", 10))[:, :20]
    left = left - left.mean(axis=0)
    left[:, 0] = 0.0
    numbers = np.arange(10.0)
    wider = widened(left, numbers, 10, line=True)
    np.testing.assert_allclose(widened(1e6 * left, numbers, 10, line=True), 1e6 * wider, rtol=1e-9)
    assert np.all(wider[:, 0] == 0.0)
    assert np.all((wider**2).sum(axis=0) >= (left**2).sum(axis=0) * (1.0 - 1e-12))


@pytest.mark.slow
def test_hundreds_of_periods_are_as_well_held_as_some() -> None:
    values = np.random.default_rng(5).standard_normal((200, TRIALS, 7))
    values[:, :, 1:] *= np.sqrt(2.0)
    held, factor = intervals(values)
    assert 0.95 - THREE_SIGMA <= held.mean() <= 0.97
    assert np.median(factor) <= 1.05


@pytest.mark.parametrize("apart", [0.0, 1.0, 4.0])
@pytest.mark.parametrize("kind", ["fading", "flicker", "beat"])
def test_covariances_of_averages_against_quadrature(kind: str, apart: float) -> None:
    doubled, covariance = {
        "fading": (_fading(0.7), lambda d: np.exp(-abs(d) / 0.7)),
        "flicker": (_flicker(90.0), lambda d: np.log(90.0 / max(abs(d), 1e-300))),
        "beat": (_beat(3.0), lambda d: np.exp(-(d**2) / 18.0)),
    }[kind]

    # In distance and place: the triangle of the distances within two unit stretches.
    def weighted(_: float, d: float) -> float:
        return covariance(apart + d) * (1.0 - abs(d))

    expected = sum(dblquad(weighted, low, low + 1.0, 0.0, 1.0)[0] for low in (-1.0, 0.0))
    found = float(_mean_covariance(doubled, np.array([apart]), 1.0)[0])
    assert found == pytest.approx(expected, rel=1e-6)


@pytest.mark.slow
def test_parts_of_harmonics_against_drawn_noise() -> None:
    tau = 0.3
    drawn = autoregressive(
        np.random.default_rng(3), (20_000, SAMPLES), np.exp(-1.0 / (tau * SAMPLES))
    )
    variance = (resolved(drawn)[0] ** 2).mean(axis=0)[1:].reshape(3, 2).mean(axis=1)
    assert _parts(_fading(tau), 3) == pytest.approx(variance / 2.0, rel=0.05)
