"""Periods of pendulums and of yaw on two lines, integrated exactly, come back without bias."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from analysis.inertia.amplitude import AmplitudeLaw
from analysis.inertia.lengthening import bifilar_lengthening, pendulum_lengthening
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
    periods = [analyse_record(one, lengthens=pendulum_lengthening).period() for one in series]
    found_s = np.array([period.value for period in periods])
    assert abs(found_s.mean() - PERIOD_S) < 1e-5 * PERIOD_S
    stated_s = np.array([period.uncertainty for period in periods])
    assert found_s.std(ddof=1) < 1.5 * stated_s.mean()


def test_an_amplitude_that_stays_tells_the_small_period_too() -> None:
    """Nothing changes along the record, so that no extrapolation would find it."""
    series = Series("swing", "angle", "rad", RATE_HZ, 0.0, swung(math.radians(6.0), 0.0, 0.0))
    period = analyse_record(series, lengthens=pendulum_lengthening).period()
    assert period.value == pytest.approx(PERIOD_S, rel=2e-7)


@pytest.mark.parametrize("amplitude_rad", [0.05, 0.2, 0.5])
def test_the_law_is_the_elliptic_integral(amplitude_rad: float) -> None:
    mean = math.pi / 2.0  # by the arithmetic and geometric mean
    a, b = 1.0, math.cos(0.5 * amplitude_rad)
    for _ in range(6):
        a, b = 0.5 * (a + b), math.sqrt(a * b)
    exact = mean / a / mean
    law = AmplitudeLaw(0, 1.0, 0.0, 0.0, 1.0, pendulum_lengthening(1.0))
    assert law.at(np.array([amplitude_rad]))[0] == pytest.approx(exact, rel=4e-6)


@pytest.mark.parametrize(("line_m", "gyradius_m"), [(2.9, 0.612), (1.2, 0.4), (0.8, 0.7)])
def test_yaw_on_two_lines_comes_back_by_its_exact_potential(
    line_m: float, gyradius_m: float
) -> None:
    """Where the lines are short the rise of the body itself takes part in the motion."""
    half_m, gravity = 0.4, 9.81

    def rise(angle: float) -> tuple[float, float, float]:
        """Height, and its first and second derivatives by the angle."""
        root = math.sqrt(line_m**2 - 4.0 * half_m**2 * math.sin(0.5 * angle) ** 2)
        first = half_m**2 * math.sin(angle) / root
        second = half_m**2 * math.cos(angle) / root + first**2 / root
        return line_m - root, first, second

    def rate(_: float, state: np.ndarray) -> tuple[float, float]:
        angle, speed = state
        _, first, second = rise(angle)
        inertia = gyradius_m**2 + first**2
        pull = gravity * first + first * second * speed**2
        return speed, -(pull + 0.004 * speed) / inertia

    exact_s = 2.0 * math.pi * gyradius_m / half_m * math.sqrt(line_m / gravity)
    times = np.arange(0.0, 40.0 * exact_s, exact_s / 60.0)
    done = solve_ivp(
        rate, (0.0, times[-1]), (math.radians(8.0), 0.0), rtol=1e-10, atol=1e-12, t_eval=times
    )
    series = Series("yaw", "angle", "rad", 60.0 / exact_s, 0.0, np.asarray(done.y[0]))
    lengthens = bifilar_lengthening(half_m, line_m, gravity)
    found = analyse_record(series, lengthens=lengthens)
    undamped_s = found.modes[0].rates.undamped(found.period().value)
    assert undamped_s == pytest.approx(exact_s, rel=1e-6)
    likeliest = max(found.modes[0].at_no_amplitude.laws, key=lambda law: law.weight)
    assert abs(likeliest.slope) < 2e-5 / math.radians(8.0) ** 2
