"""Probabilities effect by effect and class by class: against what must hold of sums."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.gap.inference.answers import (
    COEFFICIENTS,
    NAMELESS,
    NONE,
    UNKNOWN,
    by_effect,
    of_any,
)
from analysis.gap.judge.diagnosis import Diagnosis, Settings, diagnose
from analysis.gap.judge.marginal import LEAST, Marginal, marginals
from analysis.gap.judge.verdict import ALIKE
from sim.effects.catalogue import build, find
from sim.rig import SimulatedRig
from tests.analysis.gap.small import record

EFFECTS = ("a", "b", "c", "d")
ANSWERS = (NONE, COEFFICIENTS, UNKNOWN, *EFFECTS,
           *(f"{one}+{other}" for one in EFFECTS for other in EFFECTS if one < other))  # fmt: skip
KNOWN = ("coulomb-friction", "cable", "strut-phase-error")


@st.composite
def shares(draw: st.DrawFn) -> dict[str, float]:
    """Arbitrary probabilities over arbitrary answers, which sum to 1."""
    names = draw(st.lists(st.sampled_from(ANSWERS), min_size=1, unique=True))
    weights = [draw(st.floats(0.0, 1.0)) for _ in names]
    whole = sum(weights)
    return {name: one / whole for name, one in zip(names, weights, strict=True) if whole > 1e-9}


def test_a_pair_counts_for_both_of_its_effects() -> None:
    told = {NONE: 0.1, UNKNOWN: 0.1, COEFFICIENTS: 0.1, "a": 0.4, "a+b": 0.25, "b+c": 0.05}
    assert by_effect(told) == pytest.approx({"a": 0.65, "b": 0.3, "c": 0.05})
    assert list(by_effect(told)) == ["a", "b", "c"]
    assert of_any(told, ["a", "b"]) == pytest.approx(0.7)  # the pair of both counts once


@given(shares())
def test_effects_sum_to_the_names_with_pairs_twice(told: dict[str, float]) -> None:
    found = by_effect(told)
    assert all(0.0 <= one <= 1.0 for one in found.values())
    counted = {name: len(name.split("+")) for name in told} | {NONE: 0, UNKNOWN: 0, COEFFICIENTS: 0}
    whole = sum(counted[name] * share for name, share in told.items())
    assert sum(found.values()) == pytest.approx(whole)


@given(shares(), st.sets(st.sampled_from(EFFECTS)))
def test_a_class_is_no_less_than_its_members_and_no_more_than_their_sum(
    told: dict[str, float], members: set[str]
) -> None:
    alone = [by_effect(told).get(name, 0.0) for name in members]
    whole = of_any(told, sorted(members))
    assert max(alone, default=0.0) <= whole + 1e-12
    assert whole <= min(sum(alone), 1.0) + 1e-12
    named = 1.0 - sum(told.get(one, 0.0) for one in NAMELESS) if told else 0.0
    assert of_any(told, EFFECTS) == pytest.approx(named, abs=1e-9)


@pytest.fixture(scope="module")
def friction(rig: SimulatedRig) -> Diagnosis:
    runs = record(rig, [build("coulomb-friction:friction_n=0.3,presliding_m=1e-4")], 91)
    return diagnose(rig, runs, Settings({name: find(name) for name in KNOWN}))


@pytest.fixture
def alike(friction: Diagnosis) -> dict[str, Marginal]:
    """The effects where all answers are as probable, so that none is out of the question."""
    names = friction.answers.by_answer
    even = replace(friction.answers, by_answer=dict.fromkeys(names, 1.0 / len(names)))
    weighed = replace(friction.weighed, answers=even)
    return {one.name: one for one in marginals(replace(friction, weighed=weighed))}


@pytest.mark.slow
def test_friction_passes_for_the_cable_and_both_count(friction: Diagnosis) -> None:
    first = marginals(friction)[0]
    assert first.name == "coulomb-friction"
    assert first.stage == "structure"
    told = friction.answers.by_answer
    assert first.probability == pytest.approx(by_effect(told)[first.name])
    assert "cable" in first.alike
    assert first.alike == dict(friction.classes[first.name])
    assert first.class_probability == of_any(told, [first.name, *first.alike])


@pytest.mark.slow
def test_none_is_out_of_the_question(friction: Diagnosis, alike: dict[str, Marginal]) -> None:
    every = marginals(friction)
    assert all(one.probability > LEAST for one in every)
    assert [one.probability for one in every] == sorted(
        (one.probability for one in every), reverse=True
    )
    assert set(alike) == set(by_effect(friction.answers.by_answer))


@pytest.mark.slow
def test_what_is_smaller_than_the_noise_has_no_class(alike: dict[str, Marginal]) -> None:
    """Any effect would pass for it: here of a phase that nobody put in, beside friction."""
    slight = alike.pop("strut-phase-error")
    assert slight.size_sigma < ALIKE
    assert math.isnan(slight.class_probability)
    assert not slight.alike
    for one in alike.values():
        assert one.size_sigma > ALIKE
        assert one.class_probability >= one.probability
        assert all(left < ALIKE for left in one.alike.values())


@pytest.mark.slow
def test_a_size_is_what_least_squares_leave(friction: Diagnosis) -> None:
    """Of friction alone: the nuisances, held by their priors, take what they can."""
    assert friction.best is not None
    assert friction.best.names == ("coulomb-friction",)
    columns, signature = friction.problem.nuisances.columns, friction.best.signature
    held = np.vstack((columns, np.eye(columns.shape[1])))
    target = np.concatenate((signature, np.zeros(columns.shape[1])))
    left = target - held @ np.linalg.lstsq(held, target)[0]
    found = marginals(friction)[0].size_sigma
    assert found == pytest.approx(float(np.linalg.norm(left)), rel=1e-6)
