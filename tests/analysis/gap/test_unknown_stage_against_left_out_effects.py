"""Effects that the catalogue is made to forget: the stage of the unknown against where they act."""

import pytest

from analysis.gap.judge.diagnosis import Settings, diagnose
from sim.effects.catalogue import build, find
from sim.rig import SimulatedRig
from tests.analysis.gap.small import record

KNOWN = (
    "coulomb-friction", "viscous-guides", "cable", "quadratic-damping", "cubic-damping",
    "nonlinear-restoring", "gauge-hysteresis", "quadratic-gauge", "amplifier-lag", "speed-ripple",
    "torque-cogging", "eccentricity-error", "slot-tilt",
)  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize(
    ("put_in", "forgotten"),
    [
        ("stribeck-friction", ()),
        ("quadratic-drift", ()),
        ("torque-cogging", ("torque-cogging",)),
        ("connecting-rod", ()),
    ],
)
def test_what_is_forgotten_is_sought_where_it_acts(
    rig: SimulatedRig, put_in: str, forgotten: tuple[str, ...]
) -> None:
    effect = build(put_in)
    catalogue = {name: find(name) for name in KNOWN if name not in forgotten}
    found = diagnose(rig, record(rig, [effect], 31), Settings(catalogue))
    shares = found.answers.unknown_stages
    assert sum(shares.values()) == pytest.approx(1.0)
    assert max(shares, key=lambda name: shares[name]) == effect.stage.value


@pytest.mark.slow
def test_what_shakes_both_gauges_is_not_sought_in_one_channel(rig: SimulatedRig) -> None:
    """Vortices, in both forces of every run at speed."""
    shed = build("vortex-shedding:lift_n_s2_m2=0.1")
    catalogue = {name: find(name) for name in KNOWN}
    answers = diagnose(rig, record(rig, [shed], 31), Settings(catalogue)).answers
    assert answers.by_answer["unknown"] > 0.9
    assert answers.unknown_stages["acquisition"] < 0.1
    assert max(answers.unknown_stages.items(), key=lambda one: one[1])[0] == shed.stage.value
