"""The campaign file that run control writes, as the campaign's own reader sees it."""

import json
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner
from hypothesis import given
from hypothesis import strategies as st

from analysis.readers import from_dataset, write_recording
from hardware.description.arrangement import Arrangement, DriftBy, Gauges, Joint, Pivot
from hardware.description.errors import ConfigurationError
from hardware.description.kinds import RunKind
from hardware.roles import Reading
from pmm.campaign.campaign import Campaign
from pmm.campaign.campaign_file import read_campaign
from pmm.cli import cli
from pmm.harmonics.sources import find_sources
from pmm.plan.campaign_writer import FinishedRun, write_campaign
from pmm.plan.plan import Plan, read_plan_and_rig
from pmm.plan.rig_file import RigFile
from pmm.plan.rig_tables import HANDED_ON
from pmm.toml_text import toml_table, toml_value
from sim.rig import vertical_rig
from sim.run import simulate
from tests.pmm.plan.plans import EXAMPLES, RIG_TEXT, write_plan

TEXT = st.text(st.characters(exclude_categories=["Cs"]))
VALUES = st.recursive(
    st.booleans() | TEXT | st.floats(allow_nan=False) | st.integers(-(2**63), 2**63 - 1),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(TEXT, inner, max_size=3),
    max_leaves=6,
)


@pytest.mark.slow
@given(st.dictionaries(TEXT, VALUES, max_size=4))
def test_what_is_written_is_read_back(table: dict[str, Any]) -> None:
    assert tomllib.loads(toml_table("a", table)) == {"a": table}


def test_toml_has_no_value_for_some() -> None:
    assert np.isnan(tomllib.loads(f"a = {toml_value(float('nan'))}")["a"])
    with pytest.raises(TypeError, match="cannot be written as TOML"):
        toml_value(1j)


def _done(plan: Plan) -> list[FinishedRun]:
    return [FinishedRun(one, f"{one.name}/run.nc") for one in plan.runs]


@pytest.mark.parametrize("name", ["vertical", "horizontal", "manual"])
def test_a_whole_example_is_a_campaign(name: str, tmp_path: Path) -> None:
    plan, rig = read_plan_and_rig(EXAMPLES / name / "plan.toml")
    campaign = read_campaign(write_campaign(tmp_path, plan, rig, _done(plan)))
    assert campaign.name == plan.name
    assert campaign.oscillator == rig.oscillator
    assert campaign.hull.added_mass == rig.hull.added_mass
    turning = [one for one in plan.runs if one.oscillates]
    assert [one.set_point for one in campaign.runs] == [one.set_point for one in turning]
    assert [one.kind for one in campaign.runs] == [one.kind for one in turning]
    every = sorted((*campaign.runs, *campaign.at_rest), key=lambda one: one.number or 0)
    assert [one.name for one in every] == [one.name for one in plan.runs]
    assert [one.repeat for one in every] == [one.repeat for one in plan.runs]
    for run, written in zip(plan.runs, every, strict=True):
        assert (written.zero_before or "", written.zero_after or "") == (
            run.zero_before,
            run.zero_after,
        )
        assert (written.drift_rad, written.known_mass) == (run.set_point.drift_rad, run.known_mass)
    loads = [one.load for one in campaign.at_rest if one.kind is RunKind.CHECK_WEIGHT]
    assert loads == [one.load for one in plan.runs if one.kind is RunKind.CHECK_WEIGHT]
    assert not list(tmp_path.glob(".*"))


def test_the_arrangement_is_handed_on(tmp_path: Path) -> None:
    plan, rig = read_plan_and_rig(EXAMPLES / "horizontal" / "plan.toml")
    other = Arrangement(Joint.SLIDES_ON_RIG, Pivot.FORE, Gauges.RIG, DriftBy.STRUTS_OFFSET)
    oscillator = replace(rig.oscillator, **vars(other))
    assert oscillator.arrangement == other
    file = write_campaign(tmp_path, plan, replace(rig, oscillator=oscillator), _done(plan))
    assert read_campaign(file).oscillator == oscillator


def test_the_file_is_right_after_every_run(tmp_path: Path) -> None:
    plan, rig = read_plan_and_rig(EXAMPLES / "manual" / "plan.toml")
    done = _done(plan)
    for count in range(1, 6):
        campaign = read_campaign(write_campaign(tmp_path, plan, rig, done[:count]))
        assert len(campaign.runs) + len(campaign.at_rest) == count
    # The zero run after the first three is the fifth of all.
    assert campaign.runs[0].zero_after == "zero-02"
    before = read_campaign(write_campaign(tmp_path, plan, rig, done[:4]))
    assert (before.runs[0].zero_before, before.runs[0].zero_after) == ("zero-01", None)


def _one_run(readings: dict[str, Reading], tmp_path: Path, **changes: float) -> Campaign:
    plan, rig = read_plan_and_rig(EXAMPLES / "manual" / "plan.toml")
    one = plan.runs[1]
    one = replace(one, set_point=replace(one.set_point, **changes))
    done = [FinishedRun(one, "a/run.nc", readings, outcome="stopped")]
    return read_campaign(write_campaign(tmp_path, plan, rig, done))


