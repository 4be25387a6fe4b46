"""Periods of pendulums integrated with the sine of their angle come back without bias."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from analysis.inertia.amplitude import AmplitudeLaw
from analysis.inertia.record import analyse_record
from analysis.inertia.series import Series

SQUARE = 6.6  # (2 pi/T_0)^2
PERIOD_S = 2.0 * math.pi / math.sqrt(SQUARE)
RATE_HZ, DURATION_S, NOISE_RAD = 40.0, 90.0, math.radians(0.01)


def swung(release_rad: float, viscous_1_s: float, quadratic: float) -> np.ndarray:
    def rate(_: float, state: np.ndarray) -> tuple[float, float]:
        angle, speed = state
        return speed, -SQUARE * math.sin(angle) - (viscous_1_s + quadratic * abs(speed)) * speed

    times = np.arange(0.0, DURATION_S, 1.0 / RATE_HZ)
    done = solve_ivp(
        rate, (0.0, DURATION_S), (release_rad, 0.0), rtol=1e-10, atol=1e-12, t_eval=times
    )
    return np.asarray(done.y[0])


@pytest.mark.parametrize(("viscous_1_s", "quadratic"), [(0.003, 0.02), (0.006, 0.0)])
def test_the_mean_of_many_records_is_the_small_period(viscous_1_s: float, quadratic: float) -> None:
    clean = swung(math.radians(4.5), viscous_1_s, quadratic)
    noise = np.random.default_rng(4).normal(0.0, NOISE_RAD, (12, clean.size))
    series = [Series("swing", "angle", "rad", RATE_HZ, 0.0, clean + row) for row in noise]
    periods = [analyse_record(one, pendulum=True).period() for one in series]
    found_s = np.array([period.value for period in periods])
    assert abs(found_s.mean() - PERIOD_S) < 1e-5 * PERIOD_S
    stated_s = np.array([period.uncertainty for period in periods])
    assert found_s.std(ddof=1) < 1.5 * stated_s.mean()


def test_an_amplitude_that_stays_tells_the_small_period_too() -> None:
    """Nothing changes along the record, so that no extrapolation would find it."""
    series = Series("swing", "angle", "rad", RATE_HZ, 0.0, swung(math.radians(6.0), 0.0, 0.0))
    period = analyse_record(series, pendulum=True).period()
    assert period.value == pytest.approx(PERIOD_S, rel=2e-7)


@pytest.mark.parametrize("amplitude_rad", [0.05, 0.2, 0.5])
def test_the_law_is_the_elliptic_integral(amplitude_rad: float) -> None:
    mean = math.pi / 2.0  # by the arithmetic and geometric mean
    a, b = 1.0, math.cos(0.5 * amplitude_rad)
    for _ in range(6):
        a, b = 0.5 * (a + b), math.sqrt(a * b)
    exact = mean / a / mean
    law = AmplitudeLaw(0, 1.0, 0.0, 0.0, 1.0, pendulum=True)
    assert law.at(np.array([amplitude_rad]))[0] == pytest.approx(exact, rel=4e-6)
