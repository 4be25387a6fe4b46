"""The same files count once, whoever adds them, wherever they lie; what is not done is said."""

import shutil
import sqlite3
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from hardware.description.errors import DataError
from pmm.archive import database
from pmm.archive.database import open_archive
from pmm.archive.notebook import NOTES_FILE
from pmm.archive.results import (
    AnalysedCampaign,
    Analyses,
    CoefficientValue,
    GapVerdict,
    HarmonicValue,
)
from pmm.cli import cli
from tests.pmm.archive.one_folder import add_folder
from tests.pmm.coefficients.campaigns import vertical_campaign

NOW = "2026-01-01T00:00:00+00:00"
RUN = "one-0.7-20"


def analysed(_: Path) -> AnalysedCampaign:
    harmonic = HarmonicValue(RUN, 1, "force_aft", 1, "N", 1.0, 2.0, 0.1, 0.1)
    return AnalysedCampaign((harmonic,), (CoefficientValue("Z_w", "kg", 0.0, 0.7, 3.0, 0.1, 0.2),))


ALL = Analyses(analysed, lambda _: GapVerdict("none", None, None))


def _job(*words: object) -> Result:
    return CliRunner().invoke(cli, ["archive", *map(str, words)], catch_exceptions=False)


def _counts(connection: sqlite3.Connection) -> list[int]:
    tables = ("campaigns", "harmonics", "coefficients", "verdicts")
    return [connection.execute(f"SELECT count(*) FROM {one}").fetchone()[0] for one in tables]  # noqa: S608


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    vertical_campaign(tmp_path / "march", (0.7,))
    return tmp_path / "march"


def test_results_that_another_process_kept_meanwhile_are_there_once(folder: Path) -> None:
    file = folder.parent / "archive.sqlite"

    def beside(_: Path) -> AnalysedCampaign:
        with open_archive(file) as other:
            assert add_folder(other, folder, ALL, NOW).computed == ("analysis", "diagnosis")
        return analysed(folder)

    with open_archive(file, create=True) as connection:
        add_folder(connection, folder, Analyses(beside, ALL.diagnose), NOW)
        assert _counts(connection) == [1, 1, 1, 1]


def test_a_folder_that_moved_keeps_its_results_and_a_copy_is_refused(folder: Path) -> None:
    moved = folder.parent / "elsewhere" / "2025-march"
    with open_archive(folder.parent / "archive.sqlite", create=True) as connection:
        add_folder(connection, folder, ALL, NOW)
        moved.parent.mkdir()
        folder.rename(moved)
        assert add_folder(connection, moved, ALL, NOW).state == "moved"
        (row,) = connection.execute("SELECT folder, analysed, diagnosed FROM campaigns")
        assert tuple(row) == (str(moved), 1, 1)
        shutil.copytree(moved, folder)
        with pytest.raises(DataError, match=r"a copy of .*2025-march, which the archive has"):
            add_folder(connection, folder, ALL, NOW)
        assert _counts(connection) == [1, 1, 1, 1]


def test_no_note_is_written_that_the_archive_cannot_take(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = folder.parent / "archive.sqlite"
    assert _job("add", folder, "--archive", file).exit_code == 0
    monkeypatch.setattr(database, "_PATIENCE_S", 0.01)
    other = sqlite3.connect(file)
    other.execute("BEGIN IMMEDIATE")
    done = _job("note", RUN, "gauge replaced", "--archive", file)
    other.close()
    assert (done.exit_code, "database is locked" in done.stderr) == (2, True)
    assert not (folder / NOTES_FILE).exists()


def test_an_empty_file_is_no_archive_and_stays_empty(tmp_path: Path) -> None:
    (tmp_path / "empty.csv").touch()
    done = _job("list", "--archive", tmp_path / "empty.csv")
    assert (done.exit_code, "an empty file and no archive" in done.stderr) == (2, True)
    assert (tmp_path / "empty.csv").stat().st_size == 0


def test_what_is_no_campaign_is_told_in_a_sentence(tmp_path: Path) -> None:
    done = _job("add", tmp_path / "nowhere", "--archive", tmp_path / "archive.sqlite")
    assert done.exit_code == 2
    assert "no folder was added" in done.stdout
    assert "nowhere" in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize(
    ("words", "remedy"),
    [
        (("find", "coefficient = 'Z_w'"), "--coefficients"),
        (("find", "amplitude > 1"), "--channel NAME"),
        (("find", "frequency_hz > 0", "--order", "2"), "--channel NAME"),
        (("find", "gate > 0", "--channel", "force_aft", "--order", "9"), "there are: 1"),
        (("show", RUN, "--campaign", "nix"), "but of: trial"),
    ],
)
def test_a_question_that_has_no_answer_says_how_to_ask(
    folder: Path, words: tuple[str, ...], remedy: str
) -> None:
    file = folder.parent / "archive.sqlite"
    with open_archive(file, create=True) as connection:
        add_folder(connection, folder, ALL, NOW)
    done = _job(*words, "--archive", file)
    assert done.exit_code == 2
    assert remedy in " ".join(done.stderr.split())
