"""Zeros drawn at random, drifting evenly or fixed: what the records at rest say of their wander."""

from dataclasses import replace

import numpy as np
import pytest

from analysis.gap.observe.components import Component, GapRun, Observation, Part
from analysis.gap.observe.wander import wander, wandered
from hardware.description.channels import FORCES
from hardware.description.setpoint import Medium, SetPoint
from sim.effects.campaign import CampaignRun
from sim.rig import SimulatedRig
from tests.analysis.gap.small import record

NOISE_N = 0.002
SPACING_S = 900.0


def at_rest(values_n: np.ndarray) -> list[GapRun]:
    """Return records at rest in air, a quarter of an hour apart, with these readings."""
    runs = []
    for number, value in enumerate(values_n):
        parts = tuple(Component(name, Part.MEAN) for name in FORCES)
        seen = Observation(parts, np.array([value, 0.0]), np.full(2, NOISE_N))
        place = CampaignRun(number, SPACING_S * number)
        point = SetPoint(1.0, 0.0, 0.0, 0.0, Medium.AIR)
        runs.append(GapRun(f"zero-{number}", point, place, seen, 10, 100.0, stands_at_m=(0.0, 0.0)))
    return runs


def drawn(deviation_n: float, count: int, seed: int, slope_n: float = 0.0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    noise = NOISE_N * rng.standard_normal(count)
    return 0.4 + slope_n * np.arange(count) + deviation_n * rng.standard_normal(count) + noise


@pytest.mark.slow
def test_a_wander_comes_back_whatever_the_zeros_offset_and_even_drift(rig: SimulatedRig) -> None:
    squares = []
    for seed in range(60):
        level_n, _ = wander(rig, at_rest(drawn(0.05, 30, seed, slope_n=0.03)))[FORCES[0]]
        squares.append(level_n**2)
    student = 2.23 / 1.96  # 0.37 of 28 degrees of freedom at 0.975, from a table
    assert np.mean(squares) == pytest.approx((0.05 * student) ** 2, rel=0.25)


@pytest.mark.slow
def test_few_records_say_it_wider(rig: SimulatedRig) -> None:
    """A new zero lies within 1.96 of them in nine of ten or so, for two records as for twelve."""
    for count in (2, 12):
        inside = []
        for seed in range(200):
            zeros = drawn(0.05, count + 1, 1000 * count + seed)
            found = wander(rig, at_rest(zeros[:count])).get(FORCES[0])
            level_n = 0.0 if found is None else found[0]
            inside.append(abs(zeros[count] - np.median(zeros[:count])) < 1.96 * level_n)
        assert 0.87 <= np.mean(inside) <= 0.99, count


@pytest.mark.parametrize("count", [3, 8])
def test_one_record_that_is_off_is_no_wander(rig: SimulatedRig, count: int) -> None:
    zeros = drawn(0.0, count, 3)
    zeros[-1] += 1.0
    level_n, _ = wander(rig, at_rest(zeros)).get(FORCES[0], (0.0, 0.0))
    assert level_n < 0.1  # N, of the one that it is off by


@pytest.mark.slow
def test_noise_alone_is_hardly_a_wander(rig: SimulatedRig) -> None:
    found = [wander(rig, at_rest(drawn(0.0, 12, seed))) for seed in range(40)]
    levels = [one[FORCES[0]][0] if one else 0.0 for one in found]
    assert np.median(levels) < NOISE_N
    assert max(levels) < 4.0 * NOISE_N


def test_a_random_walk_makes_the_trend_that_it_makes_in_a_simulation(rig: SimulatedRig) -> None:
    """The slope's scatter in closed form against 2,000 walks of 20 s fitted with straight lines."""
    run = replace(record(rig, [], 3)[0], periods=16)
    walk, seconds = 0.01, 16 / run.set_point.frequency_hz
    rng = np.random.default_rng(5)
    at_s = np.arange(0.0, seconds, 0.02)
    steps = walk * np.sqrt(0.02) * rng.standard_normal((2000, len(at_s)))
    slopes = np.polyfit(at_s, np.cumsum(steps, axis=1).T, 1)[0]
    wide = wandered(run, {FORCES[0]: (0.0, walk)})
    part = Component(FORCES[0], Part.TREND)
    at = run.observed.components.index(part)
    added = np.sqrt(wide.observed.uncertainty[at] ** 2 - run.observed.uncertainty[at] ** 2)
    assert added * run.set_point.frequency_hz == pytest.approx(np.std(slopes), rel=0.05)
