"""Expansion and order of a plan's runs: counts, permutations, and what comes between the runs."""

import math
from collections import Counter
from dataclasses import replace
from itertools import pairwise
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hardware.description.errors import ConfigurationError
from hardware.description.kinds import Motion, RunKind
from hardware.description.known_loads import KnownMass
from hardware.description.oscillator import HORIZONTAL_1963, VERTICAL_1963, Oscillator
from hardware.description.setpoint import Medium, check_within
from pmm.plan.expansion import all_of, expand, snake, strut_phase_of
from pmm.plan.ordering import in_order, runs_of, with_control, with_zeros
from pmm.plan.plan_tables import (
    ControlTable,
    Defaults,
    OrderTable,
    PlanEntry,
    PlanTables,
    Scheme,
    ZeroTable,
)
from pmm.plan.run_plan import RunPlan
from tests.pmm.plan.plans import run

CHANNELS = ("force_aft", "force_fore")


@st.composite
def matrices(draw: st.DrawFn) -> PlanEntry:
    """Entries of heave or pitch with up to 4 x 4 x 4 combinations, up to 3 times."""
    frequencies = draw(st.lists(st.floats(0.1, 2.0), min_size=1, max_size=4, unique=True))
    amplitudes = draw(st.lists(st.floats(1e-3, 0.06), min_size=1, max_size=4, unique=True))
    speeds = draw(st.lists(st.floats(0.0, 3.0), max_size=4, unique=True))
    return PlanEntry(
        motion=draw(st.sampled_from([Motion.HEAVE, Motion.PITCH])),
        frequencies_hz=tuple(frequencies),
        amplitudes_m=tuple(amplitudes),
        speeds_m_s=tuple(speeds),
        repeats=draw(st.integers(1, 3)),
    )


def _made(entry: PlanEntry, oscillator: Oscillator = VERTICAL_1963, **more: Any) -> list[RunPlan]:
    return expand(entry, Defaults(**more), oscillator, CHANNELS, all_of)


@given(matrices())
def test_every_combination_is_there_once_for_each_repeat(entry: PlanEntry) -> None:
    runs = _made(entry)
    speeds = entry.speeds_m_s or (0.0,)
    count = len(entry.frequencies_hz) * len(entry.amplitudes_m) * len(speeds)
    assert len(runs) == count * (entry.repeats or 1)
    points = Counter(one.set_point for one in runs)
    assert len(points) == count
    assert set(points.values()) == {entry.repeats}


@given(st.lists(st.lists(st.integers(), min_size=1, max_size=4, unique=True), max_size=4))
def test_a_snake_is_all_combinations_and_moves_one_list_by_one_step(lists: list[Any]) -> None:
    walked = list(snake(lists))
    assert sorted(walked) == sorted(all_of(lists))
    for one, other in pairwise(walked):
        steps = [
            abs(values.index(a) - values.index(b))
            for values, a, b in zip(lists, one, other, strict=True)
        ]
        assert sum(steps) == 1


@given(st.lists(matrices(), min_size=1, max_size=3), st.integers(0, 2**31), st.booleans())
def test_a_random_order_is_a_permutation_and_the_same_for_a_seed(
    entries: list[PlanEntry], seed: int, across: bool
) -> None:
    made = [_made(one) for one in entries]
    order = OrderTable(Scheme.RANDOM, seed, across)
    runs = in_order(made, order)
    assert runs == in_order(made, order)
    assert Counter(map(id, runs)) == Counter(id(one) for part in made for one in part)
    if not across:
        first = len(made[0])
        assert Counter(map(id, runs[:first])) == Counter(map(id, made[0]))


def test_what_is_no_matrix_keeps_its_place_in_a_random_order() -> None:
    dry = [run(name=f"dry-{i}", kind=RunKind.DRY) for i in range(5)]
    wet = [run(name=f"wet-{i}") for i in range(5)]
    runs = in_order([dry, wet], OrderTable(Scheme.RANDOM, 4))
    assert runs[:5] == dry
    assert runs[5:] != wet
    assert in_order([dry, wet], OrderTable()) == [*dry, *wet]


