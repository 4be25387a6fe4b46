"""A run that alone is off is named, and no effect is taken for one."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import pytest

from analysis.gap.inference.answers import COEFFICIENTS, NONE, ODD_RUN
from analysis.gap.judge.diagnosis import Diagnosis, Settings, diagnose
from analysis.gap.observe.components import GapRun, Part
from hardware.description.channels import FORCES
from hardware.description.setpoint import SetPoint
from sim.effects.catalogue import build, find
from sim.rig import SimulatedRig
from tests.analysis.gap.small import POINTS, record

HARMONIC = (Part.MEAN, Part.IN_PHASE, Part.QUADRATURE)
WET, AIR = 1, 5  # of the runs of a small campaign
FEW = ("coulomb-friction", "quadratic-damping", "gauge-compliance")
Change = Callable[[GapRun], GapRun]


def with_gain(run: GapRun) -> GapRun:
    seen = run.observed
    own = [one.channel in FORCES and one.part in HARMONIC for one in seen.components]
    return replace(run, observed=replace(seen, values=np.where(own, 1.15, 1.0) * seen.values))


def with_zero(run: GapRun) -> GapRun:
    seen = run.observed
    own = [one.channel == FORCES[0] and one.part is Part.MEAN for one in seen.components]
    return replace(run, observed=replace(seen, values=np.where(own, 5.0, 0.0) + seen.values))


def changed(runs: Sequence[GapRun], change: Change, *which: int) -> list[GapRun]:
    return [change(run) if number in which else run for number, run in enumerate(runs)]


def diagnosed(rig: SimulatedRig, runs: Sequence[GapRun]) -> Diagnosis:
    return diagnose(rig, runs, Settings({name: find(name) for name in FEW}))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("change", "at"), [(with_gain, 0), (with_gain, WET), (with_zero, 0), (with_zero, 3)]
)
def test_one_run_off_is_named(
    rig: SimulatedRig, clean: tuple[GapRun, ...], change: Change, at: int
) -> None:
    found = diagnosed(rig, changed(clean, change, at)).answers
    assert found.best == ODD_RUN
    assert found.odd_runs[f"r{at}"] > 0.5


@pytest.mark.slow
def test_a_clean_campaign_has_none(rig: SimulatedRig, clean: tuple[GapRun, ...]) -> None:
    found = diagnosed(rig, clean).answers
    assert found.best == NONE
    assert max(found.odd_runs.values()) < 0.1


@pytest.mark.slow
@pytest.mark.parametrize("name", FEW)
def test_an_effect_in_all_runs_is_no_odd_run(rig: SimulatedRig, name: str) -> None:
    found = diagnosed(rig, record(rig, [build(name)], seed=2)).answers
    assert found.best == name
    assert max(found.odd_runs.values()) < 0.1


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "share"),
    [
        ("quadratic-damping", 0.003),
        ("coulomb-friction", 0.01),
        ("quadratic-damping", 0.03),
        ("coulomb-friction", 0.1),
    ],
)
def test_an_effect_at_the_edge_of_the_noise_is_no_odd_run(
    rig: SimulatedRig, name: str, share: float
) -> None:
    whole = build(name)
    sizes = [one.name for one in whole.parameters() if not one.forms]
    weak = replace(whole, **{key: share * getattr(whole, key) for key in sizes})
    found = diagnosed(rig, record(rig, [weak], seed=3)).answers
    assert found.by_answer[ODD_RUN] < 0.5


@pytest.mark.slow
def test_of_two_runs_off_one_after_the_other_is_named(
    rig: SimulatedRig, clean: tuple[GapRun, ...]
) -> None:
    off, left = ["r0", "r4"], changed(clean, with_zero, 0, 4)
    while off:
        odd = diagnosed(rig, left).answers.odd_runs
        worst = max(odd, key=lambda name: odd[name])
        off.remove(worst)
        left = [run for run in left if run.name != worst]
    assert max(diagnosed(rig, left).answers.odd_runs.values()) < 0.5


@pytest.mark.slow
@pytest.mark.parametrize("change", [with_gain, with_zero])
def test_an_odd_run_beside_an_effect_leaves_the_effect_named(
    rig: SimulatedRig, change: Change
) -> None:
    runs = record(rig, [build("coulomb-friction:friction_n=0.3")], seed=2)
    found = diagnosed(rig, changed(runs, change, WET)).answers
    assert found.best == "coulomb-friction"
    assert found.odd_runs[f"r{WET}"] > 0.5


@pytest.mark.slow
def test_one_of_two_runs_of_a_kind_is_named(rig: SimulatedRig) -> None:
    air = SetPoint(0.5, 0.02, 0.0, 0.0, POINTS[AIR].medium)
    runs = record(rig, (), seed=4, points=(*POINTS, air))
    found = diagnosed(rig, changed(runs, with_zero, AIR)).answers
    assert found.odd_runs[f"r{AIR}"] > 0.5


@pytest.mark.slow
def test_of_two_runs_that_a_coefficient_rests_on_neither_is_sure(
    rig: SimulatedRig, clean: tuple[GapRun, ...]
) -> None:
    """Two runs in pitch: a gain that is off in one of them is as well one of the other, or less."""
    found = diagnosed(rig, changed(clean, with_gain, 3)).answers
    assert found.best in (ODD_RUN, COEFFICIENTS)