def test_set_points_are_those_that_were_read(tmp_path: Path) -> None:
    readings = {
        "eccentricity": Reading(0.01013, 2e-5, "micrometer"),
        "phase": Reading(-0.004, 2e-3, "phase drum"),
    }
    (run,) = _one_run(readings, tmp_path).runs
    assert (run.eccentricity_m, run.u_eccentricity_m) == (0.01013, 2e-5)
    assert (run.strut_phase_rad, run.u_strut_phase_rad) == (-0.004, 2e-3)
    assert run.outcome == "stopped"


def test_a_reading_at_the_limit_is_not_beyond_it(tmp_path: Path) -> None:
    at = {"eccentricity": Reading(0.06004, 2e-5, "micrometer")}
    (run,) = _one_run(at, tmp_path, eccentricity_m=0.06).runs
    assert run.eccentricity_m == 0.06
    beyond = {"eccentricity": Reading(0.0602, 2e-5, "micrometer")}
    with pytest.raises(ConfigurationError, match=r"eccentricity_m = 0\.0602 is outside 0 to 0\.06"):
        _one_run(beyond, tmp_path, eccentricity_m=0.06)


def test_what_the_rig_hands_on_reaches_the_campaign(tmp_path: Path) -> None:
    assert set(HANDED_ON) <= set(Campaign.__dataclass_fields__)
    more = """
[reference]
latency_s = 1e-4
[campaign.analysis]
harmonics = 6
[campaign.model_uncertainty]
mass_kg = 0.05
inertia_degrees_of_freedom = inf
[campaign.radiation]
file = "tables/a.csv"
[[campaign.effects]]
name = "amplifier-lag"
"""
    heave = '[[runs]]\nmotion = "heave"\nfrequencies_hz = 0.8\namplitudes_mm = 20.0\n'
    plan, rig = read_plan_and_rig(write_plan(tmp_path, heave, RIG_TEXT + more))
    folder = tmp_path / "out" / "campaign"
    folder.mkdir(parents=True)
    campaign = read_campaign(write_campaign(folder, plan, rig, _done(plan)))
    assert campaign.reference.latency_s == 1e-4
    assert campaign.analysis.harmonics == 6
    assert campaign.model_uncertainty is not None
    assert campaign.effects[0].name == "amplifier-lag"
    assert campaign.radiation is not None
    assert Path(campaign.radiation.file).resolve() == (tmp_path / "tables" / "a.csv").resolve()


def test_the_campaign_is_analysed_as_a_whole(tmp_path: Path) -> None:
    plan, rig = read_plan_and_rig(EXAMPLES / "manual" / "plan.toml")
    chosen = [
        one for one in plan.runs if one.name in ("zero-01", "heave-f1.3-a10", "pitch-f1.3-a20")
    ]
    for one in chosen:
        if one.oscillates:
            _record(tmp_path / one.name, rig, one.set_point, one.name)
    done = [FinishedRun(one, f"{one.name}/run.nc") for one in chosen]
    write_campaign(tmp_path, plan, rig, done)
    arguments = ["analyse", str(tmp_path), "--json"]
    result = CliRunner().invoke(cli, arguments, catch_exceptions=False)
    assert result.exit_code == 0
    names = ["heave-f1.3-a10", "pitch-f1.3-a20"]
    assert [one["run"] for one in json.loads(result.stdout)["runs"]] == names
    assert [one.stem for one in find_sources([str(tmp_path)]).sources] == names


def _record(folder: Path, rig: RigFile, point: Any, name: str) -> None:
    assert rig.oscillator == vertical_rig().oscillator
    folder.mkdir()
    data = simulate(vertical_rig(), point, periods=4, settling_periods=2, seed=1, name=name)
    write_recording(from_dataset(data), folder / "run.nc")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (
            "zero_before = 'zero-1'",
            "= 'zero-1' is no zero run of the campaign; did you mean 'zero-01'",
        ),
        ("zero_after = 'x'", "= 'x' is no zero run of the campaign; list it in [[at_rest]]"),
        ("kind = 'wet'", 'runs["a"].kind = "wet" should be'),
        ("drift_deg = 4.0\ndrift_rad = 0.1", 'runs["a"].drift_deg and drift_rad are both given'),
    ],
)
def test_what_is_wrong_with_zeros_and_kinds_is_said(text: str, said: str, tmp_path: Path) -> None:
    rest = '[[at_rest]]\nname = "zero-01"\nkind = "zero"\nfile = "z.nc"\nduration_s = 5.0\n'
    run = f'[[runs]]\nname = "a"\nfrequency_hz = 0.8\neccentricity_m = 0.02\n{text}\n'
    path = tmp_path / "campaign.toml"
    path.write_text(rest + run)
    with pytest.raises(ConfigurationError) as caught:
        read_campaign(path)
    assert said in str(caught.value)
    path.write_text(rest + rest)
    with pytest.raises(ConfigurationError, match="is taken already"):
        read_campaign(path)
