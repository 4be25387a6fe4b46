"""Damping of small swings against equations of motion whose linear damping was put in."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from analysis.inertia.damping import small_damping_of
from analysis.inertia.record import RecordAnalysis, analyse_record
from analysis.inertia.series import Series

OMEGA = 2.0 * math.pi / 1.9
TIME = np.arange(0.0, 60.0, 0.05)


def let_go(
    ratio: float, seed: int, *, drag: float = 0.0, cube: float = 0.0, friction: float = 0.0
) -> RecordAnalysis:
    """Return the analysis of a decay from 0.2 rad, with noise of 0.2 mrad."""

    def rates(_: float, state: np.ndarray) -> list[float]:
        angle, rate = state
        damping = 2.0 * ratio * OMEGA * rate + drag * rate * abs(rate) + cube * rate**3
        dry = friction * math.tanh(rate / 1e-4)
        return [rate, -(OMEGA**2) * angle - damping - dry]

    angle = solve_ivp(rates, (0.0, 60.0), [0.2, 0.0], "LSODA", TIME, rtol=1e-9, atol=1e-10).y[0]
    noise = 2e-4 * np.random.default_rng(seed).standard_normal(TIME.size)
    return analyse_record(Series("decay", "angle", "rad", 20.0, 0.0, angle + noise))


LAWS = {
    "linear": {},
    "drag": {"drag": 0.3},
    "strong drag": {"drag": 1.0},
    "cube": {"cube": 0.5},
    "friction": {"friction": 3e-3},
    "drag and friction": {"drag": 0.3, "friction": 3e-3},
}


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("ratio", [0.005, 0.02])
def test_linear_damping_is_that_which_was_put_in(ratio: float, law: str) -> None:
    held = []
    for seed in range(20):
        found = small_damping_of([let_go(ratio, seed, **LAWS[law])])
        held.append(abs(found.value - ratio) <= found.uncertain.half_width(0.95)[0])
        assert abs(found.value - ratio) < 0.1 * ratio + 5e-4
    assert sum(held) >= 17


def test_the_whole_record_tells_another_damping() -> None:
    record = let_go(0.005, 1, drag=1.0)
    assert record.fit.modes[0].damping_ratio > 3.0 * 0.005
    several = small_damping_of([let_go(0.005, seed, drag=1.0) for seed in range(4)])
    assert several.value == pytest.approx(0.005, rel=0.1)
    assert several.degrees_of_freedom >= 3.0
