"""What is wrong with the carriage's speed shows in its own record."""

import pytest

from analysis.gap.judge.diagnosis import Diagnosis, Settings, diagnose
from analysis.gap.locate.walk import CARRIAGE
from analysis.gap.observe.observation import SPEED
from sim.effects.catalogue import build, find
from sim.rig import SimulatedRig
from tests.analysis.gap.small import record

KNOWN = ("carriage-speed", "carriage-fluctuation", "blockage", "coulomb-friction")


def diagnosed(rig: SimulatedRig, said: str, seed: int) -> Diagnosis:
    runs = record(rig, [build(said)], seed)
    assert all(SPEED in {one.channel for one in run.observed.components} for run in runs)
    return diagnose(rig, runs, Settings({name: find(name) for name in KNOWN}))


@pytest.mark.slow
def test_a_mean_that_is_off(rig: SimulatedRig) -> None:
    found = diagnosed(rig, "carriage-speed:relative=0.02", 71)
    assert found.answers.by_answer["carriage-speed"] > 0.75
    assert found.best is not None
    (effect,) = found.best.effects
    assert getattr(effect, "relative", 0.0) == pytest.approx(0.02, rel=0.05)


@pytest.mark.slow
def test_a_speed_that_is_uneven(rig: SimulatedRig) -> None:
    """The walk along the chain begins with the carriage, and shows that it deviates."""
    found = diagnosed(rig, "carriage-fluctuation:relative=0.002,frequency_hz=0.37", 72)
    assert found.answers.best == "carriage-fluctuation"
    assert CARRIAGE in {one.step for one in found.walk.steps if one.is_beyond_noise}
