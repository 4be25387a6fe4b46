"""An effect is named whichever sign it has; all of them are planted in ``benchmarks/signs.py``."""

from dataclasses import asdict

import pytest

from analysis.gap.forward.problem import Problem
from analysis.gap.judge.diagnosis import Settings, diagnose
from analysis.gap.observe.components import GapRun
from sim.effects.a2_channel_skew import ChannelSkew
from sim.effects.catalogue import find
from sim.rig import SimulatedRig
from tests.analysis.gap.signed import planted
from tests.analysis.gap.small import problem_of, record

SIGMA = 20.0
RIVALS = ("amplifier-lag", "coulomb-friction", "quadratic-gauge", "strut-phase-error")
# Of which one sign was out of range once, and some more that are not linear in theirs.
KINDS = (
    "channel-skew",
    "photocell-delay",
    "connecting-rod",
    "quadratic-gauge",
    "surface-suction",
    "nonlinear-restoring",
)


@pytest.fixture(scope="module")
def problem(rig: SimulatedRig, clean: tuple[GapRun, ...]) -> Problem:
    return problem_of(rig, clean)


@pytest.mark.slow
@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("name", KINDS)
def test_it_is_named_with_either_sign(
    name: str, sign: float, rig: SimulatedRig, problem: Problem
) -> None:
    there = planted(problem, find(name), SIGMA, sign)
    assert there is not None
    known = {one: find(one) for one in (*RIVALS, name)}
    found = diagnose(rig, record(rig, [there], seed=51), Settings(known))
    assert found.answers.best == name
    assert found.best is not None
    fitted = asdict(found.best.effects[0])
    for one, value in asdict(there).items():
        assert fitted[one] * value >= 0.0, one


@pytest.mark.slow
@pytest.mark.parametrize("skew_s", [-3e-3, 3e-3])
def test_three_milliseconds_are_named_and_measured(skew_s: float, rig: SimulatedRig) -> None:
    runs = record(rig, [ChannelSkew(skew_s, 0.0)], seed=52)
    known = {one: find(one) for one in (*RIVALS, "channel-skew", "photocell-delay")}
    found = diagnose(rig, runs, Settings(known))
    assert found.answers.best == "channel-skew"
    assert found.best is not None
    fitted = found.best.effects[0]
    assert isinstance(fitted, ChannelSkew)
    assert fitted.aft_s == pytest.approx(skew_s, rel=0.05)
