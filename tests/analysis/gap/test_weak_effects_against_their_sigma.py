"""An effect of some sigma is named, however large the catalogue takes it to be usually."""

import numpy as np
import pytest

from analysis.gap.forward.problem import Problem
from analysis.gap.inference.answers import NONE
from analysis.gap.inference.gaussian import left_over
from analysis.gap.judge.diagnosis import Settings, diagnose
from analysis.gap.observe.components import GapRun
from sim.effects.catalogue import build, find
from sim.effects.effect import Effect
from sim.rig import SimulatedRig
from tests.analysis.gap.small import problem_of, record

SIGMA = 7.0
SEEDS = (41, 42, 43)
KNOWN = ("coulomb-friction", "speed-ripple", "zero-offset", "amplifier-lag", "quadratic-damping")
# Each is put in far smaller than the catalogue takes it to be usually.
WEAK = (
    "coulomb-friction:friction_n={}",
    "speed-ripple:relative={}",
    "zero-offset:aft_n={},fore_n=0",
)


@pytest.fixture(scope="module")
def problem(rig: SimulatedRig, clean: tuple[GapRun, ...]) -> Problem:
    return problem_of(rig, clean)


def sized(problem: Problem, said: str) -> Effect:
    """Return the effect at the size at which it is as many sigma as wanted, by bisection."""
    low, high = -9.0, 0.0
    for _ in range(24):
        middle = 0.5 * (low + high)
        change = problem.simulator.predict((build(said.format(10.0**middle)),))
        size = left_over(problem.whitened(change - problem.simulator.nominal), problem.nuisances)
        low, high = (middle, high) if size < SIGMA else (low, middle)
    return build(said.format(10.0**low))


@pytest.mark.slow
@pytest.mark.parametrize(("said", "seed"), list(zip(WEAK, SEEDS, strict=True)))
def test_it_is_named(said: str, seed: int, rig: SimulatedRig, problem: Problem) -> None:
    there = sized(problem, said)
    known = {name: find(name) for name in KNOWN}
    found = diagnose(rig, record(rig, [there], seed), Settings(known))
    # At 7 sigma beside noise of 1 it is above 4.5 but six times in a thousand.
    assert found.answers.best == there.name


@pytest.mark.slow
def test_a_third_of_it_is_not(rig: SimulatedRig, problem: Problem) -> None:
    """At 2.3 sigma nothing can be told from chance: whoever names it there names noise."""
    whole = sized(problem, WEAK[0])
    friction = build(f"coulomb-friction:friction_n={whole.friction_n / 3.0}")
    known = {name: find(name) for name in KNOWN}
    found = [diagnose(rig, record(rig, [friction], seed), Settings(known)) for seed in SEEDS]
    assert NONE in [one.answers.best for one in found]
    assert np.mean([one.answers.by_answer[NONE] for one in found]) > 0.2
