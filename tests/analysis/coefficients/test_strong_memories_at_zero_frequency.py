"""Restoring from loads, where the water's memory is strong at the runs' frequencies.

The load is exact: ``C - w^2 A(w) + i w B(w)`` with the added mass and damping of a damped wave.
"""

import numpy as np
import pytest

from analysis.coefficients.zero_frequency import at_zero_frequency
from analysis.uncertainty.values import UncertainValues

RESTORING = 6900.0
FREQUENCY_HZ = np.array([0.5, 0.83, 1.2])
OMEGA = 2.0 * np.pi * FREQUENCY_HZ


def restoring(size: float, noise: float, seed: int) -> UncertainValues:
    """Return what three runs tell of the restoring, from loads with noise of some N/m."""
    memory = 1j * size * OMEGA / (5.0**2 - OMEGA**2 + 4j * OMEGA)
    load = RESTORING - OMEGA**2 * 60.0 - OMEGA * memory.imag + 1j * OMEGA * (20.0 + memory.real)
    drawn = noise * np.random.default_rng(seed).standard_normal(2 * OMEGA.size)
    values = UncertainValues(np.concatenate((load.real, load.imag)) + drawn)
    for k, own in enumerate(noise * np.eye(2 * OMEGA.size)):
        values = values.plus(f"scatter {k}", own, 50.0)
    values = values.scaled(np.concatenate((-(OMEGA**-2.0), 1.0 / OMEGA)))
    kinds = np.repeat([True, False], OMEGA.size)
    found = at_zero_frequency("C33", np.tile(FREQUENCY_HZ, 2), kinds, values, restoring=True)
    return found.select([2])


@pytest.mark.parametrize("size", [300.0, 6000.0])
def test_three_frequencies_promise_no_more_than_they_know(size: float) -> None:
    found = restoring(size, 0.2, 1)
    assert abs(found.values[0] - RESTORING) < found.half_width(0.95)[0]


def test_without_memory_the_interval_stays_narrow() -> None:
    held = 0
    for seed in range(200):
        found = restoring(0.0, 0.2, seed)
        held += bool(abs(found.values[0] - RESTORING) < found.half_width(0.95)[0])
        assert found.half_width(0.95)[0] < 0.01 * RESTORING
    assert held >= 186  # 95 % of 200, less two standard deviations and a half
