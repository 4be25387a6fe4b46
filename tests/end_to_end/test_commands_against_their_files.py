"""What the commands write and print: the same numbers twice, no recording lost, clean streams."""

import json
import os
import re
import shlex
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner, Result

from analysis.readers import read_recording, write_recording
from pmm.campaign.simulation import seed_of
from pmm.cli import cli
from pmm.document.notation import rounded
from pmm.harmonics import resolving

HOUSE = Path(__file__).parents[2]
SHIPPED = HOUSE / "examples"
HEAVE = ("simulate", SHIPPED / "vertical" / "campaign.toml", "--run", "heave-1.20")


def run(*arguments: str | Path) -> Result:
    return CliRunner().invoke(cli, [str(one) for one in arguments], catch_exceptions=False)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    assert run(*HEAVE, "--output", tmp_path / "heave").exit_code == 0
    return tmp_path / "heave"


def _values(found: Any, factor: float = 1.0) -> list[str]:
    """Every value of a JSON document as the table writes it, in order: lengths in mm."""
    if isinstance(found, dict) and "half_width" in found:
        half_width = np.nan if found["half_width"] is None else found["half_width"]
        return [rounded(found["value"] * factor, half_width * factor)]
    if isinstance(found, dict) and "phase_deg" in found:
        parts = [found[key] for key in ("in_phase", "quadrature", "amplitude")]
        phase = found["phase_deg"]
        is_open = phase["half_width"] is not None and phase["half_width"] >= 90.0
        told = ["open"] if is_open else _values(phase)
        return [value for part in parts for value in _values(part, factor)] + told
    if isinstance(found, dict):
        factor = 1e3 if found.get("unit") == "m" else factor
        found = list(found.values())
    return (
        [one for part in found for one in _values(part, factor)] if isinstance(found, list) else []
    )


@pytest.mark.sample(1)
@pytest.mark.parametrize("options", [(), ("--gate", "3"), ("--opens-at", "1", "--periods", "1")])
def test_the_table_has_the_numbers_of_the_json_document(
    folder: Path, options: tuple[str, ...]
) -> None:
    recording = folder / "heave-1.20.nc"
    table = run("analyse", recording, *options).stdout
    document = json.loads(run("analyse", recording, "--json", *options).stdout)
    rows = re.findall(r"(?:^|\s)(?:mean|\d)\s\s+(.*)$", table, re.MULTILINE)
    printed = [cell for row in rows for cell in re.split(r"\s\s+", row.strip())]
    assert len(printed) >= 4 * (1 + 3 * 4)
    assert printed == _values(document)


def test_a_single_period_has_no_interval_and_says_so(folder: Path) -> None:
    options = ("--opens-at", "1", "--periods", "1")
    document = json.loads(run("analyse", folder / "heave-1.20.nc", "--json", *options).stdout)
    (gate,) = document["runs"][0]["gates"]
    assert gate["channels"][0]["mean"]["half_width"] is None
    assert "no_interval" in {flag["code"] for flag in gate["flags"]}


def test_without_a_terminal_there_is_neither_colour_nor_progress(folder: Path) -> None:
    recording = folder / "heave-1.20.nc"
    done = run("analyse", recording, recording)
    assert done.stderr == ""
    assert "\x1b" not in done.stdout


def test_failures_are_in_the_json_document_too(folder: Path) -> None:
    done = run("analyse", folder, "nowhere.csv", "--json")
    assert done.exit_code == 2
    document = json.loads(done.stdout)
    assert len(document["runs"]) == 1
    assert document["failed"] == [
        {"file": "nowhere.csv", "message": "nowhere.csv: no such file", "flags": []},
    ]


