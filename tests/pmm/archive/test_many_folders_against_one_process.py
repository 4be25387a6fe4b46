"""Many folders at once: what workers and an interruption leave, against one process to the end."""

import shutil
import sqlite3
from pathlib import Path

import pytest

from hardware.description.errors import DataError, PmmError
from pmm.archive.database import open_archive
from pmm.archive.indexing import AddedFolder, add_folders
from pmm.archive.results import AnalysedCampaign, Analyses, CoefficientValue
from pmm.parallel import InThisProcess, LocalProcesses
from tests.pmm.coefficients.campaigns import vertical_campaign

NOW = "2026-01-01T00:00:00+00:00"
COUNT = 6


def counted(folder: Path) -> AnalysedCampaign:
    """Find something that belongs to the folder alone, and leave a trace of having done so."""
    with (folder.parent / "computed").open("a", encoding="utf-8") as file:
        file.write(f"{folder.name}\n")
    if folder.name == "bad":
        raise DataError(f"{folder}: refused")
    value = float(folder.name)
    return AnalysedCampaign(
        coefficients=(CoefficientValue("Z_w", "kg", 0.0, value, value, 0.1, 0.2),)
    )


def _computed(place: Path) -> list[str]:
    return sorted((place / "computed").read_text(encoding="utf-8").split())


def _coefficients(connection: sqlite3.Connection) -> list[tuple[str, float]]:
    rows = connection.execute(
        "SELECT folder, value FROM coefficients "
        "JOIN campaigns ON campaigns.id = coefficients.campaign ORDER BY folder"
    )
    return [(Path(folder).name, value) for folder, value in rows]


@pytest.fixture
def folders(tmp_path: Path) -> list[Path]:
    """Campaigns that differ by a line of their files."""
    vertical_campaign(tmp_path / "0", (0.7,))
    for number in range(1, COUNT):
        shutil.copytree(tmp_path / "0", tmp_path / str(number))
        with (tmp_path / str(number) / "campaign.toml").open("a", encoding="utf-8") as file:
            file.write(f"# {number}\n")
    return [tmp_path / str(number) for number in range(COUNT)]


def test_who_is_interrupted_goes_on_where_it_stopped(tmp_path: Path, folders: list[Path]) -> None:
    path, wanted = tmp_path / "archive.sqlite", Analyses(counted)
    with open_archive(path, create=True) as connection:
        begun = add_folders(connection, folders, wanted, NOW, InThisProcess())
        first = [next(begun) for _ in range(2)]
        assert [one.computed for one in first if isinstance(one, AddedFolder)] == [
            ("analysis",)
        ] * 2
        begun.close()
    done = len(_computed(tmp_path))
    assert done < COUNT
    with open_archive(path) as connection:
        again = list(add_folders(connection, folders, wanted, NOW, InThisProcess()))
        assert _coefficients(connection) == [(str(k), float(k)) for k in range(COUNT)]
    assert len(again) == COUNT
    assert _computed(tmp_path) == sorted(map(str, range(COUNT)))  # each once


@pytest.mark.slow
def test_workers_leave_what_one_process_leaves_and_an_error_stops_nobody(
    tmp_path: Path, folders: list[Path]
) -> None:
    shutil.copytree(folders[0], tmp_path / "bad")
    given = [*folders[:3], tmp_path / "bad", tmp_path / "none", *folders[3:]]
    executor = LocalProcesses(2)
    try:
        with open_archive(tmp_path / "archive.sqlite", create=True) as connection:
            found = list(add_folders(connection, given, Analyses(counted), NOW, executor))
            kept = _coefficients(connection)
    finally:
        executor.shutdown()
    assert kept == [(str(k), float(k)) for k in range(COUNT)]
    refused = sorted(str(one) for one in found if isinstance(one, PmmError))
    assert [one.partition(": ")[0] for one in refused] == [
        str(tmp_path / name) for name in ("bad", "none")
    ]
