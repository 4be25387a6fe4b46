"""A law that is put into the forces is described as what it is."""

import numpy as np
import pytest

from analysis.gap.forward.problem import Problem
from analysis.gap.judge.description import describe
from analysis.gap.judge.sparse_law import LIBRARY
from analysis.gap.judge.withheld import gap_of, predict_withheld
from analysis.gap.observe.components import GapRun
from analysis.gap.observe.regimes import regimes
from analysis.gap.search.polynomial import components_of, polynomial, scaled_motion
from sim.rig import SimulatedRig
from tests.analysis.gap.small import problem_of


@pytest.fixture(scope="module")
def problem(rig: SimulatedRig, clean: tuple[GapRun, ...]) -> Problem:
    return problem_of(rig, clean)


def put_in(problem: Problem, terms: dict[str, float], channel: str = "force_aft") -> np.ndarray:
    """Return a whitened residual that is nothing but a law of one strut's force."""
    stack = problem.simulator.stack
    moved = scaled_motion(stack, channel)
    forces = [sum(weight * LIBRARY[name](one) for name, weight in terms.items()) for one in moved]
    return components_of(stack, channel, forces) / stack.uncertainty


@pytest.mark.parametrize("name", ["sign v", "v|v|", "v³", "x³", "x²"])
def test_one_term_is_found_with_its_weight(problem: Problem, name: str) -> None:
    found = describe(problem, put_in(problem, {name: 2.0}))
    assert found is not None
    assert found.law.terms[0][:2] == ("force_aft", name)
    assert found.law.terms[0][2] == pytest.approx(2.0, rel=1e-6)
    assert found.law.explained == pytest.approx(1.0)


@pytest.mark.parametrize(("name", "power"), [("sign v", 0.0), ("v|v|", 2.0), ("v³", 3.0)])
def test_powers_of_frequency_and_amplitude(problem: Problem, name: str, power: float) -> None:
    found = describe(problem, put_in(problem, {name: 5.0}))
    assert found is not None
    # A sign is rounded off near standstill, over a width that does not shrink with the velocity.
    assert found.frequency_power == pytest.approx(power, abs=0.1)
    assert found.amplitude_power == pytest.approx(power, abs=0.1)
    assert found.follows["velocity"] > 2.0 * found.follows["displacement"]


def test_what_does_not_ask_for_water_is_as_large_in_air(problem: Problem) -> None:
    found = describe(problem, put_in(problem, {"sign v": 2.0}))
    assert found is not None
    assert found.air_over_water == pytest.approx(1.0, abs=0.05)


@pytest.mark.slow
def test_noise_is_not_described(problem: Problem) -> None:
    noise = np.random.default_rng(7).standard_normal(len(problem.residual))
    assert describe(problem, noise) is None


@pytest.mark.slow
def test_the_polynomial_control_predicts_a_polynomial_and_no_sign(problem: Problem) -> None:
    stack = problem.simulator.stack
    every = regimes(stack.runs)
    gaps = {}
    for name in ("v³", "sign v"):
        whole = put_in(problem, {name: 3.0}) * stack.uncertainty
        told = _with_values(problem, problem.simulator.nominal + whole)
        before, after = (
            gap_of(np.concatenate([one.remainder for one in predict_withheld(told, fit, every)]))
            for fit in (None, polynomial(told))
        )
        gaps[name] = after / before
    assert gaps["v³"] < 0.1
    assert gaps["sign v"] > 0.3


def _with_values(problem: Problem, values: np.ndarray) -> Problem:
    from dataclasses import replace

    simulator = problem.simulator
    moved = replace(simulator, stack=replace(simulator.stack, values=values))
    return replace(problem, simulator=moved)