def test_runs_that_are_not_recorded_yet_are_said(folder: Path) -> None:
    done = run("analyse", folder, "--json")
    assert done.exit_code == 0
    document = json.loads(done.stdout)
    missing = [str(folder / f"{name}.nc") for name in ("heave-0.50", "heave-0.83")]
    assert document["not_recorded"][:2] == missing
    assert len(document["not_recorded"]) == 5
    assert done.stderr.splitlines()[0] == f"not recorded yet: {missing[0]}"
    (folder / "heave-1.20.nc").unlink()
    none = run("analyse", folder)
    assert none.exit_code == 1
    assert "none of its 6 runs is recorded yet" in none.stderr


def test_simulate_writes_a_campaign_folder(folder: Path) -> None:
    seen = sorted(path.name for path in folder.iterdir() if not path.name.startswith("."))
    assert seen == ["campaign.toml", "heave-1.20.nc"]
    shipped = (SHIPPED / "vertical" / "campaign.toml").read_bytes()
    assert (folder / "campaign.toml").read_bytes() == shipped
    recording = read_recording(folder / "heave-1.20.nc")
    assert recording.set_point is not None
    assert recording.set_point.frequency_hz == 1.2
    assert recording.provenance["seed"] == str(seed_of(1963, "heave-1.20"))


def test_a_recording_is_never_replaced_unasked(folder: Path) -> None:
    recording = folder / "heave-1.20.nc"
    before = recording.read_bytes()
    refused = run(*HEAVE, "--output", folder, "--seed", "7")
    assert refused.exit_code == 2
    assert f"{recording}: there already" in refused.stderr
    assert recording.read_bytes() == before
    assert run(*HEAVE, "--output", folder, "--seed", "7", "--overwrite").exit_code == 0
    assert recording.read_bytes() != before


def test_another_campaigns_file_is_not_replaced(folder: Path) -> None:
    other = (
        "simulate",
        SHIPPED / "horizontal" / "campaign.toml",
        "--run",
        "sway-0.20",
        "--output",
        folder,
    )
    refused = run(*other)
    assert refused.exit_code == 2
    assert "campaign.toml: there already" in refused.stderr


def test_simulated_runs_are_not_put_among_measured_ones(tmp_path: Path) -> None:
    path = tmp_path / "campaign.toml"
    text = (SHIPPED / "vertical" / "campaign.toml").read_text(encoding="utf-8")
    path.write_text(text.replace('name = "heave-1.20"', 'name = "heave"\nfile = "a.csv"'))
    refused = run("simulate", path, "--output", tmp_path)
    assert refused.exit_code == 2
    assert "into another folder" in refused.stderr


@pytest.mark.slow
def test_one_run_alone_is_the_run_among_all(folder: Path, tmp_path: Path) -> None:
    assert (
        run(
            "simulate", SHIPPED / "vertical" / "campaign.toml", "--output", tmp_path / "all"
        ).exit_code
        == 0
    )
    alone, among = (read_recording(one / "heave-1.20.nc") for one in (folder, tmp_path / "all"))
    np.testing.assert_array_equal(alone.values("force_aft"), among.values("force_aft"))
    other = read_recording(tmp_path / "all" / "pitch-1.20.nc")
    noise = [one.values("displacement_aft") for one in (among, other)]
    assert np.corrcoef(*(one - one.mean() for one in np.diff(noise, n=6)))[0, 1] < 0.1


def test_an_unknown_run_is_named(tmp_path: Path) -> None:
    done = run(
        "simulate",
        SHIPPED / "vertical" / "campaign.toml",
        "--run",
        "heave-1.2",
        "--output",
        tmp_path,
    )
    assert done.exit_code == 2
    assert "no run 'heave-1.2'; did you mean 'heave-1.20'?" in done.stderr


