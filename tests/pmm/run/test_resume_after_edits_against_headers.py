"""Plan, rig, model and calibration edited between two parts of a campaign.

Oracles: the raw headers, the values as they are typed here, and the water that is put in: what is
left of a run's force when its own inertia is taken off is 75 kg whichever model hung there.
"""

import hashlib
import json
import tomllib
from dataclasses import fields
from pathlib import Path

import pytest

from pmm.campaign.campaign_file import read_campaign
from pmm.campaign.recording_source import RecordingSource, open_recording
from pmm.campaign.runs import RecordedWith
from pmm.plan.plan import read_plan_and_rig
from pmm.run.campaign_folder import keep_sources
from pmm.run.run_origin import _TABLES
from tests.pmm.run.processes import pmm
from tests.sim.devices.benches import ROOT

RIG = (ROOT / "examples" / "vertical" / "rig.toml").read_text(encoding="utf-8")
PLAN = """
name = "edited"
rig = "rig.toml"
[defaults]
periods = 3
settling_periods = 1
pause_s = 0.5
[[runs]]
name = "known"
kind = "known-mass"
motion = "heave"
frequencies_hz = 1.2
amplitudes_mm = 20.0
known_mass = { mass_kg = 5.0 }
[[runs]]
name = "slow"
motion = "heave"
frequencies_hz = 0.8
amplitudes_mm = 20.0
[[runs]]
name = "fast"
motion = "heave"
frequencies_hz = 1.2
amplitudes_mm = 20.0
"""
CALIBRATION = """
made = "2026-01-01"
expires = "2036-01-01"
channels = ["force_aft", "force_fore"]
matrix = [[1.0, 0.0], [0.0, 1.0]]
standard_uncertainty = [[1e-4, 0.0], [0.0, 1e-4]]
hysteresis = [0.0, 0.0]
nonlinearity = [0.0, 0.0]
"""
CALIBRATED = 'calibration_file = "calibration.toml"\n' + RIG
KNOWN, SLOW, FAST = "known-f1.2-a20", "slow-f0.8-a20", "fast-f1.2-a20"
MATRIX = ("matrix = [[1.0, 0.0], [0.0, 1.0]]", "matrix = [[1.0, 0.25], [0.0, 1.0]]")
ADDED_KG = 75.0  # [hull] of the rig's file: what is simulated


