"""Amplifiers' filters against scipy's analogue ones, and their delays."""

import numpy as np
import pytest
from scipy import signal

from tests.sealed.closed_forms import change
from tests.sealed.generator.filters import Complex, bessel, butterworth, filtered
from tests.sealed.generator.forms import FORMS

RATE = 2000.0
LAGS = [effect for effect in FORMS if effect.name == "amplifier-lag"]


def _response(poles: Complex, frequency_hz: float) -> complex:
    times = np.arange(0.0, 20.0 / frequency_hz, 1.0 / RATE)
    turn = 2.0 * np.pi * frequency_hz * times
    out = filtered(np.cos(turn)[None, :], poles, RATE)[0]
    half = len(times) // 2
    return complex(2.0 * np.mean(out[half:] * np.exp(-1j * turn[half:])))


@pytest.mark.parametrize("frequency", [1.0, 8.0, 20.0])
def test_gain_and_phase(frequency: float) -> None:
    omega = 2.0 * np.pi * 10.0
    for ours, theirs in (
        (butterworth(4, 10.0), signal.butter(4, omega, analog=True)),
        (bessel(10.0), signal.bessel(4, omega, analog=True, norm="delay")),
    ):
        expected = signal.freqs(*theirs, worN=[2.0 * np.pi * frequency])[1][0]
        assert _response(ours, frequency) == pytest.approx(expected, abs=2e-3)


def test_rest_stays_at_rest() -> None:
    level = np.full((2, 300), 3.5)
    assert filtered(level, butterworth(4, 7.0), 200.0) == pytest.approx(level)


@pytest.mark.slow  # the time loop takes 20 s to compile
def test_every_form_of_a_lag_delays_by_its_size() -> None:
    size = 4e-3
    assert len(LAGS) == 3
    for effect in LAGS:
        seen = change(effect, size).of["force_aft"][1]
        world_a = change(LAGS[0], size).of["force_aft"][1]
        assert abs(seen - world_a) < 0.05 * abs(world_a)
