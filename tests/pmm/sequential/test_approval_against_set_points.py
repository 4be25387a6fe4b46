"""What an envelope approves of, against set-points and a clock by hand."""

from pathlib import Path

import pytest

from hardware.description.errors import ConfigurationError
from hardware.description.kinds import Motion, RunKind
from hardware.description.setpoint import SetPoint
from pmm.plan.run_plan import RunPlan
from pmm.sequential.approval import approval_of

ENVELOPE = """
minutes = 30.0
frequency_hz = [0.5, 1.0]
amplitude_mm = [5.0, 20.0]
speed_m_s = [0.0, 1.2]
"""
INSIDE = {"frequency_hz": 1.0, "eccentricity_m": 0.02, "carriage_speed_m_s": 1.2}


def _run(**changed: float) -> RunPlan:
    return RunPlan("one", RunKind.OSCILLATION, Motion.HEAVE, SetPoint(**{**INSIDE, **changed}))


@pytest.mark.parametrize(
    ("changed", "inside"),
    [
        ({}, True),
        ({"frequency_hz": 0.5, "eccentricity_m": 0.005}, True),
        ({"frequency_hz": 1.01}, False),
        ({"eccentricity_m": 0.0049}, False),
        ({"carriage_speed_m_s": 1.3}, False),
        ({"drift_rad": 0.01}, False),
    ],
)
def test_all_of_a_set_point_lies_within(
    tmp_path: Path, changed: dict[str, float], inside: bool
) -> None:
    path = tmp_path / "envelope.toml"
    path.write_text(ENVELOPE, encoding="utf-8")
    one = approval_of(str(path), simulated=False, clock=lambda: 0.0)
    assert not one.covers([_run()])  # nobody attends yet
    one.begin()
    assert one.covers([_run(**changed)]) is inside
    assert one.covers([_run(), _run(**changed)]) is inside


def test_an_envelope_ends_with_its_time(tmp_path: Path) -> None:
    path, now_s = tmp_path / "envelope.toml", 1000.0
    path.write_text(ENVELOPE, encoding="utf-8")
    one = approval_of(str(path), simulated=False, clock=lambda: now_s)
    one.begin()
    now_s += 30.0 * 60.0 - 1.0
    assert one.covers([_run()])
    now_s += 1.0
    assert not one.covers([_run()])


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        (("minutes = 30.0", "minutes = 0.0"), "minutes = 0 should be above 0 and at most 240"),
        (("[0.5, 1.0]", "[1.0, 0.5]"), "frequency_hz should go from the lowest"),
        (("speed_m_s", "sped_m_s"), "did you mean"),
        (("amplitude_mm = [5.0, 20.0]", ""), "amplitude_mm"),
    ],
)
def test_wrong_envelopes_say_where(tmp_path: Path, changed: tuple[str, str], said: str) -> None:
    path = tmp_path / "envelope.toml"
    path.write_text(ENVELOPE.replace(*changed), encoding="utf-8")
    with pytest.raises(ConfigurationError, match=r"envelope\.toml") as caught:
        approval_of(str(path), simulated=True)
    assert said in str(caught.value)


def test_nothing_is_approved_of_by_default_and_all_on_the_simulated_rig_alone() -> None:
    assert not approval_of(None, simulated=True).covers([_run()])
    assert approval_of("all", simulated=True).covers([_run(frequency_hz=2.0)])
    with pytest.raises(ConfigurationError, match="is for the simulated rig"):
        approval_of("all", simulated=False)
