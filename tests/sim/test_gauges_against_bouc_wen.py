"""Oracle: Bouc and Wen's and Masing's rules followed step by step, and Rapp's amplifier."""

import math

import numpy as np
import pytest

from hardware.description.arrays import FloatArray
from sim.gauges.characteristic import Curve, PowerLoop, SaturatingLoop, follow, limited
from sim.gauges.dynamometer import Dynamometer
from sim.stage import Block

POINTS = 4000
PHASE = 2.0 * math.pi * np.arange(2 * POINTS) / POINTS
FORCE = 5.0 + 40.0 * np.sin(PHASE)  # two periods about a mean
LAST = slice(POINTS, None)


def read(gauge: Dynamometer, force: FloatArray = FORCE) -> FloatArray:
    return gauge.read(None, Block(0, force.size, 100.0), force)[1][LAST]


def lost(gauge: Dynamometer, force: FloatArray = FORCE) -> float:
    """Area of the loop of reading over force; positive where the reading lags."""
    values = force[LAST]
    reading = read(gauge, force)
    return float(np.sum((reading + np.roll(reading, -1)) / 2.0 * (np.roll(values, -1) - values)))


@pytest.mark.parametrize("distance_n", [10.0, 30.0, 100.0])
def test_saturating_loop(distance_n: float) -> None:
    """Within 1e-4 of its width, once it repeats."""
    z, course = 0.0, list[float]()
    for _ in range(10):
        course = []
        for at, before in zip(FORCE[LAST], np.roll(FORCE[LAST], 1), strict=True):
            way = math.copysign(1.0, at - before)
            z = way + (z - way) * math.exp(-abs(at - before) / distance_n)
            course.append(z)
    right_at = 35.0
    in_phase = math.tanh(right_at / distance_n) / right_at * (FORCE[LAST] - 5.0)
    expected = FORCE[LAST] - 0.2 * (np.array(course) - in_phase)
    found = read(Dynamometer(loops=(SaturatingLoop(0.2, distance_n, right_at),)))
    assert np.abs(found - expected).max() < 1e-4 * 0.2


def test_the_first_way_is_the_virgin_curve() -> None:
    force = np.linspace(0.0, 50.0, 100)
    lag = SaturatingLoop(0.2, 10.0, 40.0).lag(force, follow(None, force)[1])
    expected = 0.2 * (1.0 - np.exp(-force / 10.0) - math.tanh(4.0) / 40.0 * force)
    assert np.abs(lag - expected)[1:].max() < 1e-12


def test_rayleighs_loop_is_the_one_of_the_second_power() -> None:
    own = read(Dynamometer(hysteresis_1_n=2e-3))
    assert np.abs(own - read(Dynamometer(loops=(PowerLoop(1e-3 * 30.0**2, 30.0),)))).max() < 1e-12


def test_swelling_is_masings_rule() -> None:
    """Up from -F_m on twice the virgin curve ``F + beta F^2``, at half the scale."""
    beta, largest = 2e-3, 40.0
    force = FORCE - 5.0
    loop = PowerLoop(beta / 2.0 * 25.0**2, 25.0, swelling=1.0)
    up = np.cos(PHASE[LAST]) > 0.0
    behind = (np.where(up, 1.0, -1.0) * force[LAST] + largest) / 2.0
    virgin = behind + beta * behind**2
    branch = np.where(up, 1.0, -1.0) * (2.0 * virgin - largest - beta * largest**2)
    expected = branch - beta * 25.0 * force[LAST]  # the gain was found at 25 N
    assert np.abs(read(Dynamometer(loops=(loop,)), force) - expected).max() < 1e-5


@pytest.mark.parametrize("power", [0.5, 1.0, 2.0, 3.0])
def test_loss_per_cycle_goes_with_the_width(power: float) -> None:
    """4/3 of twice the width times the half range, at any amplitude."""
    gauge = Dynamometer(loops=(PowerLoop(0.1, 25.0, power),))
    for half in (10.0, 40.0):
        expected = -(8.0 / 3.0) * 0.1 * (half / 25.0) ** power * half
        found = lost(gauge, half * np.sin(PHASE))
        assert abs(found / expected) == pytest.approx(1.0, abs=1e-3)
        assert lost(Dynamometer(), half * np.sin(PHASE)) == pytest.approx(0.0, abs=1e-9)


def test_rapps_amplifier() -> None:
    force = np.array([-60.0, -30.0, 0.0, 30.0, 1e4])
    found = limited(force, -60.0, 30.0, 0.1)
    expected = [-60.0 / 2**0.1, -30.0 / (1 + 0.5**10) ** 0.1, 0.0, 30.0 / 2**0.1, 30.0]
    np.testing.assert_allclose(found, expected, rtol=1e-12)
    hard = limited(force, -60.0, 30.0, 1e-3)
    assert np.abs(hard - np.clip(force, -60.0, 30.0)).max() < 0.05
    assert limited(force, None, 30.0, 0.1)[0] == -60.0


def test_curves() -> None:
    """Even: 4/(3 pi) of |cos| at order 2; odd: 3/4 and 1/4 of the cube."""
    force = 40.0 * np.cos(PHASE)
    even = read(Dynamometer(curves=(Curve(1e-3, 20.0, 1.0),)), force) - force[LAST]
    odd = read(Dynamometer(curves=(Curve(1e-3, 20.0, 3.0, odd=True),)), force) - force[LAST]
    waves = [np.fft.rfft(one)[:4].real * 2.0 / POINTS for one in (even, odd)]
    assert waves[0][2] == pytest.approx(1e-3 * 40.0 * 4.0 / (3.0 * math.pi), rel=1e-5)
    cube = 1e-3 * 20.0 * 2.0**3
    np.testing.assert_allclose(waves[1][[1, 3]], [0.75 * cube, 0.25 * cube], rtol=1e-9)
