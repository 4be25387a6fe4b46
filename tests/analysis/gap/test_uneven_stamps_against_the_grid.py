"""What the diagnosis sees of a record with lost rows on jittered stamps, against the whole one."""

from dataclasses import replace

import numpy as np
import pytest

from analysis.gap.observe.components import STEADY_PARTS, Part
from analysis.gap.observe.observation import observe
from analysis.readers.dataset import from_dataset
from analysis.recording import Recording
from hardware.description.setpoint import SetPoint
from sim.rig import vertical_rig
from sim.run import simulate


@pytest.fixture(scope="module")
def whole() -> Recording:
    """Return a record at 1 kHz."""
    point = SetPoint(0.8, 0.02, 0.0, 1.0)
    return from_dataset(simulate(vertical_rig(), point, periods=8, sample_rate_hz=1000.0, seed=1))


@pytest.fixture(scope="module")
def uneven(whole: Recording) -> Recording:
    """Keep one row of 6 to 14 at random, and of these lose every fifth, 20 in a row too."""
    rng = np.random.default_rng(5)
    rows = np.cumsum(rng.integers(6, 15, whole.sample_count))
    rows = rows[rows < whole.sample_count]
    kept = rng.random(len(rows)) > 0.2
    kept[300:320] = False
    at = rows[kept]
    values = np.array([whole.values(name)[at] for name in whole.channel_names])
    stamps_s = whole.time_s()[at]
    rate_hz = (len(at) - 1) / float(np.ptp(stamps_s))
    return replace(
        whole, samples=values, stamps_s=stamps_s, start_s=float(stamps_s[0]), sample_rate_hz=rate_hz
    )


def test_means_and_harmonics_are_those_of_the_grid(whole: Recording, uneven: Recording) -> None:
    full, lost = observe(whole).observation, observe(uneven).observation
    assert {one.part for one in lost.components} <= {*STEADY_PARTS, Part.PULSES}
    misses = []
    for part, value, u in zip(lost.components, lost.values, lost.uncertainty, strict=True):
        there = full.components.index(part)
        misses.append((value - full.values[there]) / np.hypot(u, full.uncertainty[there]))
    assert len(misses) > 50
    assert np.abs(misses).max() < 5.0
    assert np.sqrt(np.mean(np.square(misses))) < 1.5


def test_the_shaft_turns_once_a_period(uneven: Recording) -> None:
    assert observe(uneven).observation.turns_per_period == pytest.approx(1.0, abs=2e-3)
    assert not observe(uneven).observation.quiet
