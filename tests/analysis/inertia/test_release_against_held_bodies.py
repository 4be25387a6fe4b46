"""A body that is held before it is let go: the decay begins where it was let go, whatever noise."""

import math

import numpy as np
import pytest

from analysis.inertia.record import analyse_record
from analysis.inertia.series import Series

PERIOD_S, RATE_HZ, DURATION_S = 1.97, 50.0, 40.0


@pytest.mark.parametrize("held_s", [0.0, 0.4, 1.0, 4.0, 9.3])
@pytest.mark.parametrize("ratio", [0.005, 0.04, 0.06])
@pytest.mark.parametrize("noise", [0.0, 1e-4, 1e-3])
def test_period_and_damping_are_those_without_the_hold(
    held_s: float, ratio: float, noise: float
) -> None:
    """A body let go at rest: ``exp(-z w t) (cos(w_d t) + z w/w_d sin(w_d t))``."""
    omega = 2.0 * math.pi / PERIOD_S
    damped = omega * math.sqrt(1.0 - ratio**2)
    time_s = np.arange(0.0, DURATION_S, 1.0 / RATE_HZ)
    free_s = np.maximum(time_s - held_s, 0.0)
    swing = np.cos(damped * free_s) + ratio * omega / damped * np.sin(damped * free_s)
    values = 0.17 * np.exp(-ratio * omega * free_s) * swing
    values += np.random.default_rng(7).normal(0.0, noise, time_s.size) if noise else 0.0
    mode = analyse_record(Series("roll", "angle", "rad", RATE_HZ, 0.0, values)).fit.modes[0]
    assert mode.period_s == pytest.approx(
        2.0 * math.pi / damped, rel=2e-3 if noise == 1e-3 else 3e-4
    )
    assert mode.damping_ratio == pytest.approx(ratio, rel=0.02, abs=1e-4)
