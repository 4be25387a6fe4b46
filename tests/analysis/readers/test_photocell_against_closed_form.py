"""Edges of pulses whose crossings are known in closed form."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.readers import Edge
from analysis.readers.photocell import edges_of_level


def ramps(period: float, first: float, count: int = 2000, low: float = 0.0) -> np.ndarray:
    """Pulses that rise over 8 samples, stay for 20, and fall over 8; crossings at half height."""
    phase = (np.arange(count) - first + period / 2.0) % period - period / 2.0
    up = np.clip(0.5 + phase / 8.0, 0.0, 1.0)
    down = np.clip(0.5 - (phase - 28.0) / 8.0, 0.0, 1.0)
    return np.asarray(low + 5.0 * np.minimum(up, down))


@given(period=st.floats(80.0, 300.0), first=st.floats(10.0, 30.0), low=st.floats(-3.0, 3.0))
def test_crossings_of_a_ramp_are_exact(period: float, first: float, low: float) -> None:
    level = ramps(period, first, low=low)
    rising = edges_of_level(level)
    expected = first + period * np.arange(rising.size)
    assert rising == pytest.approx(expected, abs=1e-6)
    assert rising.size >= int((2000 - first) / period)
    falling = edges_of_level(level, edge=Edge.FALLING)
    assert falling[0] == pytest.approx(first + 28.0, abs=1e-6)


def test_threshold_moves_the_edge_along_the_ramp() -> None:
    edges = edges_of_level(ramps(100.0, 20.0), threshold=1.25)
    assert edges[0] == pytest.approx(20.0 - 2.0, abs=1e-9)


def test_noise_makes_no_extra_edges() -> None:
    level = ramps(100.0, 20.0)
    noisy = level + 0.1 * np.random.default_rng(8).standard_normal(level.size)
    edges = edges_of_level(noisy)
    assert edges.size == edges_of_level(level).size
    assert edges == pytest.approx(edges_of_level(level), abs=1.0)


def test_an_edge_lost_in_a_gap_is_left_out_and_others_stay() -> None:
    level = ramps(100.0, 20.0)
    level[115:126] = np.nan
    level[170:180] = np.nan
    edges = edges_of_level(level)
    assert edges[:3] == pytest.approx([20.0, 220.0, 320.0], abs=1e-9)


def test_no_pulse_no_edge() -> None:
    assert edges_of_level(np.full(100, 2.0)).size == 0
    assert edges_of_level(np.full(100, np.nan)).size == 0
    assert edges_of_level(ramps(100.0, 20.0), threshold=9.0).size == 0
