"""Intervals of a photocell: what was taken out of, or put into, a row of pulses is found."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hardware.roles import Pulse
from pmm.devices.pulses import judge_pulses

TURN = 2.0 * math.pi


def by_hand(count: int, seed: int) -> list[Pulse]:
    """Pulses of a shaft that is turned very unevenly, with its angle known."""
    steps = np.random.default_rng(seed).uniform(0.2, 5.0, count)
    times = np.cumsum(steps)
    return [Pulse(i, float(times[i]), TURN * i + 0.01) for i in range(count)]


def even(count: int) -> list[Pulse]:
    """Pulses of a shaft that turns evenly, its angle unknown."""
    return [Pulse(i, 0.5 * i) for i in range(count)]


@given(st.integers(3, 30), st.integers(0, 2**16))
def test_uneven_turns_are_all_right_where_the_angle_is_known(count: int, seed: int) -> None:
    found = judge_pulses(by_hand(count, seed))
    assert len(found) == count - 1
    assert [one.verdict for one in found] == [""] * (count - 1)
    assert [one.turns for one in found] == pytest.approx([1.0] * (count - 1))


@pytest.mark.parametrize("pulses", [by_hand(9, 1), even(9)], ids=["angle", "time"])
@pytest.mark.parametrize("gone", [1, 2])
def test_pulses_that_stayed_away_are_counted(pulses: list[Pulse], gone: int) -> None:
    left = pulses[:4] + pulses[4 + gone :]
    renumbered = [Pulse(i, one.time_s, one.shaft_angle_rad) for i, one in enumerate(left)]
    found = judge_pulses(renumbered)
    assert [one.missing for one in found] == [0, 0, 0, gone, *[0] * (len(found) - 4)]
    assert found[3].verdict == f"{gone} missing"


@pytest.mark.parametrize("pulses", [by_hand(9, 2), even(9)], ids=["angle", "time"])
def test_a_pulse_too_many_is_found(pulses: list[Pulse]) -> None:
    before = pulses[4]
    angle = before.shaft_angle_rad + 0.1
    more = [*pulses[:5], Pulse(5, before.time_s + 0.02, angle), *pulses[5:]]
    renumbered = [Pulse(i, one.time_s, one.shaft_angle_rad) for i, one in enumerate(more)]
    found = judge_pulses(renumbered)
    assert [one.extra for one in found].index(True) == 4
    assert found[4].verdict == "one too many"


def test_a_pulse_that_was_counted_and_not_received_is_no_missing_one() -> None:
    pulses = even(9)
    found = judge_pulses(pulses[:4] + pulses[5:])
    assert [(one.missing, one.lost) for one in found][3] == (0, 1)
    assert found[3].verdict == "1 counted, not received"


def test_a_shaft_that_turns_backwards_is_judged_alike() -> None:
    found = judge_pulses([Pulse(i, 1.0 * i, -TURN * i) for i in range(4)])
    assert [one.turns for one in found] == pytest.approx([1.0] * 3)


@pytest.mark.parametrize("count", [0, 1])
def test_fewer_than_two_pulses_have_no_interval(count: int) -> None:
    assert judge_pulses(even(count)) == ()