@given(st.integers(1, 30), st.integers(1, 12))
def test_the_control_condition_comes_first_last_and_every_so_many(total: int, every: int) -> None:
    control = run(name="control", kind=RunKind.CONTROL)
    runs = with_control([run(name=str(i)) for i in range(total)], control, every)
    numbers = [one.repeat for one in runs if one.kind is RunKind.CONTROL]
    assert numbers == list(range(1, 2 + math.ceil(total / every)))
    assert runs[0].kind is runs[-1].kind is RunKind.CONTROL
    between, longest = 0, 0
    for one in runs:
        between = 0 if one.kind is RunKind.CONTROL else between + 1
        longest = max(longest, between)
    assert longest == min(every, total)


@given(st.lists(st.sampled_from(["water", "air", "push"]), max_size=20), st.integers(1, 5))
def test_each_run_lies_between_the_zero_runs_that_it_names(kinds: list[str], every: int) -> None:
    what = {"water": RunKind.OSCILLATION, "air": RunKind.DRY, "push": RunKind.PUSH}
    given_runs = []
    for i, kind in enumerate(kinds):
        one = run(name=f"run-{i}", kind=what[kind], pause_before_s=60.0)
        medium = Medium.AIR if kind == "air" else Medium.WATER
        given_runs.append(_in(one, medium))
    runs = with_zeros(given_runs, ZeroTable(5.0, every))
    places = {one.name: number for number, one in enumerate(runs)}
    assert len(places) == len(runs)
    assert [one.name for one in runs if one.kind is not RunKind.ZERO] == [
        one.name for one in given_runs
    ]
    for place, one in enumerate(runs):
        if not one.kind.wants_zeros:
            continue
        before, after = places[one.zero_before], places[one.zero_after]
        assert before < place < after
        assert after - before <= every + 1
        medium = one.set_point.medium
        assert {runs[before].set_point.medium, runs[after].set_point.medium} == {medium}


def _in(one: RunPlan, medium: Medium) -> RunPlan:
    return replace(one, set_point=replace(one.set_point, medium=medium))


def test_a_zero_run_takes_over_pause_and_settings_of_its_run() -> None:
    runs = with_zeros([run(pause_before_s=60.0, speed_m_s=1.2, phase_rad=1.0)], ZeroTable(5.0))
    first, middle, last = runs
    assert (first.pause_before_s, middle.pause_before_s, last.pause_before_s) == (60.0, 0.0, 60.0)
    assert first.set_point.frequency_hz == first.set_point.carriage_speed_m_s == 0.0
    assert first.set_point.eccentricity_m == middle.set_point.eccentricity_m
    assert (first.duration_s, first.moving_s, middle.moving_s) == (5.0, 5.0, 14 / 0.8)


def test_an_added_mass_has_zero_runs_of_its_own() -> None:
    mass = KnownMass(5.0)
    dry, known = run(name="a", kind=RunKind.DRY), run(name="b", kind=RunKind.KNOWN_MASS)
    runs = with_zeros([dry, _with(known, mass)], ZeroTable(5.0, 9))
    assert [one.known_mass for one in runs] == [None, None, None, mass, mass, mass]


def _with(one: RunPlan, mass: KnownMass) -> RunPlan:
    return replace(one, known_mass=mass)


@given(st.floats(0.01, 2.0), st.floats(0.0, 5.0), st.floats(0.1, 1.0))
def test_pure_pitch_and_yaw_have_no_angle_of_attack(
    frequency_hz: float, speed_m_s: float, half_m: float
) -> None:
    omega = 2.0 * math.pi * frequency_hz
    for motion in (Motion.PITCH, Motion.YAW, Motion.YAW_DRIFT):
        phi = strut_phase_of(motion, frequency_hz, speed_m_s, half_m)
        # Midpoint's velocity omega e cos(phi/2) less U times the rotation (e/l) sin(phi/2).
        across = omega * half_m * math.cos(phi / 2.0) - speed_m_s * math.sin(phi / 2.0)
        assert abs(across) <= 1e-12 * (omega * half_m + speed_m_s)
    for motion in (Motion.HEAVE, Motion.SWAY):
        assert strut_phase_of(motion, frequency_hz, speed_m_s, half_m) == 0.0


