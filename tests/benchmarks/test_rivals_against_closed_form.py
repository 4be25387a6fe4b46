"""The rivals are worth beating only if they work: each recovers a record that suits it."""

import numpy as np
import pytest

from analysis.resolver.weights import gate_weights
from benchmarks import noises, simulator, speed_rivals
from benchmarks.accuracy_rivals import RIVALS, Gate, edge_weights
from benchmarks.signals import Truth, draw_coefficients

_RATE_HZ = 100.0
_PERIODS = 40
_TRUTH = Truth(1.0, 0.0, draw_coefficients((0.5, 1.0, 0.3, 0.1), 2, np.random.default_rng(1)))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "needs", "tolerance"),
    [
        ("sine_and_cosine", "numpy", 1e-12),
        ("trigonometry_reused", "numpy", 1e-12),
        ("nearest_bins", "numpy", 1e-12),
        ("curve_fit", "scipy", 1e-6),
        ("ulia", "ulia", 1e-2),
        ("rota_order", "rota", 1e-6),
    ],
)
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_speed_rival_recovers_whole_periods(name: str, needs: str, tolerance: float) -> None:
    pytest.importorskip(needs)
    times_s = np.arange(int(_PERIODS * _RATE_HZ)) / _RATE_HZ
    found = getattr(speed_rivals, name)(_TRUTH.values(times_s), _RATE_HZ, 1.0)
    given = np.isfinite(found)
    assert given[:, 1:].all()
    assert np.abs(found - _TRUTH.coefficients)[given].max() < tolerance


@pytest.mark.parametrize("name", RIVALS)
def test_gate_rival_recovers_gate_that_fits_the_samples(name: str) -> None:
    times_s = np.arange(600) / _RATE_HZ
    cycles = _TRUTH.cycles(times_s)
    gate = Gate(_TRUTH.values(times_s)[0], cycles, 100.0, 400.0, 3)
    assert RIVALS[name](gate) == pytest.approx(_TRUTH.coefficients[0], abs=1e-12)


def test_six_point_edges_are_those_of_the_resolver() -> None:
    start, ours = gate_weights(10.3, 87.8, 200)
    theirs = edge_weights(10.3, 87.8, 6, 200)
    assert theirs[start : start + len(ours)] == pytest.approx(ours, abs=1e-12)
    assert theirs.sum() == pytest.approx(87.8 - 10.3, abs=1e-12)


@pytest.mark.parametrize("name", ["white", "ar1", "sloshing"])
def test_stationary_noise_has_unit_variance_from_the_first_sample(name: str) -> None:
    drawn = noises.NOISES[name](20_000, np.arange(40.0), np.random.default_rng(2))
    assert drawn.var(axis=0) == pytest.approx(np.ones(40), abs=0.05)


def test_noise_is_correlated_as_named() -> None:
    drawn = noises.autoregressive(20_000, np.arange(10.0), np.random.default_rng(3))
    for lag in (1, 2, 5):
        assert np.mean(drawn[:, 0] * drawn[:, lag]) == pytest.approx(0.95**lag, abs=0.03)
    swings = noises.sloshing(20_000, np.arange(100.0), np.random.default_rng(4))
    lags = np.arange(100)
    angle = 2.0 * np.pi * 1.37 / 100.0 * lags
    closed = np.exp(-angle / 40.0) * np.cos(angle)
    assert np.mean(swings[:, :1] * swings, axis=0) == pytest.approx(closed, abs=0.06)


def test_rival_of_the_simulator_solves_the_same_equations() -> None:
    time_s = np.arange(300) / simulator.RATE_HZ
    ours = simulator.whole_run(simulator.rig_on_gauges(), time_s.size)()
    theirs = simulator.MODEL.forces(time_s, "DOP853", 1e-10)
    assert theirs == pytest.approx(ours, abs=1e-6 * np.abs(ours).max())
