"""What is put into simulated campaigns is what the diagnosis says, and nothing where nothing is."""

from collections.abc import Sequence
from dataclasses import asdict, replace

import numpy as np
import pytest

from analysis.gap.design.forecast import forecast, planned, with_further_runs
from analysis.gap.forward.free_numbers import free_numbers
from analysis.gap.forward.tolerances import Tolerances
from analysis.gap.inference.answers import NONE, UNKNOWN
from analysis.gap.judge.diagnosis import Diagnosis, Settings, diagnose
from analysis.gap.judge.verdict import coefficient_twins
from analysis.gap.observe.components import STEADY_PARTS
from analysis.gap.observe.sensors import as_recorded
from analysis.resolver.reference_choice import ReferenceChoice
from hardware.description.channels import SHAFT_ANGLE
from hardware.description.setpoint import SetPoint
from pmm.gap.answer import effect_rows
from sim.acquisition.channels import Digitiser
from sim.effects.catalogue import build, find
from sim.rig import SimulatedRig
from tests.analysis.gap.small import POINTS, one_run, record

FEW = ("coulomb-friction", "amplifier-lag")


def diagnosed(
    rig: SimulatedRig, effects: Sequence[str], seed: int, known: Sequence[str] = FEW
) -> Diagnosis:
    runs = record(rig, [build(one) for one in effects], seed)
    return diagnose(rig, runs, Settings({name: find(name) for name in known}))


@pytest.mark.slow
@pytest.mark.parametrize("seed", [11, 12, 13])
def test_a_campaign_without_an_effect_has_no_gap(rig: SimulatedRig, seed: int) -> None:
    found = diagnosed(rig, (), seed)
    assert found.answers.best == NONE
    assert found.best is None
    assert sum(found.answers.by_answer.values()) == pytest.approx(1.0)
    assert not any(one.is_beyond_noise for one in found.walk.steps)


@pytest.mark.slow
def test_an_encoder_tells_the_phase_without_scatter(rig: SimulatedRig) -> None:
    """Forces that scatter less from cycle to cycle than a photocell's pulses would let them."""
    quiet = Digitiser(noise_rms=1e-4)
    sensors = replace(rig.acquisition, shaft_angle=Digitiser(), force_aft=quiet, force_fore=quiet)
    real = replace(rig, photocell=None, acquisition=sensors)
    told = ReferenceChoice(channel=SHAFT_ANGLE.name)
    runs = [one_run(real, (), 15, k, point, told) for k, point in enumerate(POINTS)]
    believed = as_recorded(real, runs, None)
    found = diagnose(believed, runs, Settings({name: find(name) for name in FEW}))
    assert found.answers.best == NONE


@pytest.mark.slow
def test_a_restoring_that_is_stated_wrong_is_said_beside_what_it_passes_for(
    rig: SimulatedRig,
) -> None:
    """At one speed a trim with the carriage is a stiffness, and a stiffness a trim."""
    (c11, c12), second = rig.water.restoring
    stated = replace(rig, water=replace(rig.water, restoring=((1.25 * c11, c12), second)))
    runs = [run for run in record(rig, (), 14) if run.set_point.carriage_speed_m_s]
    found = diagnose(stated, runs, Settings({"dynamic-trim": find("dynamic-trim")}))
    assert found.answers.best == "dynamic-trim"
    assert found.cause is not None
    twins = coefficient_twins(found.problem, found.cause, free_numbers(stated, Tolerances()))
    assert twins["c11"][0] == pytest.approx(-0.25 * c11, rel=0.05)


@pytest.fixture(scope="module")
def friction(rig: SimulatedRig) -> Diagnosis:
    return diagnosed(rig, ("coulomb-friction:friction_n=0.3",), 21)


@pytest.mark.slow
def test_friction_is_named_with_its_stage_and_size(friction: Diagnosis) -> None:
    _holds(friction, "coulomb-friction:friction_n=0.3")
    assert max(friction.stages, key=lambda name: friction.stages[name]) == "structure"
    beyond = {one.step for one in friction.walk.steps if one.is_beyond_noise}
    assert "forces" in beyond
    assert "strut motion" not in beyond


@pytest.mark.slow
def test_no_coefficient_passes_for_friction(friction: Diagnosis, rig: SimulatedRig) -> None:
    assert friction.cause is not None
    assert not coefficient_twins(friction.problem, friction.cause, free_numbers(rig, Tolerances()))


@pytest.mark.slow
def test_the_gap_goes_away_where_friction_is_added(friction: Diagnosis) -> None:
    assert friction.shrinkage is not None
    assert friction.shrinkage.before > 5.0
    assert friction.shrinkage.after < 1.0
    assert friction.shrinkage.share > 0.9


@pytest.mark.slow
def test_a_run_that_was_not_made_is_foretold(friction: Diagnosis, rig: SimulatedRig) -> None:
    tolerances, problem = Tolerances(), friction.problem
    point = SetPoint(0.75, 0.03, 0.0, 1.0)
    there = with_further_runs(
        problem, [planned(problem, point, 0)], free_numbers(rig, tolerances), tolerances
    )
    assert friction.best is not None
    told = forecast(problem, there, friction.best)
    plain = forecast(problem, there, None)
    really = there.simulator.steady([build("coulomb-friction:friction_n=0.3")])
    steady = np.array([one.part in STEADY_PARTS for one in there.simulator.stack.components])
    assert steady.all()
    off = (really - there.simulator.nominal) / there.simulator.stack.uncertainty - told.mean
    without = (really - there.simulator.nominal) / there.simulator.stack.uncertainty - plain.mean
    spread = np.sqrt(np.diagonal(told.covariance(np.ones(len(told.mean), dtype=bool))))
    assert np.abs(off / spread).max() < 3.0
    assert np.linalg.norm(off) < 0.2 * np.linalg.norm(without)


@pytest.mark.slow
@pytest.mark.parametrize("said", ["quadratic-damping", "amplifier-lag"])
def test_other_effects_are_named_with_their_parameters(rig: SimulatedRig, said: str) -> None:
    _holds(diagnosed(rig, (said,), 22, (said, "coulomb-friction")), said)


@pytest.mark.slow
def test_two_at_once_are_both_named(rig: SimulatedRig) -> None:
    put_in = ("coulomb-friction:friction_n=0.3", "cross-talk:aft=0.03,fore=0.02")
    found = diagnosed(rig, put_in, 23, ("coulomb-friction", "cross-talk"))
    assert found.answers.best == "coulomb-friction+cross-talk"
    _holds(found, put_in[0])


@pytest.mark.slow
def test_an_effect_that_is_taken_out_of_the_catalogue_is_unknown(rig: SimulatedRig) -> None:
    found = diagnosed(rig, ("coulomb-friction:friction_n=0.3",), 24, ("amplifier-lag",))
    assert found.answers.best == UNKNOWN


def _holds(found: Diagnosis, said: str) -> None:
    """Hold the named effect's intervals against what was put in, a quarter wider than 95 %."""
    put_in = build(said)
    assert found.best is not None
    assert put_in.name in found.answers.best.split("+")
    (row,) = [one for one in effect_rows(found.best) if one["name"] == put_in.name]
    for key, told in row["parameters"].items():
        value = asdict(put_in)[key]
        wider = 0.25 * (told["high"] - told["low"])
        assert told["low"] - wider <= value <= told["high"] + wider, (key, told)
