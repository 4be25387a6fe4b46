"""Faults of recordings, put in one by one, are found, and nothing else is."""

import math
import re
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from analysis.gap.forward.tolerances import Tolerances
from analysis.gap.observe.components import GapRun, Part
from analysis.gap.observe.plateau import Plateau
from analysis.gap.quality.finding import Doubt
from analysis.gap.quality.recordings import doubts, judge_recordings
from sim.effects.catalogue import build
from sim.effects.measurement import with_force_channels
from sim.rig import SimulatedRig
from tests.analysis.gap.small import POINTS, record

PARTS = (Part.IN_PHASE, Part.QUADRATURE)


def scaled(run: GapRun, channel: str, factor: float) -> GapRun:
    seen = run.observed
    own = np.array([one.channel == channel and one.part in (Part.MEAN, Part.IN_PHASE,
                    Part.QUADRATURE) for one in seen.components])  # fmt: skip
    values = np.where(own, factor * seen.values, seen.values)
    uncertainty = np.where(own, abs(factor) * seen.uncertainty, seen.uncertainty)
    return replace(run, observed=replace(seen, values=values, uncertainty=uncertainty))


def changed(
    runs: tuple[GapRun, ...], at: int, change: Callable[[GapRun], GapRun]
) -> tuple[GapRun, ...]:
    return tuple(change(run) if number == at else run for number, run in enumerate(runs))


def test_nothing_is_wrong_with_a_clean_campaign(
    rig: SimulatedRig, clean: tuple[GapRun, ...]
) -> None:
    there, found = judge_recordings(rig, clean, Tolerances())
    assert found == ()
    assert there.rig is rig


@pytest.mark.parametrize("name", ["coulomb-friction", "gauge-compliance"])
def test_an_effect_is_no_fault(rig: SimulatedRig, name: str) -> None:
    assert doubts(rig, record(rig, [build(name)], seed=2)) == ()


@pytest.mark.parametrize(
    ("factor", "said"),
    [
        (1000.0, "mN in place of N"),
        (1.0 / 9.80665, "kgf in place of N"),
        (4.4482, "N in place of lbf"),
        (-1.0, "sign is the opposite"),
        (2.5, "2.5 times as large"),
    ],
)
@pytest.mark.parametrize("at", [0, 4])
def test_one_file_in_other_units(
    rig: SimulatedRig, clean: tuple[GapRun, ...], factor: float, said: str, at: int
) -> None:
    found = doubts(rig, changed(clean, at, lambda run: scaled(run, "force_aft", factor)))
    assert [(one.run, one.channel) for one in found] == [(f"r{at}", "force_aft")]
    assert said in found[0].reason


def test_all_files_in_other_units(rig: SimulatedRig, clean: tuple[GapRun, ...]) -> None:
    runs = tuple(scaled(run, "force_fore", 1.0 / 9.80665) for run in clean)
    (found,) = doubts(rig, runs)
    assert found == Doubt("", "force_fore", found.reason)
    assert "kgf" in found.reason
    assert "in all runs" in found.reason


@pytest.mark.parametrize("channel", ["force_aft", "displacement_fore"])
def test_all_files_with_the_wrong_sign(
    rig: SimulatedRig, clean: tuple[GapRun, ...], channel: str
) -> None:
    (found,) = doubts(rig, [scaled(run, channel, -1.0) for run in clean])
    assert (found.run, found.channel) == ("", channel)
    assert "sign is the opposite of what is simulated, in all runs" in found.reason


def clipped(run: GapRun, channel: str) -> GapRun:
    seen = run.observed
    return replace(
        run, observed=replace(seen, plateaus={**seen.plateaus, channel: Plateau(0.12, (80.0,))})
    )


@pytest.mark.parametrize("channel", ["force_aft", "displacement_fore"])
def test_what_is_clipped_in_few_runs_is_left_out_and_in_most_is_a_cause(
    rig: SimulatedRig, clean: tuple[GapRun, ...], channel: str
) -> None:
    few = doubts(rig, [clipped(run, channel) for run in clean[:2]] + list(clean[2:]))
    assert [(one.run, one.channel) for one in few] == [("r0", channel), ("r1", channel)]
    unit = "N" if "force" in channel else "m"
    assert few[0].reason == f"clipped: 12 % of its samples stand at 80 {unit}"
    assert doubts(rig, [clipped(run, channel) for run in clean[:3]] + list(clean[3:])) == ()


def with_range(rig: SimulatedRig, range_n: float) -> SimulatedRig:
    return with_force_channels(
        rig, lambda one, at: one if at else replace(one, full_scale=range_n, resolution=0.01)
    )


def test_an_amplifier_in_a_smaller_range(rig: SimulatedRig, clean: tuple[GapRun, ...]) -> None:
    """In one run it is found beside what it does to the harmonics, in all it is the rig's."""
    size = math.hypot(*(clean[1].observed.value("force_aft", part, 1) for part in PARTS))
    short = with_range(rig, 0.8 * size)
    one = record(short, (), 1, POINTS[1:2])[0]
    runs = changed(clean, 1, lambda _: replace(one, name="r1"))
    (found,) = doubts(rig, runs)
    share = 2.0 * math.acos(0.8) / math.pi
    assert (found.run, found.channel) == ("r1", "force_aft")
    said = re.fullmatch(r"clipped: (.*) % of its samples stand at (.*) N and (.*) N", found.reason)
    assert said is not None
    assert [float(one) for one in said.groups()] == pytest.approx(
        [100.0 * share, 0.8 * size, -0.8 * size], rel=0.1
    )
    every = record(with_range(rig, 4.0), (), 1)
    clipped = [run.observed.plateaus["force_aft"].share > 0.0 for run in every]
    assert sum(clipped) >= len(every) / 2
    assert not [one for one in doubts(rig, every) if "clipped" in one.reason]


