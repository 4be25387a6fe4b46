"""Boards: what is written, that it is the same each time, and that nothing leads to the key."""

import ast
import hashlib
import json
import re
import shutil
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from analysis.readers import read_recording
from analysis.readers.columns_toml import read_column_map
from analysis.recording import Recording
from tests.sealed.board import generate, jobs_of, nulls_of
from tests.sealed.generator import catalogue, outside
from tests.sealed.generator.ceiling import Library
from tests.sealed.generator.further import added, carried_out, case_of, parsed
from tests.sealed.generator.rig import Run
from tests.sealed.generator.signatures import Projection
from tests.sealed.generator.worth import DRAWS, Told

HERE = Path(__file__).parent
SEED, CASES, NULLS = 5, 2, 3


@pytest.fixture(scope="module")
def board(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a board of five cases."""
    folder = tmp_path_factory.mktemp("sealed") / "board"
    names = list(generate(jobs_of(SEED, CASES, NULLS, folder)))
    assert names == [f"case-{index:04d}" for index in range(1, CASES + NULLS + 1)]
    return folder


def _digest(folder: Path) -> dict[str, str]:
    files = sorted(path for path in folder.rglob("*") if path.is_file())
    return {
        str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in files
    }


def _truths(board: Path) -> list[dict[str, object]]:
    return [
        json.loads((key / "truth.json").read_text()) for key in sorted((board / "keys").iterdir())
    ]


@pytest.mark.slow
def test_no_case_folder_leads_to_its_key(board: Path) -> None:
    words = {effect.name for effect in (*catalogue.CATALOGUE, *outside.OUTSIDE)}
    words |= {"truth", "keys", "seed", "null", str(board)}
    for path in (board / "cases").rglob("*"):
        assert not path.is_symlink()
        if path.suffix == ".toml":
            text = path.read_text()
            said = [word for word in words if re.search(rf"(?<!\w){re.escape(word)}(?!\w)", text)]
            assert not said, path  # hum_n is a tolerance


def _read(folder: Path, run: dict[str, object], campaign: dict[str, object]) -> Recording:
    if "file" in run:
        text = folder / "columns.toml"
        lines = (folder / "campaign.toml").read_text().split("\n[columns]\n")[1]
        columns = lines.split("[[runs]]")[0].replace("[columns.", "[")
        text.write_text(columns)
        read = read_recording(folder / str(run["file"]), read_column_map(text))
        text.unlink()
        return read
    return read_recording(folder / f"{run['name']}.nc")


@pytest.mark.slow
def test_recordings_hold_what_the_case_says(board: Path) -> None:
    foreign = 0
    for folder in sorted((board / "cases").iterdir()):
        campaign = tomllib.loads((folder / "campaign.toml").read_text())
        told = tomllib.loads((folder / "case.toml").read_text())
        sensors = set(told["sensors"]) - {"photocell"}
        foreign += "columns" in campaign
        assert 8 <= len(campaign["runs"]) <= 12
        assert [row["regime"] for row in told["held_out"]] == [
            "frequency", "amplitude", "phase", "medium",
        ]  # fmt: skip
        for run in campaign["runs"][:3]:
            read = _read(folder, run, campaign)
            assert set(read.channel_names) == sensors
            assert (read.photocell_edges_s is not None) == ("photocell" in told["sensors"])
            periods = read.sample_count / read.sample_rate_hz * run["frequency_hz"]
            assert periods == pytest.approx(run["periods"] + 1, rel=0.01)
            assert np.isfinite(read.samples[:, :]).all()
    assert foreign >= 1


@pytest.mark.slow
def test_keys_are_whole_and_nuisances_invisible(board: Path) -> None:
    assert any(truth["ceiling"] for truth in _truths(board))
    for truth in _truths(board):
        assert all(row["snr"] < 1.0 for row in truth["nuisances"])  # type: ignore[attr-defined]
        assert truth["background"] < 1.0  # type: ignore[operator]
        assert set(truth["held_out"]) == {f"withheld-{i}" for i in range(1, 5)}  # type: ignore[call-overload]
        if truth["null"]:
            assert truth["verdict"] == "none"
            assert truth["snr"] < 1.0  # type: ignore[operator]
        if truth["ceiling"]:
            reached = truth["ceiling"]
            probabilities = {name: reached[name] for name in reached if name != "class_size"}  # type: ignore[attr-defined, index]
            assert all(0.0 <= value <= 1.0 for value in probabilities.values())
            assert probabilities["top_1"] <= probabilities["top_1_by_class"]


@pytest.mark.slow
def test_another_board_s_folder_is_refused(board: Path) -> None:
    with pytest.raises(FileExistsError, match="not empty"):
        jobs_of(SEED, 1, 0, board)


@pytest.mark.slow
def test_a_board_that_was_broken_off_goes_on_with_the_same_bytes(
    board: Path, tmp_path: Path
) -> None:
    half = tmp_path / "half"
    shutil.copytree(board, half)
    missing = f"case-{1 + nulls_of(SEED, CASES, NULLS).index(False):04d}"
    # Broken off between key and case: the key is there, the case is not.
    shutil.rmtree(half / "cases" / missing)
    (half / "keys" / missing / "stale").write_text("left behind")
    assert list(generate(jobs_of(SEED, CASES, NULLS, half))) == [missing]
    assert _digest(half) == _digest(board)
    assert jobs_of(SEED, CASES, NULLS, half) == []


@pytest.mark.slow
def test_further_runs_are_carried_out(board: Path, tmp_path: Path) -> None:
    case = case_of(board / "keys" / "case-0001")
    white, coloured = case.campaign.rig.noise.white_n, case.campaign.rig.noise.coloured_n
    sine = {"kind": "injection", "frequency_hz": 1.0, "force_n": 40.0}
    for name, wanted, scatter in (
        ("rest", {"kind": "rest"}, np.hypot(white, coloured)),
        ("sine", sine, 40.0 / np.sqrt(2.0)),
    ):
        carried_out(case, wanted, tmp_path / f"{name}.nc")
        read = read_recording(tmp_path / f"{name}.nc")
        force = read.samples[[read.channel_names.index("force_aft")], :][0]
        assert read.end_s == pytest.approx(20.0, abs=0.02)
        assert np.std(force) == pytest.approx(scatter, rel=0.15)


@pytest.mark.slow
def test_a_further_run_is_one_of_its_campaign(board: Path, tmp_path: Path) -> None:
    for name in sorted(path.name for path in (board / "cases").iterdir()):
        folder = shutil.copytree(board / "cases" / name, tmp_path / name)
        case = case_of(board / "keys" / name)
        run = parsed({"frequency_hz": 0.9, "drift_rad": 0.1}, case.campaign.runs[-1])
        added(case, run, folder, 1)
        last = tomllib.loads((folder / "campaign.toml").read_text())["runs"][-1]
        read = read_recording(folder / last["file"])
        assert read.name == last["name"] == "further-1"
        assert (last["frequency_hz"], last["drift_rad"]) == (0.9, 0.1)
        turned = read.sample_count / read.sample_rate_hz * 0.9
        assert turned == pytest.approx(last["periods"] + 1, rel=0.01)


def test_wrong_further_runs_are_named() -> None:
    last = Run("run-01", 0.8, 0.02)
    with pytest.raises(ValueError, match="'wiggle'"):
        parsed({"kind": "wiggle"}, last)
    with pytest.raises(ValueError, match="unknown \\['weight_n'\\]"):
        parsed({"kind": "rest", "weight_n": 3.0}, last)


@pytest.mark.slow
def test_runs_told_one_by_one_tell_what_all_rows_together_tell(board: Path) -> None:
    case = case_of(board / "keys" / "case-0002")
    runs = case.situation.runs[:2]
    effects = [catalogue.BY_NAME[name] for name in ("gain-error", "mass-error", "zero-offset")]
    sizes = [(effect, 1e-3) for effect in effects]
    told = Told.by(case, runs[:1], sizes) + Told.by(case, runs[1:], sizes)
    situation = replace(case.situation, runs=runs)
    projection = Projection.of(situation, case.campaign.known)
    shown = [situation.signature(effect, 1e-3) for effect in effects]
    library = Library.out_of(effects, shown, projection)
    p = situation.parameters
    for one in case.content.effects:
        p = one.put(p)
    there = library.units.T @ projection.left(situation.gap(p))
    scores = library.scores(library.noise(np.random.default_rng([1]))[:DRAWS] + there) / 2.0
    odds = scores[:, 1] - np.logaddexp(scores[:, 0], scores[:, 2])
    assert told.log_odds({"mass-error"}, (1,)) == pytest.approx(float(np.mean(odds)), abs=1e-5)
    classes = library.classes()
    assert told.classes() == {name: tuple(classes[name]) for name in library.names}


def test_the_generator_knows_nothing_of_the_project() -> None:
    rooms = {"pmm", "analysis", "sim", "hardware"}
    for path in [*(HERE / "generator").glob("*.py"), HERE / "board.py", HERE / "__main__.py"]:
        for node in ast.walk(ast.parse(path.read_text())):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            names += [str(node.module)] if isinstance(node, ast.ImportFrom) else []
            assert not rooms & {name.split(".")[0] for name in names}, path


def test_names_are_those_of_the_project_s_catalogue() -> None:
    from sim.effects.catalogue import catalogue as project_s

    ours = {effect.name: effect.stage for effect in catalogue.CATALOGUE}
    theirs = set(project_s())
    assert set(ours) <= theirs
    undrawn = {"campaign-drift", "drift-arrangement", "gauges-turned", "guide-friction"}
    assert theirs - set(ours) <= undrawn | {"late-gate", "vortex-shedding"}