def test_a_run_beyond_the_struts_is_named(tmp_path: Path) -> None:
    text = (SHIPPED / "vertical" / "campaign.toml").read_text(encoding="utf-8")
    path = tmp_path / "heavy.toml"
    path.write_text(text.replace("eccentricity_mm = 20.0", "eccentricity_mm = 60.0"))
    done = run("simulate", path, "--output", tmp_path / "runs", "--run", "pitch-0.50")
    assert done.exit_code == 0
    path.write_text(text.replace("mass_kg = 70.0", "mass_kg = 7000.0"))
    done = run("simulate", path, "--output", tmp_path / "heavy", "--run", "heave-1.20")
    assert done.exit_code == 2
    assert "run 'heave-1.20': force_" in done.stderr
    assert "force_per_strut_n" in done.stderr


def _foreign(folder: Path, recording: Path) -> None:
    """Write a recording as another system might: other names, millimetres, a sign turned."""
    run_ = read_recording(recording)
    rows = np.column_stack(
        [
            run_.time_s(),
            1e3 * run_.values("displacement_aft"),
            run_.values("force_aft"),
            -1e-3 * run_.values("force_fore"),
        ]
    )
    header = "Time [s],Strut [mm],F1 [N],F2 [kN]"
    np.savetxt(folder / "run_1.csv", rows, "%.9f", ",", header=header, comments="")


CAMPAIGN = """
[columns.channels]
displacement_aft = "Strut [mm]"
force_aft = "F1 [N]"
force_fore = "-F2 [kN]"

[analysis]
harmonics = 2

[[runs]]
name = "heave"
file = "run_1.csv"
frequency_hz = 1.2
eccentricity_mm = 20
"""


def test_a_campaign_of_another_system(folder: Path, tmp_path: Path) -> None:
    _foreign(tmp_path, folder / "heave-1.20.nc")
    (tmp_path / "campaign.toml").write_text(CAMPAIGN)
    (rows,) = json.loads(run("analyse", tmp_path, "--json").stdout)["runs"]
    assert (rows["reference"], rows["reference_channel"]) == ("signal", "displacement_aft")
    own = json.loads(run("analyse", folder, "--json", "--channel", "force_fore").stdout)["runs"][0]
    fore = rows["gates"][0]["channels"][1]["harmonics"]
    assert len(fore) == 2
    theirs, ours = (
        one["in_phase"] for one in (fore[0], own["gates"][0]["channels"][0]["harmonics"][0])
    )
    assert theirs["value"] == pytest.approx(ours["value"], abs=0.02)
    # An option goes before the campaign's own setting.
    again = json.loads(run("analyse", tmp_path, "--json", "--harmonics", "1").stdout)["runs"][0]
    assert len(again["gates"][0]["channels"][0]["harmonics"]) == 1


def test_columns_edges_and_rate_from_the_command_line(folder: Path, tmp_path: Path) -> None:
    _foreign(tmp_path, folder / "heave-1.20.nc")
    edges = read_recording(folder / "heave-1.20.nc").photocell_edges_s
    assert edges is not None
    np.savetxt(tmp_path / "edges.csv", edges, "%.9f", header="time", comments="")
    columns = ("--column", "fore=-F2:kN", "--column", "time=Time:s")
    edges_of = ("--edges", tmp_path / "edges.csv")
    done = run("analyse", tmp_path / "run_1.csv", *columns, *edges_of, "--json")
    (rows,) = json.loads(done.stdout)["runs"]
    assert (rows["reference"], rows["reference_channel"]) == ("photocell", None)
    own = json.loads(run("analyse", folder, "--json", "--channel", "force_fore").stdout)["runs"][0]
    theirs, ours = (
        one["gates"][0]["channels"][0]["harmonics"][0]["quadrature"] for one in (rows, own)
    )
    assert theirs["value"] == pytest.approx(ours["value"], abs=1e-5)
    two = run("analyse", folder, tmp_path / "run_1.csv", *edges_of)
    assert two.exit_code == 2
    assert "{stem}" in two.stderr


