"""A run that alone is off is named, and no effect is taken for one."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import pytest

from analysis.gap.components import GapRun, Part
from analysis.gap.fit import Problem
from analysis.gap.odd_run import odd_run
from analysis.gap.priors import Priors
from analysis.gap.where import remaining
from hardware.description.channels import FORCES
from hardware.description.setpoint import SetPoint
from sim.effects.a5_trigger_jitter import TriggerJitter
from sim.effects.catalogue import build
from sim.rig import SimulatedRig
from tests.analysis.gap import small
from tests.analysis.gap.small import POINTS, record

HARMONIC = (Part.MEAN, Part.IN_PHASE, Part.QUADRATURE)
WET, AIR = 1, 5  # of the runs of a small campaign


def problem_of(rig: SimulatedRig, runs: Sequence[GapRun]) -> Problem:
    """Return the problem of a diagnosis, the pulses' usual scatter on as there."""
    found = small.problem_of(rig, runs)
    on = (TriggerJitter(Priors().pulse_scatter_rad),)
    return replace(found, simulator=replace(found.simulator, on=on))


def with_gain(run: GapRun) -> GapRun:
    seen = run.observed
    own = [one.channel in FORCES and one.part in HARMONIC for one in seen.components]
    return replace(run, observed=replace(seen, values=np.where(own, 1.15, 1.0) * seen.values))


def with_zero(run: GapRun) -> GapRun:
    seen = run.observed
    own = [one.channel == FORCES[0] and one.part is Part.MEAN for one in seen.components]
    return replace(run, observed=replace(seen, values=np.where(own, 5.0, 0.0) + seen.values))


def changed(
    runs: Sequence[GapRun], change: Callable[[GapRun], GapRun], *which: int
) -> list[GapRun]:
    return [change(run) if number in which else run for number, run in enumerate(runs)]


@pytest.mark.parametrize(
    ("change", "at"), [(with_gain, 0), (with_gain, WET), (with_zero, 0), (with_zero, 3)]
)
def test_one_run_off_is_named(
    rig: SimulatedRig, clean: tuple[GapRun, ...], change: Callable[[GapRun], GapRun], at: int
) -> None:
    problem = problem_of(rig, changed(clean, change, at))
    found = odd_run(problem)
    assert found is not None
    assert found.name == f"r{at}"
    # Fitted to all runs, the free numbers leave less of the one that is off.
    own = problem.simulator.stack.run == at
    with_it = remaining(problem, problem.residual)[own]
    assert found.rms >= np.sqrt(np.mean(with_it**2))


def test_a_clean_campaign_has_none(rig: SimulatedRig, clean: tuple[GapRun, ...]) -> None:
    assert odd_run(problem_of(rig, clean)) is None


@pytest.mark.parametrize("name", ["coulomb-friction", "gauge-compliance", "quadratic-damping"])
def test_an_effect_in_all_runs_is_no_odd_run(rig: SimulatedRig, name: str) -> None:
    assert odd_run(problem_of(rig, record(rig, [build(name)], seed=2))) is None


@pytest.mark.parametrize("name", ["coulomb-friction", "quadratic-damping"])
@pytest.mark.parametrize("share", [0.003, 0.01, 0.03, 0.1])
def test_an_effect_at_the_edge_of_the_noise_is_no_odd_run(
    rig: SimulatedRig, name: str, share: float
) -> None:
    whole = build(name)
    weak = replace(whole, **{key: share * value for key, value in vars(whole).items()})
    found = [odd_run(problem_of(rig, record(rig, [weak], seed=seed))) for seed in (3, 4, 5)]
    assert sum(one is not None for one in found) <= 1  # noise may stand in one run's place


def test_two_runs_off_are_not_one(rig: SimulatedRig, clean: tuple[GapRun, ...]) -> None:
    assert odd_run(problem_of(rig, changed(clean, with_gain, 0, 3))) is None


def test_one_of_two_runs_that_a_coefficient_rests_on_is_not_told_from_the_other(
    rig: SimulatedRig, clean: tuple[GapRun, ...]
) -> None:
    """Two runs in pitch: whichever is taken out, the free coefficients take up the other."""
    assert odd_run(problem_of(rig, changed(clean, with_gain, 3))) is None


def test_the_only_run_of_its_kind_may_show_an_effect(
    rig: SimulatedRig, clean: tuple[GapRun, ...]
) -> None:
    assert odd_run(problem_of(rig, changed(clean, with_gain, AIR))) is None
    assert odd_run(problem_of(rig, changed(clean, with_zero, AIR))) is None


def test_one_of_two_runs_of_a_kind_is_named(rig: SimulatedRig) -> None:
    air = SetPoint(0.5, 0.02, 0.0, 0.0, POINTS[AIR].medium)
    runs = record(rig, (), seed=4, points=(*POINTS, air))
    found = odd_run(problem_of(rig, changed(runs, with_zero, AIR)))
    assert found is not None
    assert found.name == f"r{AIR}"