@pytest.fixture(scope="module")
def begun(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The first two runs, made of the files as they stand here."""
    folder = tmp_path_factory.mktemp("begun")
    _write(folder, "plan", PLAN)
    _write(folder, "rig", CALIBRATED)
    _write(folder, "simulated", 'rig = "rig.toml"\n')
    _write(folder, "calibration", CALIBRATION)
    made = _run(folder, "--only", KNOWN, "--only", SLOW)
    assert made.exit_code == 0, made.stderr
    return folder


@pytest.fixture
def part(begun: Path, tmp_path: Path) -> Path:
    """The same to go on with."""
    for path in (one for one in begun.rglob("*") if one.is_file()):
        copy = tmp_path / path.relative_to(begun)
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.write_bytes(path.read_bytes())
    return tmp_path


def _write(folder: Path, name: str, text: str) -> None:
    (folder / f"{name}.toml").write_text(text, encoding="utf-8")


def _edit(folder: Path, name: str, before: str, after: str) -> None:
    text = (folder / f"{name}.toml").read_text(encoding="utf-8")
    assert before in text
    _write(folder, name, text.replace(before, after))


def _run(folder: Path, *words: str):
    return pmm("run", folder / "plan.toml", "--output", folder / "out", *words)


def _kept(folder: Path) -> dict[str, bytes]:
    out = folder / "out"
    return {str(one): one.read_bytes() for one in out.rglob("*") if one.is_file()}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("file", "before", "after", "told"),
    [
        (
            "plan",
            "mass_kg = 5.0",
            "mass_kg = 6.5",
            [f"{KNOWN}: plan.toml known_mass.mass_kg was 5.0, is 6.5"],
        ),
        (
            "plan",
            "periods = 3",
            "periods = 4",
            [f"{name}: plan.toml periods was 3, is 4" for name in (KNOWN, SLOW)],
        ),
        (
            "rig",
            "mass_kg = 70.0",
            "mass_kg = 80.0",
            [f"{name}: rig.toml model.mass_kg was 70.0, is 80.0" for name in (KNOWN, SLOW)],
        ),
        (
            "rig",
            'object = "9130:1", scale = 1e-3',
            'object = "9130:1", scale = 2e-3',
            [f'{SLOW}: rig.toml forces[1].channels["force_aft"].scale was 0.001, is 0.002'],
        ),
        (
            "rig",
            'preset = "vertical-1963"',
            'preset = "vertical-1963"\nforce_per_strut_n = 900.0',
            [f"{SLOW}: rig.toml oscillator.force_per_strut_n was not set, is 900.0"],
        ),
        (
            "rig",
            'calibration_file = "calibration.toml"\n',
            "",
            [f'{SLOW}: calibration.toml made was "2026-01-01", is not set'],
        ),
        ("calibration", *MATRIX, [f"{SLOW}: calibration.toml matrix[1][2] was 0.0, is 0.25"]),
        (
            "plan",
            'name = "slow"',
            'name = "slower"',
            [f"{SLOW}: plan.toml has no run '{SLOW}' any more"],
        ),
    ],
)
def test_a_value_that_changed_is_refused_by_file_key_and_run(
    part: Path, file: str, before: str, after: str, told: list[str]
) -> None:
    _edit(part, file, before, after)
    as_they_were = _kept(part)
    for words in (("--resume", "--dry-run"), ("--only", FAST)):
        refused = _run(part, *words)
        assert refused.exit_code == 2, refused.stderr
        said = " ".join(refused.stderr.split())
        for one in told:
            assert one in said, said
        assert "--accept-changes" in said
    assert _kept(part) == as_they_were


@pytest.mark.slow
def test_what_is_kept_is_what_was_read_whatever_was_edited_since(part: Path) -> None:
    plan, rig = read_plan_and_rig(part / "plan.toml")
    _write(part, "plan", PLAN.replace("periods = 3", "periods = 4"))
    _edit(part, "rig", "mass_kg = 70.0", "mass_kg = 80.0")
    (part / "plan.toml").rename(part / "moved.toml")
    keep_sources(plan, rig, part / "later")
    copies = {one.name: one.read_bytes() for one in (part / "later" / "made-from").iterdir()}
    assert copies == {"plan.toml": PLAN.encode(), "rig.toml": CALIBRATED.encode()}
    hashes = {name: hashlib.sha256(one).hexdigest() for name, one in copies.items()}
    assert hashes == {"plan.toml": plan.sha256, "rig.toml": rig.hashes["rig"]}


@pytest.mark.slow
def test_comments_and_runs_that_were_added_change_nothing(part: Path) -> None:
    _edit(part, "rig", "[tank]", "# measured in spring\n[tank]")
    more = PLAN.rpartition("[[runs]]")[2].replace('"fast"', '"faster"').replace("1.2", "1.3")
    _write(part, "plan", f"# more\n{PLAN}[[runs]]{more}")
    done = _run(part, "--resume", "--dry-run")
    assert done.exit_code == 0, done.stderr
    assert "2 runs would be recorded" in done.stdout
    assert "keeps what" not in done.stderr


@pytest.mark.slow
def test_accepted_changes_stand_run_by_run_and_each_run_keeps_its_own(part: Path) -> None:
    _edit(part, "plan", "mass_kg = 5.0", "mass_kg = 6.5")
    _edit(part, "plan", "periods = 3", "periods = 4")
    _edit(part, "rig", "mass_kg = 70.0", "mass_kg = 80.0")
    _edit(part, "rig", 'object = "9130:1", scale = 1e-3', 'object = "9130:1", scale = 2e-3')
    (part / "out" / "made-from" / "broken.toml").write_text("[", encoding="utf-8")
    went_on = _run(part, "--resume", "--accept-changes", "--json")
    assert went_on.exit_code == 0, went_on.stderr
    made = json.loads(went_on.stdout)
    assert made["planned"] == [FAST]
    assert [one.partition(":")[0] for one in made["changes"]] == [KNOWN, SLOW]
    assert went_on.stderr.count("keeps what it was recorded with") == 2
    headers = {
        name: json.loads((part / "out" / name / "header.json").read_text(encoding="utf-8"))
        for name in (KNOWN, SLOW, FAST)
    }
    campaign = read_campaign(part / "out" / "campaign.toml")
    for run in campaign.runs:
        planned = json.loads(headers[run.name]["plan_json"])
        assert run.periods == planned["periods"] == (4 if run.name == FAST else 3)
        mass_kg = 80.0 if run.name == FAST else 70.0
        recorded = campaign.as_recorded(run.name)
        assert recorded.model is not None
        assert recorded.model.mass_kg == mass_kg
        assert recorded.oscillator == campaign.oscillator
        assert bool(run.differs) == (run.name != FAST)
    known = campaign.run(KNOWN).known_mass
    assert known is not None
    assert known.mass_kg == json.loads(headers[KNOWN]["plan_json"])["known_mass"]["mass_kg"] == 5.0
    table = tomllib.loads((part / "out" / "campaign.toml").read_text(encoding="utf-8"))
    assert [list(one.get("recorded_with", {})) for one in table["runs"]] == [["model"]] * 2 + [[]]
    _check_water(part / "out")
    left_out = pmm("gap", "diagnose", part / "out", "--json")
    assert "another rig or model: " in left_out.stdout + left_out.stderr


def _check_water(folder: Path) -> None:
    """The heavier model's force less the lighter one's inertia would leave 10 kg too much."""
    found = pmm("coefficients", folder, "--json", "--form", "seakeeping")
    assert found.exit_code == 0, found.stderr
    document = json.loads(found.stdout)
    flags = [*document["coefficients"]["flags"], *(f for r in document["runs"] for f in r["flags"])]
    told = {(one["code"], *one["runs"]) for one in flags}
    assert {("recorded_otherwise", SLOW), ("own_model", SLOW)} <= told
    assert not {("recorded_otherwise", FAST), ("own_model", FAST)} & told
    values = [one["value"] for one in document["recommended"] if one["name"] == "a33"]
    assert len(values) == 2
    assert values == pytest.approx([ADDED_KG] * 2, abs=0.5)
    analysed = pmm("analyse", folder, "--json")
    assert analysed.exit_code == 0, analysed.stderr
    codes = {
        one["run"]: [flag["code"] for flag in one["flags"]]
        for one in json.loads(analysed.stdout)["runs"]
    }
    assert {name for name, own in codes.items() if "recorded_otherwise" in own} == {KNOWN, SLOW}


@pytest.mark.slow
def test_another_rig_of_which_no_copy_is_left_is_said_to_be_another(part: Path) -> None:
    _edit(part, "rig", "mass_kg = 70.0", "mass_kg = 80.0")
    (part / "out" / "made-from" / "rig.toml").unlink()
    refused = _run(part, "--resume")
    assert refused.exit_code == 2
    said = " ".join(refused.stderr.split())
    assert f"{SLOW}: rig.toml was another file (sha256" in said
    assert "made-from has no copy" in said


@pytest.mark.slow
def test_each_run_is_calibrated_by_its_own(part: Path) -> None:
    _edit(part, "calibration", *MATRIX)
    went_on = _run(part, "--resume", "--accept-changes")
    assert went_on.exit_code == 0, went_on.stderr
    tables = {}
    for name in (SLOW, FAST):
        header = json.loads((part / "out" / name / "header.json").read_text(encoding="utf-8"))
        tables[name] = json.loads(header["provenance"]["calibration"])["matrix"][0]
    assert tables == {SLOW: [1.0, 0.0], FAST: [1.0, 0.25]}
    campaign = read_campaign(part / "out" / "campaign.toml")
    for run in campaign.runs[1:]:
        own = open_recording(RecordingSource.of(campaign, run, part / "out"))
        raw = open_recording(RecordingSource(run.recording_path(part / "out"), calibration="none"))
        fore = raw.values("force_fore")
        share = tables[run.name][1]
        assert own.values("force_aft") == pytest.approx(raw.values("force_aft") - share * fore)


def test_the_tables_that_are_kept_are_those_of_the_campaign() -> None:
    assert tuple(one.name for one in fields(RecordedWith)) == _TABLES