def test_check_weights_go_up_and_down_on_each_gauge() -> None:
    entry = PlanEntry(kind=RunKind.CHECK_WEIGHT, loads_n=(0.0, 50.0, 100.0), repeats=2)
    runs = _made(entry)
    steps = [(one.load.channel, one.load.force_n, one.load.direction) for one in runs if one.load]
    up_down = [(0.0, "up"), (50.0, "up"), (100.0, "up"), (50.0, "down"), (0.0, "down")]
    assert steps == 2 * [(name, *step) for name in CHANNELS for step in up_down]
    assert len({one.name for one in runs}) == 20


def test_in_air_the_speed_tells_the_phase_alone() -> None:
    entry = PlanEntry(
                      RunKind.DRY, Motion.PITCH, "", frequencies_hz=(0.8,), amplitudes_m=(0.02,),
                      speeds_m_s=(1.2,),
                  )  # fmt: skip
    (dry,) = _made(entry)
    assert dry.set_point.carriage_speed_m_s == 0.0
    assert dry.set_point.medium is Medium.AIR
    assert math.tan(dry.set_point.strut_phase_rad / 2.0) == pytest.approx(
        2.0 * math.pi * 0.8 * 0.5 / 1.2
    )


def test_restoring_turns_as_slowly_as_the_oscillator_can() -> None:
    (one,) = _made(PlanEntry(RunKind.RESTORING, Motion.SWAY, amplitudes_m=(0.1,)), HORIZONTAL_1963)
    assert one.set_point.frequency_hz == HORIZONTAL_1963.frequency_hz.low


def test_an_end_by_target_is_between_the_fewest_and_the_most_periods() -> None:
    entry = PlanEntry(
        motion=Motion.HEAVE, frequencies_hz=(1.0,), amplitudes_m=(0.02,), max_periods=40
    )
    (one,) = _made(entry, target_relative=0.01, periods=5)
    assert (one.target_relative, one.periods, one.max_periods) == (0.01, 5, 40)
    assert (one.measured_s, one.moving_s) == (40.0, 44.0)


def test_a_whole_plan_has_all_that_belongs_to_it() -> None:
    heave = PlanEntry(motion=Motion.HEAVE, frequencies_hz=(0.5, 1.0), amplitudes_m=(0.01, 0.02))
    push = PlanEntry(kind=RunKind.PUSH, loads_n=(20.0,))
    tables = PlanTables(
        order=OrderTable(Scheme.SNAKE),
        zero=ZeroTable(5.0, 2),
        control=ControlTable(Motion.HEAVE, 0.8, 0.02, 2),
        runs=(push, heave),
    )
    runs = runs_of(tables, VERTICAL_1963, CHANNELS)
    kinds = Counter(one.kind for one in runs)
    assert kinds == {"push": 2, "oscillation": 4, "control": 3, "zero": 5}
    assert "push at the strut of force_aft" in runs[0].prompts[0]
    assert {one.prompts for one in runs[2:]} == {()}
    steps = [one.set_point.frequency_hz for one in runs if one.kind is RunKind.OSCILLATION]
    assert steps == [0.5, 1.0, 1.0, 0.5]


@pytest.mark.parametrize("motion", [Motion.YAW, Motion.SWAY])
def test_an_exact_run_has_one_frequency_and_the_stated_peak(motion: Motion) -> None:
    entry = PlanEntry(
        motion=motion, exact=True, frequencies_hz=(0.5,), amplitudes_m=(0.2,), speeds_m_s=(1.2,)
    )
    (one,) = _made(entry, HORIZONTAL_1963)
    assert one.set_point.own_orders == ()
    assert one.set_point.eccentricity_m == 0.2
    check_within(HORIZONTAL_1963, one.set_point)  # corrections beyond 2 Hz are no frequencies
    assert bool(one.set_point.lines) is (motion is Motion.YAW)
    assert RunPlan.from_json(one.to_json(), "here") == one


def test_an_exact_run_that_cannot_be_is_refused_by_its_name() -> None:
    entry = PlanEntry(motion=Motion.YAW, exact=True, frequencies_hz=(0.5,), amplitudes_m=(2.0,))
    with pytest.raises(ConfigurationError, match="yaw: exact: an amplitude of 2000 mm"):
        _made(entry, HORIZONTAL_1963)
