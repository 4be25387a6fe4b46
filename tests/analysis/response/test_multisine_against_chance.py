"""Designed phases and lines against random ones and against what they promise."""

import numpy as np
import pytest

from analysis.response.multisine import odd_lines_with_gaps, schroeder_phases
from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError


def crest_factor(phases_rad: FloatArray) -> float:
    """Peak over root mean square of equal lines, one at each harmonic from the first on."""
    orders = np.arange(1.0, len(phases_rad) + 1.0)
    theta = np.linspace(0.0, 2.0 * np.pi, 16 * len(orders), endpoint=False)
    wave = np.sin(np.outer(theta, orders) + phases_rad).sum(axis=1)
    return float(np.abs(wave).max() / np.sqrt(len(orders) / 2.0))


@pytest.mark.parametrize("count", [8, 16, 31])
def test_schroeder_beats_random_phases(count: int) -> None:
    own = crest_factor(schroeder_phases(np.ones(count)))
    generator = np.random.default_rng(7)
    by_chance = [crest_factor(generator.uniform(0.0, 2.0 * np.pi, count)) for _ in range(200)]
    assert own < np.quantile(by_chance, 0.02)
    assert own < 1.95


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