def test_recordings_are_saved_and_kept(folder: Path, tmp_path: Path) -> None:
    _foreign(tmp_path, folder / "heave-1.20.nc")
    arguments = ("analyse", tmp_path / "run_1.csv", "--frequency", "1.2", "--save", tmp_path / "nc")
    assert run(*arguments).exit_code == 0
    saved = read_recording(tmp_path / "nc" / "run_1.nc")
    assert saved.channel_names == ("Strut", "F1", "F2")
    again = run(*arguments)
    assert again.exit_code == 2
    assert "run_1.nc: exists already" in again.stderr


@pytest.mark.slow
def test_plots_are_written(folder: Path, tmp_path: Path) -> None:
    plots = ("--channel", "force_aft", "--plot", tmp_path / "plots")
    assert run("analyse", folder / "heave-1.20.nc", *plots).exit_code == 0
    names = {path.name for path in (tmp_path / "plots").iterdir()}
    kinds = ("gate", "phasors", "spectrum")
    assert names == {f"heave-1.20-{kind}.{end}" for kind in kinds for end in ("svg", "png")}


@pytest.mark.slow
def test_plots_by_two_processes_are_those_of_one(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A file that cannot be read is named, in its place, and does not stop the others."""
    recording = folder / "heave-1.20.nc"
    other, broken = tmp_path / "other.nc", tmp_path / "broken.nc"
    other.write_bytes(recording.read_bytes())
    broken.write_bytes(b"no recording")
    drawn, texts = [], []
    for cores in (1, 2):
        monkeypatch.setattr("analysis.threads.cores", lambda cores=cores: cores)
        plots = tmp_path / f"by-{cores}"
        done = run("analyse", recording, broken, other, "--channel", "force_aft", "--plot", plots)
        assert done.exit_code == 1
        assert done.stderr.count("\n") == done.stderr.count("broken.nc") == 1
        texts.append(done.stdout)
        drawn.append({path.name: path.read_bytes() for path in plots.iterdir()})
    assert len(drawn[0]) == 12
    assert drawn[0] == drawn[1]
    assert texts[0] == texts[1]


@pytest.mark.parametrize("option", ["--plot", "--save"])
def test_two_recordings_of_one_name_do_not_overwrite_each_other(
    option: str, folder: Path, tmp_path: Path
) -> None:
    recording = folder / "heave-1.20.nc"
    done = run("analyse", recording, recording, option, tmp_path / "out")
    assert done.exit_code == 2
    assert "several recordings are called 'heave-1.20'" in done.stderr
    assert not (tmp_path / "out").exists()


def test_an_interrupt_has_its_own_status(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupt(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(resolving, "read_source", interrupt)
    done = run("analyse", folder)
    assert (done.exit_code, done.stdout, done.stderr) == (130, "", "stopped\n")


def test_a_folder_that_cannot_be_made_is_named(folder: Path, tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    done = run(*HEAVE, "--output", tmp_path / "file" / "runs")
    assert done.exit_code == 2
    where = f"--output {tmp_path / 'file' / 'runs'}: {tmp_path / 'file'}"
    assert done.stderr == f"error: {where} is a file, not a folder\n"


def test_a_refused_run_leaves_no_folder(tmp_path: Path) -> None:
    text = (SHIPPED / "vertical" / "campaign.toml").read_text(encoding="utf-8")
    (tmp_path / "heavy.toml").write_text(text.replace("mass_kg = 70.0", "mass_kg = 7000.0"))
    done = run("simulate", tmp_path / "heavy.toml", "--output", tmp_path / "a" / "b")
    assert done.exit_code == 2
    assert not (tmp_path / "a").exists()


def test_hints_can_be_pasted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "argv", [".venv/bin/pmm", "simulate"])
    done = run(*HEAVE, "--output", tmp_path / "my runs")
    hint = done.stdout.splitlines()[-1]
    assert shlex.split(hint) == [".venv/bin/pmm", "analyse", str(tmp_path / "my runs")]
    assert done.stdout.splitlines()[0].rstrip() == "vertical: 1 run"


def test_each_run_is_printed_when_it_is_done(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    read = resolving.read_source

    def then_stop(source: Any, *rest: Any, **options: Any) -> Any:
        if source.path.name == "second.nc":
            raise KeyboardInterrupt
        return read(source, *rest, **options)

    monkeypatch.setattr(resolving, "read_source", then_stop)
    done = run("analyse", folder / "heave-1.20.nc", "second.nc")
    assert done.exit_code == 130
    assert "force_aft [N]" in done.stdout


def test_a_set_point_that_was_not_kept_is_in_table_and_document(folder: Path) -> None:
    recording = read_recording(folder / "heave-1.20.nc")
    assert recording.set_point is not None
    told = replace(recording, set_point=replace(recording.set_point, frequency_hz=1.1))
    write_recording(told, folder / "heave-1.20.nc", overwrite=True)
    done = run("analyse", folder / "heave-1.20.nc")
    assert "set-point's frequency is 1.1 Hz, found are 1.2 Hz" in done.stdout
    (rows,) = json.loads(run("analyse", folder / "heave-1.20.nc", "--json").stdout)["runs"]
    assert "set_point_differs" in {flag["code"] for flag in rows["flags"]}


def _command(*arguments: str | Path) -> list[str]:
    code = "from pmm.cli import main; main()"
    return [sys.executable, "-c", code, *map(str, arguments)]


@pytest.mark.slow
def test_a_closed_pipe_is_quiet(folder: Path) -> None:
    environment = os.environ | {"PYTHONPATH": str(HOUSE)}
    with subprocess.Popen(
        _command("analyse", folder, "--json"),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        env=environment,
    ) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdout.close()
        assert process.stderr.read() == b""
        assert process.wait() == 1


@pytest.mark.slow
def test_the_real_command_in_a_process_of_its_own(folder: Path) -> None:
    done = subprocess.run(
        _command("analyse", folder / "heave-1.20.nc", "--channel", "force_aft"),
        capture_output=True,
        text=True,
        env=os.environ | {"PYTHONPATH": str(HOUSE)},
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert "force_aft [N]" in done.stdout
    assert "95 % intervals from the scatter between the gate's periods" in done.stdout


def test_the_version_says_what_it_runs_on() -> None:
    done = run("--version")
    assert done.exit_code == 0
    python = ".".join(map(str, sys.version_info[:3]))
    assert re.fullmatch(
        rf"pmm (\S+|from a source tree)( \([0-9a-f]+(-dirty)?\))?, Python {python}\S*, \w+ \w+, "
        rf"NumPy {re.escape(np.__version__)}, SciPy \S+, numba [^,]+, python-can \S+, "
        r"canopen \S+\n",
        done.stdout,
    )


def test_a_channel_given_twice_is_resolved_once(folder: Path) -> None:
    options = ("--channel", "force_fore", "--channel", "force_fore", "--json")
    (rows,) = json.loads(run("analyse", folder, *options).stdout)["runs"]
    assert [one["name"] for one in rows["gates"][0]["channels"]] == ["force_fore"]


def test_forces_go_first_and_lengths_are_in_millimetres(folder: Path) -> None:
    done = run("analyse", folder / "heave-1.20.nc", "--gate", "5").stdout
    assert done.index("force_aft [N]") < done.index("displacement_aft [mm]")
    assert re.search(r"displacement_aft \[mm\] +mean.*\n.*\n +1 +(19\.9|20\.0)", done)


@pytest.mark.parametrize("command", ["simulate", "demo"])
def test_an_output_in_whose_place_a_file_stands(command: str, tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    campaign = () if command == "demo" else (SHIPPED / "vertical" / "campaign.toml",)
    done = run(command, *campaign, "--output", tmp_path / "file")
    assert (done.exit_code, done.stdout) == (2, "")
    assert "is a file, not a folder" in done.stderr
