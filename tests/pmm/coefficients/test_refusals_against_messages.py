"""What cannot be done is refused by name, with what would do it, and the exit status says whose."""

import json
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from analysis.readers import write_recording
from hardware.description.setpoint import SetPoint
from pmm.cli import cli
from sim.rig import vertical_rig
from tests.pmm.coefficients.campaigns import at_rest, head, record, vertical_campaign


def run(*words: object) -> Result:
    return CliRunner().invoke(cli, ["coefficients", *map(str, words)])


def refused(status: int, *words: object) -> str:
    result = run(*words)
    assert result.exit_code == status, result.output
    return " ".join(result.stderr.split())


@pytest.fixture(scope="module")
def heave(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Heave alone, at one frequency."""
    folder: Path = tmp_path_factory.mktemp("heave") / "c"
    vertical_campaign(folder, (0.6,), only=1)
    return folder


@pytest.fixture(scope="module")
def bare(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Heave, without any inertia."""
    folder: Path = tmp_path_factory.mktemp("bare") / "c"
    vertical_campaign(folder, (0.6,), only=1, model=False)
    return folder


def test_a_coefficient_that_the_runs_do_not_tell(heave: Path) -> None:
    said = refused(1, heave, "--form", "seakeeping", "--want", "a55")
    assert "a55" in said
    assert "pitch" in said
    said = refused(2, heave, "--want", "Z_wdott")
    assert "Z_wdot" in said  # the nearest


def test_missing_inertia(bare: Path, heave: Path) -> None:
    said = refused(2, bare)
    assert "no inertia to take off" in said
    assert "pmm inertia" in said
    assert "dry run" in said
    assert "no dry run" in refused(2, heave, "--inertia", "dry")
    assert "no such file" in refused(2, heave, "--inertia", "nowhere.toml")


def test_a_model_file_without_a_model(heave: Path, tmp_path: Path) -> None:
    (tmp_path / "m.toml").write_text("[modle]\nmass_kg = 1.0\n")
    assert "model is missing" in refused(2, heave, "--inertia", tmp_path / "m.toml")


@pytest.mark.slow
def test_a_dry_run_of_another_motion(tmp_path: Path) -> None:
    from hardware.description.setpoint import Medium

    rig = vertical_rig()
    text = head(rig, model=False)
    text += record(tmp_path, rig, "wet", SetPoint(0.6, 0.02))
    text += record(tmp_path, rig, "dry", SetPoint(0.9, 0.02, medium=Medium.AIR))
    (tmp_path / "campaign.toml").write_text(text)
    said = refused(2, tmp_path)
    assert "wet: no dry run has its motion; run it in air at 0.6 Hz with 20 mm" in said
    assert "0.9 Hz, not 0.6" in said


def test_two_runs_of_one_name(heave: Path, tmp_path: Path) -> None:
    other = tmp_path / "other"
    vertical_campaign(other, (0.6,), only=1, name="again")
    said = refused(2, heave, other)
    assert "two runs are called 'one-0.6-20'" in said
    assert str(other) in said


def test_inconsistent_geometry(heave: Path, tmp_path: Path) -> None:
    rig = vertical_rig()
    text = head(rig).replace("[hull]", "half_spacing_m = 0.4\n\n[hull]")
    text += record(tmp_path, rig, "elsewhere", SetPoint(0.7, 0.02))
    (tmp_path / "campaign.toml").write_text(text)
    assert "elsewhere has half_spacing_m = 0.4, one-0.6-20 0.5" in refused(2, heave, tmp_path)


@pytest.mark.slow
def test_systems_without_what_they_need(heave: Path, tmp_path: Path) -> None:
    said = refused(2, heave, "--system", "mmg")
    assert "length_m and draught_m" in said
    assert "[ship] of coefficients.toml" in said
    rig = vertical_rig()
    table = record(tmp_path, rig, "still", SetPoint(0.6, 0.02))
    (tmp_path / "campaign.toml").write_text(head(rig) + table)
    (tmp_path / "coefficients.toml").write_text("[ship]\nlength_m = 2.5\n")
    assert "nothing was measured at a speed above 0 m/s" in refused(
        2, tmp_path, "--system", "prime"
    )
    assert run(tmp_path, "--system", "seakeeping").exit_code == 0


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("systm = 'prime'", "systm is not a known key; did you mean system?"),
        ("[ship]\nlength_m = -1.0", "ship.length_m = -1 should be above 0"),
        ("[uncertainty]\nmass = 1.0", "did you mean mass_kg?"),
        ("[uncertainty]\nmass_kg = -1.0", "should be 0 or more"),
        ("restoring = [[1.0, 2.0]]", "two rows of two numbers"),
        ("level = 95.0", "no probability"),
        ("system = 'metric'", "system = "),
        ("calibration = 'nowhere.toml'", "no calibration"),
        ("calibration_matrix = [[1.0, 1.0], [1.0, 1.0]]", "not singular"),
        ("trials = 100", "take 1000 or more"),
        ("[[references]]\nfile = 'nowhere.csv'", "no such file"),
    ],
)
def test_settings_files(heave: Path, tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "coefficients.toml"
    path.write_text(text + "\n")
    assert message in " ".join(run(heave, "--settings", path).stderr.split())


@pytest.mark.parametrize(
    ("text", "status", "message"),
    [
        ("frequency_hz,speed_m_s\n0.6,1.2\n", 1, "no column is a coefficient"),
        ("frequency_hz,Z_w\n0.6,much\n", 1, "line 2: Z_w is 'much'"),
        ("frequency_hz,Z_w\n0.6,1\n0.6,2\n", 1, "is there twice"),
        ("# system = metric\nfrequency_hz,Z_w\n0.6,1\n", 2, "known: dimensional, prime"),
        ("# system = prime\nfrequency_hz,Z_w\n0.6,1\n", 2, "take --system prime"),
        ("frequency_hz,Z_w\n5.0,1\n", 1, "has nothing of what the campaign measured"),
    ],
)
def test_reference_tables(
    heave: Path, tmp_path: Path, text: str, status: int, message: str
) -> None:
    path = tmp_path / "r.csv"
    path.write_text(text)
    assert message in refused(status, heave, "--reference", path)


@pytest.mark.slow
def test_a_run_that_cannot_be_used_is_named_and_the_others_stand(tmp_path: Path) -> None:
    vertical_campaign(tmp_path, (0.6, 0.9), only=1)
    (tmp_path / "one-0.9-20.nc").write_bytes(b"no recording at all")
    result = run(tmp_path, "--json")
    assert result.exit_code == 1
    found = json.loads(result.stdout)
    assert [one["name"] for one in found["failed"]] == ["one-0.9-20"]
    frequencies = [row["frequency_hz"] for row in found["coefficients"]["table"]]
    assert frequencies == pytest.approx([0.6] * 4, rel=1e-6)
    assert "not a NetCDF file" in result.stderr
    (tmp_path / "one-0.6-20.nc").unlink()
    assert "none of the runs can be used" in refused(1, tmp_path)


@pytest.mark.slow
def test_a_run_left_out_is_said_to_be(tmp_path: Path) -> None:
    vertical_campaign(tmp_path, (0.6, 0.9), only=1)
    result = run(tmp_path, "--json", "--leave-out", "one-0.9-20")
    assert result.exit_code == 0
    (flag,) = [
        one for one in json.loads(result.stdout)["left_out"] if one["code"] == "run_left_out"
    ]
    assert flag["runs"] == ["one-0.9-20"]


def test_a_misspelt_run_to_leave_out_is_refused_with_the_nearest(tmp_path: Path) -> None:
    vertical_campaign(tmp_path, (0.6, 0.9), only=1)
    result = run(tmp_path, "--leave-out", "one-0.9-02")
    assert result.exit_code == 2
    assert "no run 'one-0.9-02'; did you mean 'one-0.9-20'?" in result.stderr


def test_a_tow_without_zero_runs(tmp_path: Path) -> None:
    rig = vertical_rig()
    text = head(rig) + record(tmp_path, rig, "heave", SetPoint(0.6, 0.02, 0.0, 1.2))
    write_recording(at_rest("tow", (3.0, 4.0)), tmp_path / "tow.nc")
    text += (
        '\n[[at_rest]]\nname = "tow"\nkind = "static-drift"\nfile = "tow.nc"\nduration_s = 10.0\n'
        "carriage_speed_m_s = 1.2\ndrift_deg = 4.0\n"
    )
    (tmp_path / "campaign.toml").write_text(text)
    assert "name them as zero_before and zero_after" in refused(1, tmp_path)


def test_options_that_contradict_each_other(heave: Path) -> None:
    assert "belongs to" in refused(2, heave, "--uncertainty", "linear", "--trials", 5000)
    assert "not both" in refused(2, heave, "--jobs", 2, "--scheduler", "tcp://127.0.0.1:1")
    assert "no such folder" in refused(2, "nowhere")
    assert "campaign.toml" in refused(2, heave.parent)


@pytest.mark.slow
def test_nothing_stated_is_said(heave: Path, tmp_path: Path) -> None:
    text = (heave / "campaign.toml").read_text()
    cut = text.index("[model_uncertainty]")
    vertical_campaign(tmp_path, (0.6,), only=1)
    (tmp_path / "campaign.toml").write_text(text[:cut] + text[text.index("[[runs]]") :])
    assert "nothing_stated" in run(tmp_path).output
    assert "nothing_stated" not in run(heave).output


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("x.csv", "the curves go into that CSV; name the file of the tables, which lies beside it"),
        ("X.CSV", "the curves go into that CSV"),
        ("", "a folder; name a file"),
        (".", "a folder; name a file"),
        ("/", "a folder; name a file"),
        ("file/hull.toml", "is a file, not a folder"),
    ],
)
def test_a_memory_that_cannot_be_written(
    heave: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, words: str
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "file").touch()
    assert words in refused(2, heave, "--memory", name)
    assert [one.name for one in tmp_path.iterdir()] == ["file"]


