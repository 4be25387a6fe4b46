"""Dry friction at a pivot: period and flags of records that are exact half swing by half swing.

Between two turning points a linear swing with Coulomb and linear damping goes about a middle that
friction moves by the dead zone towards where it comes from, so that its turning points keep time.
"""

import numpy as np
import pytest

from analysis.inertia.record import RecordAnalysis, analyse_record
from analysis.inertia.series import Series
from hardware.description.arrays import FloatArray
from hardware.description.flags import Severity

PERIOD_S = 2.3
FIRST = 0.08
RATE_HZ = 50.0


def swing(dead_zone: float, ratio: float, duration_s: float = 120.0) -> FloatArray:
    omega = 2.0 * np.pi / PERIOD_S
    fall = ratio * omega / np.sqrt(1.0 - ratio**2)
    time_s = np.arange(int(duration_s * RATE_HZ)) / RATE_HZ
    number = (time_s // (PERIOD_S / 2.0)).astype(int)
    values, turning = np.empty(time_s.size), FIRST
    for k in range(int(number[-1]) + 1):
        inside = number == k
        after = time_s[inside] - k * PERIOD_S / 2.0
        if abs(turning) <= dead_zone:
            values[inside] = turning
            continue
        middle = np.sign(turning) * dead_zone
        shape = np.cos(omega * after) + fall / omega * np.sin(omega * after)
        values[inside] = middle + (turning - middle) * np.exp(-fall * after) * shape
        turning = middle - (turning - middle) * np.exp(-fall * PERIOD_S / 2.0)
    return values


def analysed(dead_zone: float, ratio: float, seed: int) -> RecordAnalysis:
    noise = 1e-4 * np.random.default_rng(seed).standard_normal(int(120.0 * RATE_HZ))
    return analyse_record(
        Series("x", "angle", "rad", RATE_HZ, 0.0, swing(dead_zone, ratio) + noise)
    )


@pytest.mark.sample(1)
@pytest.mark.parametrize("ratio", [0.0005, 0.003])
@pytest.mark.parametrize("dead_zone", [3e-5, 1e-4, 3e-4, 1e-3])
def test_friction_does_not_shift_the_period(dead_zone: float, ratio: float) -> None:
    found = [analysed(dead_zone, ratio, seed).period() for seed in range(4)]
    off = np.array([(one.value - PERIOD_S) / one.uncertainty for one in found])
    assert np.abs(off).max() < 3.0
    assert np.abs(off.mean()) < 1.5


def test_friction_and_damping_are_told_apart() -> None:
    rates = analysed(3e-4, 0.003, 0).modes[0].rates
    assert rates.friction == pytest.approx(4.0 * 3e-4 / PERIOD_S, rel=0.03)
    assert rates.viscous_1_s == pytest.approx(0.003 * 2.0 * np.pi / PERIOD_S, rel=0.05)
    assert rates.quadratic * FIRST < 0.05 * rates.viscous_1_s


@pytest.mark.parametrize(("dead_zone", "warned"), [(0.0, False), (3e-5, False), (5e-4, True)])
def test_only_friction_that_matters_is_warned_of(dead_zone: float, warned: bool) -> None:
    flags = [one for one in analysed(dead_zone, 0.003, 1).flags if one.code != "few_swings"]
    assert any(one.severity is Severity.WARNING for one in flags) == warned
    if warned:
        assert "pmm gap pendulum" in flags[0].message
