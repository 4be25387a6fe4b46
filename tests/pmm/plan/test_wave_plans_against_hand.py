"""Waves in a plan: its runs, the campaign that is left, what an operator is asked, and refusals."""

import json
import math
from pathlib import Path

import pytest

from hardware.description.errors import ConfigurationError
from pmm.campaign.campaign_file import read_campaign
from pmm.plan.campaign_writer import FinishedRun, write_campaign
from pmm.plan.checks import check_plan
from pmm.plan.findings import PlanVerdict
from pmm.plan.plan import read_plan, read_plan_and_rig
from pmm.run.surroundings import Surroundings
from tests.pmm.plan.plans import HORIZONTAL_TEXT, write_plan

PLAN = """
[[runs]]
motion = "sway"
frequencies_hz = [0.15, 0.2]
amplitudes_mm = 100.0
speeds_m_s = 0.8
[[runs]]
motion = "sway"
frequencies_hz = [0.15, 0.2]
amplitudes_mm = 100.0
speeds_m_s = 0.8
wave_frequency_hz = 0.55
wave_amplitude_mm = 20.0
wave_heading_deg = 150.0
"""


def test_runs_in_waves_are_named_and_come_back_from_the_campaign(tmp_path: Path) -> None:
    plan, rig = read_plan_and_rig(write_plan(tmp_path, PLAN, HORIZONTAL_TEXT))
    rough = [one for one in plan.runs if one.set_point.wave_frequency_hz]
    assert [one.name for one in rough] == ["sway-f0.15-a100-w0.55", "sway-f0.2-a100-w0.55"]
    point = rough[0].set_point
    assert (point.wave_frequency_hz, point.wave_amplitude_m) == (0.55, 0.02)
    assert point.wave_heading_rad == pytest.approx(math.radians(150.0))
    done = [FinishedRun(one, f"{one.name}/run.nc") for one in plan.runs]
    campaign = read_campaign(write_campaign(tmp_path, plan, rig, done))
    assert [one.set_point for one in campaign.runs] == [one.set_point for one in plan.runs]


def test_an_operator_starts_the_maker_once_and_stops_it(tmp_path: Path) -> None:
    plan, rig = read_plan_and_rig(write_plan(tmp_path, PLAN, HORIZONTAL_TEXT))
    calm, _, rough, again = plan.runs
    around = Surroundings()
    assert not list(around.before(calm, rig.oscillator))
    (start,) = around.before(rough, rig.oscillator)
    assert "run the wave maker at 0.55 Hz, 20 mm amplitude (half the height), 150 deg" in start
    assert json.loads(str(start.value))["wave_amplitude_m"] == 0.02
    assert not list(around.before(again, rig.oscillator))
    (stop,) = around.before(calm, rig.oscillator)
    assert "stop the wave maker" in stop


def test_a_rig_without_a_probe_is_warned_of_once(tmp_path: Path) -> None:
    probe = '{ name = "wave_probe", unit = "m", object = "9130:1", scale = 1e-6, full_scale = 1.0 }'
    table = f'[[forces]]\ndriver = "cia404-amplifier"\nnode = 6\nchannels = [{probe}]\n\n'
    probed = HORIZONTAL_TEXT.replace("[model] ", f"{table}[model] ", 1)
    texts = {HORIZONTAL_TEXT: ["sway-f0.15-a100-w0.55"], probed: []}
    for text, warned in texts.items():
        plan, rig = read_plan_and_rig(write_plan(tmp_path, PLAN, text))
        found = [one.run for one in check_plan(plan, rig) if "wave_probe [m]" in one.message]
        assert found == warned


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("wave_amplitude_mm = 20.0", "", "needs wave_frequency_hz and wave_amplitude_mm"),
        ("wave_amplitude_mm = 20.0", "wave_amplitude_mm = -2.0", "should be above 0"),
        ('motion = "sway"\n', 'kind = "dry"\nmotion = "sway"\n', "is of no use to a run of kind"),
    ],
)
def test_what_makes_no_waves_is_told(tmp_path: Path, old: str, new: str, told: str) -> None:
    calm, rough = PLAN.split("[[runs]]")[1:]
    text = f"[[runs]]{calm}[[runs]]{rough.replace(old, new)}"
    with pytest.raises(ConfigurationError) as caught:
        read_plan(write_plan(tmp_path, text, HORIZONTAL_TEXT))
    assert told in str(caught.value)


def test_a_simulated_rig_without_waves_is_refused_before_anything_moves(tmp_path: Path) -> None:
    own = 'rig = "rig.toml"\nseed = 1\n'
    (tmp_path / "simulated.toml").write_text(own, encoding="utf-8")
    path = write_plan(tmp_path, PLAN, HORIZONTAL_TEXT)
    (text,) = waves_refused(path)
    assert "no waves are simulated, and sway-f0.15-a100-w0.55 asks for some" in text
    loads = "\n[waves.across]\nfirst = 300.0\n"
    (tmp_path / "simulated.toml").write_text(own + loads, encoding="utf-8")
    assert waves_refused(path) == []
    (tmp_path / "simulated.toml").write_text(own, encoding="utf-8")
    calm = PLAN[: PLAN.rindex("[[runs]]")]
    assert waves_refused(write_plan(tmp_path, calm, HORIZONTAL_TEXT)) == []


def waves_refused(path: Path) -> list[str]:
    found = check_plan(*read_plan_and_rig(path))
    refused = [one.message for one in found if one.verdict is PlanVerdict.REFUSE]
    return [one for one in refused if "waves" in one]
