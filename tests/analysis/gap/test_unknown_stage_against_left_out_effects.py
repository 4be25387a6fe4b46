"""Effects that the catalogue is made to forget: the stage of the unknown against where they act."""

import pytest

from analysis.gap.components import Component, Part
from analysis.gap.diagnose import Settings, diagnose
from analysis.gap.whence import stage_by_channels, unknown_stages
from sim.effects.catalogue import build, find
from sim.effects.effect import StageName
from sim.rig import SimulatedRig
from tests.analysis.gap.small import record

KNOWN = (
    "coulomb-friction", "viscous-guides", "cable", "quadratic-damping", "cubic-damping",
    "nonlinear-restoring", "gauge-hysteresis", "quadratic-gauge", "amplifier-lag", "speed-ripple",
    "torque-cogging", "eccentricity-error", "slot-tilt",
)  # fmt: skip


@pytest.mark.parametrize(
    ("put_in", "forgotten"),
    [
        ("stribeck-friction", ()),
        ("coulomb-friction:friction_n=0.3", ("coulomb-friction",)),
        ("quadratic-damping", ("quadratic-damping",)),
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
    shares = unknown_stages(found.problem, found.walk, found.weighed, catalogue)
    assert sum(shares.values()) == pytest.approx(1.0)
    assert max(shares, key=lambda name: shares[name]) == effect.stage.value


@pytest.mark.parametrize(
    ("channels", "in_air", "stage"),
    [
        (("carriage_speed", "force_aft"), None, StageName.CARRIAGE),
        (("shaft_angle", "displacement_aft", "force_aft"), None, StageName.DRIVE),
        (("displacement_fore", "force_aft"), True, StageName.MECHANISM),
        (("",), None, StageName.PHOTOCELL),
        (("force_aft",), True, StageName.DYNAMOMETERS),
        (("force_aft", "force_fore"), True, StageName.STRUCTURE),
        (("force_aft", "force_fore"), False, StageName.MODEL),
    ],
)
def test_channels_tell_the_stage_where_no_effect_does(
    channels: tuple[str, ...], in_air: bool | None, stage: StageName
) -> None:
    seen = [Component(one, Part.IN_PHASE, 1) for one in channels]
    assert stage_by_channels(seen, in_air) is stage
