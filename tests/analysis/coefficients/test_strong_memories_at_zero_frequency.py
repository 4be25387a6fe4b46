"""Restoring from loads in phase, where the water's memory is strong at the runs' frequencies.

The load is exact: ``C - w^2 A(w)`` with the added mass of a damped wave, whose limit at zero is C.
"""

import numpy as np
import pytest

from analysis.coefficients.zero_frequency import extrapolate
from analysis.uncertainty.values import UncertainValues

RESTORING = 6900.0
FREQUENCY_HZ = (0.5, 0.83, 1.2)


def in_phase(size: float, noise: float, seed: int) -> UncertainValues:
    omega = 2.0 * np.pi * np.array(FREQUENCY_HZ)
    memory = 1j * size * omega / (5.0**2 - omega**2 + 4j * omega)
    load = RESTORING - omega**2 * (60.0 + memory.imag / omega)
    drawn = noise * np.random.default_rng(seed).standard_normal(omega.size)
    values = UncertainValues(load + drawn)
    for k, own in enumerate(noise * np.eye(omega.size)):
        values = values.plus(f"scatter {k}", own, 50.0)
    return values


@pytest.mark.parametrize("size", [300.0, 6000.0])
def test_three_frequencies_promise_no_more_than_they_know(size: float) -> None:
    found = extrapolate("C33", FREQUENCY_HZ, in_phase(size, 0.2, 1))
    assert not found.checked
    assert abs(found.uncertain.values[0] - RESTORING) < found.uncertain.half_width(0.95)[0]


def test_without_memory_the_interval_stays_narrow() -> None:
    held = 0
    for seed in range(200):
        whole = extrapolate("C33", FREQUENCY_HZ, in_phase(0.0, 0.2, seed))
        assert whole.checked
        found = whole.uncertain
        held += bool(abs(found.values[0] - RESTORING) < found.half_width(0.95)[0])
        assert found.half_width(0.95)[0] < 4.0
    assert held >= 186  # 95 % of 200, less two standard deviations and a half