def turning(run: GapRun, factor: float) -> GapRun:
    turns = factor * run.observed.turns_per_period
    return replace(run, observed=replace(run.observed, turns_per_period=turns))


@pytest.mark.parametrize(
    ("factor", "said"),
    [
        (180.0 / math.pi, "it goes on by 360 each period, where a turn is 6.283 rad: deg in"),
        (0.5 / math.pi, "it goes on by 1 each period, where a turn is 6.283 rad: rev in place of"),
        (-1.0, "it goes on by -6.283 each period, where a turn is 6.283 rad: its sign?"),
        (10.0, "a gear between?"),
        (0.0, "it does not move"),
    ],
)
def test_shaft_angle_in_other_units(
    rig: SimulatedRig, clean: tuple[GapRun, ...], factor: float, said: str
) -> None:
    one = doubts(rig, changed(clean, 3, lambda run: turning(run, factor)))
    every = doubts(rig, [turning(run, factor) for run in clean])
    assert [(found.run, found.channel) for found in one] == [("r3", "shaft_angle")]
    assert [(found.run, found.channel) for found in every] == [("", "shaft_angle")]
    assert one[0].reason.startswith(said) or said in one[0].reason
    assert said in every[0].reason


def noise_alone(run: GapRun, channel: str) -> GapRun:
    """Leave of a channel two standard deviations, as of a sensor that is not connected."""
    seen = run.observed
    own = np.array([one.channel == channel for one in seen.components])
    values = np.where(own, 2.0 * seen.uncertainty, seen.values)
    return replace(run, observed=replace(seen, values=values))


@pytest.mark.parametrize("channel", ["force_aft", "displacement_fore"])
@pytest.mark.parametrize("dead", [lambda run, name: scaled(run, name, 1e-13), noise_alone])
def test_a_channel_that_stands_still(
    rig: SimulatedRig,
    clean: tuple[GapRun, ...],
    channel: str,
    dead: Callable[[GapRun, str], GapRun],
) -> None:
    found = doubts(rig, changed(clean, 0, lambda run: dead(run, channel)))
    assert [(one.run, one.reason) for one in found] == [("r0", "it does not move")]
    every = doubts(rig, [dead(run, channel) for run in clean])
    assert [(one.run, one.channel) for one in every] == [("", channel)]
    assert "it does not move in most runs" in every[0].reason


@pytest.mark.parametrize(
    ("factor", "said"),
    [
        (1000.0, "mm/s in place of m/s"),
        (3.6, "km/h in place of m/s"),
        (1.94, "knot in place of m/s"),
        (-1.0, "its sign"),
    ],
)
def test_carriage_speed_in_other_units(
    rig: SimulatedRig, clean: tuple[GapRun, ...], factor: float, said: str
) -> None:
    one = doubts(rig, changed(clean, 2, lambda run: scaled(run, "carriage_speed", factor)))
    every = doubts(rig, [scaled(run, "carriage_speed", factor) for run in clean])
    assert [(found.run, found.channel) for found in one] == [("r2", "carriage_speed")]
    assert [(found.run, found.channel) for found in every] == [("", "carriage_speed")]
    assert said in one[0].reason
    assert said in every[0].reason


def test_a_carriage_that_is_five_per_cent_off_is_no_fault_of_a_file(
    rig: SimulatedRig, clean: tuple[GapRun, ...]
) -> None:
    assert doubts(rig, [scaled(run, "carriage_speed", 1.05) for run in clean]) == ()


def test_a_run_at_another_frequency(rig: SimulatedRig, clean: tuple[GapRun, ...]) -> None:
    told = replace(clean[1].set_point, frequency_hz=1.1)
    run = record(rig, (), 3, [clean[1].set_point])[0]
    at = next(i for i, one in enumerate(run.observed.components) if one.part is Part.FREQUENCY)
    values = run.observed.values.copy()
    values[at] = math.log(1.0 / 1.1)
    wrong = replace(run, name="r1", set_point=told, observed=replace(run.observed, values=values))
    found = doubts(rig, changed(clean, 1, lambda _: wrong))
    assert "made at 1 Hz, not at the 1.1 Hz" in {one.run: one for one in found}["r1"].reason


def test_a_model_that_is_far_off_is_no_fault_of_the_files(
    rig: SimulatedRig, clean: tuple[GapRun, ...]
) -> None:
    (a11, a12), (a21, a22) = rig.water.added_mass
    off = replace(rig, water=replace(rig.water, added_mass=((0.4 * a11, a12), (a21, 1.6 * a22))))
    there, found = judge_recordings(off, clean, Tolerances())
    assert found == ()
    assert there.moved["a11"] == pytest.approx(0.6 * a11, rel=0.15)
    assert there.moved["a22"] == pytest.approx(-0.6 * a22, rel=0.15)