def test_a_memory_that_no_permission_allows(
    heave: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("os.access", lambda *_, **__: False)
    said = refused(2, heave, "--memory", tmp_path / "hull.toml")
    assert said.endswith(f"no permission to write in {tmp_path}; name another")


@pytest.mark.parametrize("option", ["--csv", "--netcdf", "--memory"])
def test_nothing_is_written_over_the_campaigns_own_file(heave: Path, option: str) -> None:
    file = heave / "campaign.toml"
    for named in (heave, file):
        said = refused(2, named, option, file, "--overwrite")
        assert said.endswith("the campaign is read from it; name another file")


def test_a_memory_that_the_frequencies_do_not_tell(heave: Path, tmp_path: Path) -> None:
    said = refused(1, heave, "--memory", tmp_path / "hull")  # a name without an ending
    assert "not known at four frequencies or more without carriage speed; add runs at" in said
    assert not list(tmp_path.iterdir())


def test_what_can_be_made_is_made_though_the_memory_cannot(heave: Path, tmp_path: Path) -> None:
    names = {"--csv": "t.csv", "--netcdf": "t.nc", "--plot": "figures", "--simman": "deliverables"}
    asked = [word for option, name in names.items() for word in (option, str(tmp_path / name))]
    memory = tmp_path / "hull.toml"
    made = CliRunner().invoke(cli, ["coefficients", str(heave), "--memory", str(memory), *asked])
    assert made.exit_code == 1
    assert "error: --memory: added mass and damping" in made.stderr
    assert {path.name for path in tmp_path.iterdir()} == set(names.values())
    assert made.stderr.count("written: ") == len(names)
    assert list((tmp_path / "deliverables").iterdir())


def test_a_memory_of_a_campaign_without_runs(heave: Path, tmp_path: Path) -> None:
    text = (heave / "campaign.toml").read_text()
    (tmp_path / "campaign.toml").write_text(text[: text.index("[[runs]]")])
    said = refused(1, tmp_path, "--memory", tmp_path / "hull.toml")
    assert "no runs in water; add a table [[runs]]" in said
