"""What a further run is worth, against Bayes' rule worked out for a run that comes as expected."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.gap.design.beside import NO_GAP
from analysis.gap.design.information_gain import ENOUGH, Worth, by_itself, expected_gain
from analysis.gap.design.proposals import Choices, proposals, set_points
from analysis.gap.forward.candidate import candidates
from analysis.gap.forward.free_numbers import free_numbers
from analysis.gap.forward.tolerances import Tolerances
from analysis.gap.observe.components import GapRun
from analysis.gap.search.fit import linearised_at
from hardware.description.arrays import FloatArray
from hardware.description.oscillator import Range
from hardware.description.setpoint import Medium, SetPoint
from sim.effects.catalogue import find
from sim.rig import SimulatedRig
from tests.analysis.gap.small import problem_of

Pairs = dict[tuple[int, int], float]

NAMES = ("zero-drift", "coulomb-friction")

shares = st.lists(st.floats(0.01, 1.0), min_size=2, max_size=6)


def table(count: int, apart: Pairs) -> FloatArray:
    odds = np.zeros((count, count))
    for (i, j), value in apart.items():
        odds[i, j] = odds[j, i] = value
    return odds


def test_two_answers_gain_what_lies_between_them() -> None:
    assert expected_gain([0.9, 0.1], table(2, {(0, 1): 7.0})) == pytest.approx(7.0)


def test_a_rival_that_a_run_does_not_touch_is_left_standing() -> None:
    # Whichever of the three is right: one rival falls to e^-15, the other keeps its odds.
    apart = {(0, 1): 15.0, (0, 2): 0.0, (1, 2): 15.0}
    first = math.log((0.2 + 0.3) / (0.2 * math.exp(-15.0) + 0.3))
    second = 15.0
    third = math.log((0.5 + 0.2) / (0.5 + 0.2 * math.exp(-15.0)))
    expected = 0.5 * first + 0.2 * second + 0.3 * third
    assert expected_gain([0.5, 0.2, 0.3], table(3, apart)) == pytest.approx(expected)


def test_what_is_worth_more_than_enough_goes_by_how_much_more() -> None:
    even = [0.5, 0.5]
    worth = {odds: Worth.of(even, table(2, {(0, 1): odds})) for odds in (19.0, 30.0, 5000.0)}
    assert [one.gain for one in worth.values()] == pytest.approx([19.0, ENOUGH, ENOUGH])
    assert worth[5000.0].uncapped == pytest.approx(5000.0)
    assert sorted(worth, key=lambda odds: worth[odds].order) == [5000.0, 30.0, 19.0]


@pytest.mark.slow
def test_of_runs_that_are_worth_the_same_the_gentlest_comes_first(
    rig: SimulatedRig, clean: tuple[GapRun, ...]
) -> None:
    problem = problem_of(rig, clean[:2])
    leading = ((NO_GAP, 0.5), (NO_GAP, 0.5))  # nothing tells what is the same apart
    choices = Choices(Range(0.5, 1.0), Range(0.01, 0.02), special=())
    found = proposals(problem, leading, choices, free_numbers(rig, Tolerances()), Tolerances())
    speeds = [
        one.set_point.eccentricity_m * one.set_point.frequency_hz
        for one in found
        if one.set_point is not None
    ]
    assert {one.gain for one in found} == {0.0}
    assert speeds == sorted(speeds)


def test_what_does_not_repeat_is_worth_what_a_run_shows_of_it(
    rig: SimulatedRig, clean: tuple[GapRun, ...]
) -> None:
    """Half the square of its sigma, of which the free noise levels take a part."""
    problem = problem_of(rig, clean[:2])
    (drift, more), (friction, _) = (
        [linearised_at(problem, (part,), times * part.start) for times in (1.0, 10.0)]
        for part in (next(iter(candidates(find(name), (0.5, 1.0)))) for name in NAMES)
    )
    trends = drift.signature[~problem.simulator.stack.steady]
    odds = by_itself(problem, "rest", [(drift, 0.4), (friction, 0.3), (NO_GAP, 0.3)])
    assert 0.0 < odds[0, 2] <= 0.5 * trends @ trends / 2.0
    assert odds[0, 2] == odds[0, 1] == odds[1, 0]
    assert odds[1, 2] == 0.0  # friction repeats
    assert by_itself(problem, "rest", [(more, 0.5), (NO_GAP, 0.5)])[0, 1] == ENOUGH
    assert not by_itself(problem, "injection", [(more, 0.5), (NO_GAP, 0.5)]).any()


def test_a_run_that_tells_all_apart_is_worth_more_than_one_that_throws_one_far() -> None:
    even = expected_gain([0.5, 0.25, 0.25], table(3, {(0, 1): 10.0, (0, 2): 10.0, (1, 2): 10.0}))
    uneven = expected_gain([0.5, 0.25, 0.25], table(3, {(0, 1): 20.0, (0, 2): 1.0, (1, 2): 20.0}))
    assert even > uneven


def test_a_single_answer_gains_nothing() -> None:
    assert expected_gain([1.0], table(1, {})) == 0.0


@given(shares, st.data())
def test_what_is_gained_lies_between_nothing_and_enough(
    shares: list[float], data: st.DataObject
) -> None:
    pairs = [(i, j) for i in range(len(shares)) for j in range(i + 1, len(shares))]
    apart = {pair: data.draw(st.floats(0.0, 100.0)) for pair in pairs}
    assert -1e-9 <= expected_gain(shares, table(len(shares), apart)) <= ENOUGH + 1e-9


def test_what_is_proposed_can_be_set_on_a_dial() -> None:
    found = list(set_points(Choices(Range(0.25, 1.9996), Range(0.013, 0.06))))
    assert {one.frequency_hz for one in found} == {0.25, 0.707, 1.9996}  # no step past a limit
    assert {one.eccentricity_m for one in found} == {0.013, 0.06}


def test_what_a_rig_can_set_in_one_way_only_is_proposed_once() -> None:
    one = Choices(Range(0.8, 0.8), Range(0.02, 0.02), strut_phase_rad=(0.0,))
    assert list(set_points(one)) == [SetPoint(0.8, 0.02, medium=medium) for medium in Medium]
