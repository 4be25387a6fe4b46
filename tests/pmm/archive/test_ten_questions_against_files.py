"""The ten questions of ``docs/archive.md``: what the archive answers, and what the files say."""

import os
import re
import shutil
from pathlib import Path

import pytest
from click.testing import CliRunner

from pmm.archive.database import open_archive
from pmm.archive.results import Analyses, GapVerdict
from pmm.cli import cli
from tests.pmm.archive.one_folder import add_folder
from tests.pmm.archive.questions import QUESTIONS, Asked, asked, spoil
from tests.pmm.coefficients.campaigns import head, pair, record, vertical_rig

PAGE = Path(__file__).parents[3] / "docs" / "archive.md"
CHANGED = "What changed or vanished since it was added?"
NOW = "2026-01-01T00:00:00+00:00"
DAYS = {"spring": 1_741_000_000, "autumn": 1_757_000_000}  # 2025-03-03 and 2025-09-04
VERDICTS = {"spring": "none", "autumn": "effect"}


def _campaign(folder: Path, seed: int, extra: str) -> None:
    """A run of heave, of a model called O'Hara."""
    rig = vertical_rig()
    folder.mkdir()
    text = 'model_name = "O\'Hara"\n' + head(rig, folder.name)
    for name, point in pair(0.9)[:1]:
        text += record(folder, rig, name, point, seed=seed, periods=4)
    (folder / "campaign.toml").write_text(text + extra, encoding="utf-8")


@pytest.fixture(scope="module")
def archive(tmp_path_factory: pytest.TempPathFactory) -> Asked:
    """Two campaigns that are analysed, and a copy of the first that is not; others each way."""
    place = tmp_path_factory.mktemp("tank")
    file = place / "archive.sqlite"
    slow = '\n[[runs]]\nname = "slow"\nfrequency_hz = 0.4\neccentricity_mm = 20.0\n'
    _campaign(place / "spring", 1, f'{slow}outcome = "stopped"\n')
    _campaign(place / "autumn", 2, slow)
    shutil.copytree(place / "spring", place / "winter")
    (place / "winter" / "one-0.9-20.nc").unlink()
    for name, day in DAYS.items():
        for path in (place / name).iterdir():
            os.utime(path, (day, day))
    folders = [place / name for name in ("autumn", "spring", "winter")]
    with open_archive(file, create=True) as connection:
        for folder in folders:
            verdict = GapVerdict(VERDICTS.get(folder.name, ""), None, None)
            known = Analyses(None, lambda _, one=verdict: one)
            add_folder(connection, folder, known if verdict.verdict else Analyses(), NOW)
    words = ["--analyse", "--archive", str(file)]
    done = CliRunner().invoke(cli, ["archive", "add", *map(str, folders[:2]), *words])
    assert done.exit_code == 0, done.output
    note = ["one-0.9-20", "Ü 3 N off", "--campaign", str(folders[2]), "--archive", str(file)]
    assert CliRunner().invoke(cli, ["archive", "note", *note]).exit_code == 0
    verdicts = {place / name: one for name, one in VERDICTS.items()}
    return asked(file, folders, folders[:2], verdicts)


@pytest.mark.parametrize("question", QUESTIONS)
def test_a_question_is_answered_as_the_files_say(question: str, archive: Asked) -> None:
    found, wanted = QUESTIONS[question](archive)
    assert sorted(map(str, found)) == sorted(map(str, wanted))
    assert bool(wanted) == (question != CHANGED)


def test_what_was_changed_by_hand_is_said(archive: Asked) -> None:
    """Last in this file: the folders are not what they were after it."""
    spoil(archive)
    found, wanted = QUESTIONS[CHANGED](archive)
    assert sorted(map(str, found)) == sorted(map(str, wanted))
    assert len(wanted) == len(archive.folders)


def test_the_page_has_these_questions() -> None:
    table = PAGE.read_text(encoding="utf-8").split("## Ten questions")[1].split("\n## ")[0]
    assert re.findall(r"^\| ([^|]+\?) \| `pmm archive ", table, re.MULTILINE) == list(QUESTIONS)
