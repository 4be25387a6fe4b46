"""The least errors of lag and clock rate against one frequency's (Rife and Boorstyn, 1974)."""

import numpy as np
import pytest

from benchmarks.comparison_bound import least_errors
from benchmarks.comparison_motion import MEMORY, SPREAD, Seen, Sines


def test_one_frequency_has_the_bound_of_two_sines() -> None:
    turn, duration_s = 2.0 * np.pi * 1.1, 60.0
    motion = Sines(np.array([turn]), np.array([0.7]), np.array([0.4]))
    seen = Seen(gain=1.7, lag_s=0.2, rate=2e-4, mid_s=duration_s / 2.0, order=0)
    first_s = 0.2 + np.arange(6000) / 100.0  # its middle is that of the second, the lag allowed for
    second_s = 0.4 + np.arange(14400) / 240.0
    seen = Seen(seen.gain, seen.lag_s, seen.rate, float(second_s.mean()), seen.order)
    found = least_errors(motion, seen, first_s, second_s)
    # Variance of a phase in the middle 2 s^2/(a^2 n), of an angular frequency 12/T^2 times that.
    phase = SPREAD**2 * (1.0 / 6000 + 1.0 / 14400)  # a^2 is twice the signal's own mean square
    assert found[0] == pytest.approx(np.sqrt(phase) / turn, rel=0.005)
    assert found[1] == pytest.approx(np.sqrt(12.0 * phase) / duration_s / turn, rel=0.005)


def test_a_memory_costs_its_share_of_power_at_the_frequency() -> None:
    turn = 2.0 * np.pi * 0.5
    motion = Sines(np.array([turn]), np.array([1.0]), np.array([0.0]))
    seen = Seen(gain=1.0, lag_s=0.0, rate=0.0, mid_s=100.0, order=0)
    time_s = np.arange(20000) / 100.0
    white, coloured = (least_errors(motion, seen, time_s, time_s, m) for m in (0.0, MEMORY))
    power = (1.0 - MEMORY**2) / abs(1.0 - MEMORY * np.exp(-1j * turn / 100.0)) ** 2
    assert coloured / white == pytest.approx(np.full(2, np.sqrt(power)), rel=0.01)
