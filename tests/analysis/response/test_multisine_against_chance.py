"""Designed phases and lines against random ones and against what they promise."""

import numpy as np
import pytest

from analysis.response.multisine import (
    crest_factor,
    odd_lines_with_gaps,
    schroeder_phases,
    waveform,
)
from hardware.description.errors import ConfigurationError


@pytest.mark.parametrize("count", [8, 16, 31])
def test_schroeder_beats_random_phases(count: int) -> None:
    orders, amplitudes = np.arange(1.0, count + 1.0), np.ones(count)
    own = crest_factor(orders, amplitudes, schroeder_phases(amplitudes))
    generator = np.random.default_rng(7)
    by_chance = [
        crest_factor(orders, amplitudes, generator.uniform(0.0, 2.0 * np.pi, count))
        for _ in range(200)
    ]
    assert own < np.quantile(by_chance, 0.02)
    assert own < 1.95


def test_a_single_sine_has_the_square_root_of_two() -> None:
    assert crest_factor(np.array([1.0]), np.ones(1), np.zeros(1)) == pytest.approx(2.0**0.5)


def test_waveform_is_its_sum() -> None:
    wave = waveform(np.array([1.0, 3.0]), np.array([2.0, 0.5]), np.array([0.3, 1.0]))
    theta = 2.0 * np.pi * 10 / len(wave)
    expected = 2.0 * np.sin(theta + 0.3) + 0.5 * np.sin(3.0 * theta + 1.0)
    assert wave[10] == pytest.approx(expected)


@pytest.mark.parametrize("seed", range(5))
def test_one_of_each_group_is_left_out(seed: int) -> None:
    lines = odd_lines_with_gaps(1, 31, 4, seed)
    assert all(n % 2 for n in lines)
    for first in range(1, 31, 8):
        assert len([n for n in range(first, first + 8, 2) if n in lines]) == 3


def test_gaps_differ_from_seed_to_seed() -> None:
    assert len({odd_lines_with_gaps(1, 31, 4, seed) for seed in range(10)}) > 5


def test_a_band_without_a_group_is_refused() -> None:
    with pytest.raises(ConfigurationError, match="make no group of 4"):
        odd_lines_with_gaps(1, 5, 4, 1)
