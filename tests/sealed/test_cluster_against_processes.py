"""A board that a Dask cluster answers: the same answers, and its own troubles fail no case."""

import json
import shutil
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner, Result

from hardware.description.errors import DataError
from tests.clusters import cluster
from tests.sealed import answering
from tests.sealed.__main__ import main
from tests.sealed.answering import Asked, answered_there, still_asked
from tests.sealed.board import generate, jobs_of

ROWS = ("no-gap", "random", "largest-residual")
ONLY = tuple(word for row in ROWS for word in ("--only", row))


@pytest.fixture(scope="module")
def board(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a sealed board of one case that can be answered, and of one without recordings."""
    folder = tmp_path_factory.mktemp("sealed") / "board"
    assert list(generate(jobs_of(6, 0, 1, folder))) == ["case-0001"]
    broken = shutil.copytree(folder / "cases" / "case-0001", folder / "cases" / "case-0002")
    for path in [*broken.glob("*.nc"), *broken.glob("*.csv.gz")]:
        path.unlink()
    return folder


def _run(*words: object) -> Result:
    return CliRunner().invoke(main, [str(one) for one in words])


def _taken(board: Path) -> dict[str, Any]:
    """Return what each row says of each case, and take it away."""
    said = {}
    for path in board.glob("answers-*/*"):
        said[f"{path.parent.name}/{path.name}"] = {**json.loads(path.read_text()), "seconds": None}
        path.unlink()
    return said


@pytest.mark.slow
def test_a_cluster_answers_as_processes_do(board: Path) -> None:
    here = _run("rows", board, *ONLY, "--workers", "1")
    assert here.exit_code == 0, here.output
    alone = _taken(board)
    assert sorted(alone) == sorted(
        f"answers-{row}/{case}.json" for row in ROWS for case in ("case-0001", "case-0002")
    )
    with cluster() as address:
        there = _run("rows", board, *ONLY, "--scheduler", address)
    assert there.exit_code == 0, there.output
    assert _taken(board) == alone
    failed = [line for line in here.stderr.splitlines() if "failed" in line]
    assert len(failed) == 1
    assert failed == [line for line in there.stderr.splitlines() if "failed" in line]


def test_a_case_that_a_worker_does_not_see_has_not_failed(tmp_path: Path) -> None:
    with pytest.raises(DataError, match="case-0001: not there on"):
        answered_there(Asked(tmp_path, "case-0001", ("no-gap",)))


@pytest.mark.slow
def test_a_package_that_a_worker_lacks_has_not_failed(
    board: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(answering, "missing", lambda row: "lmfit")
    with pytest.raises(DataError, match="no-gap: lmfit is not installed on"):
        answered_there(still_asked(board, ("no-gap",))[0])


@pytest.mark.slow
def test_a_scheduler_that_is_not_there_answers_nothing(
    board: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("distributed")
    monkeypatch.setattr("pmm.cluster._TIMEOUT", "1s")
    done = _run("answer", board, "--scheduler", "tcp://127.0.0.1:9")
    assert done.exit_code == 1
    assert "--scheduler tcp://127.0.0.1:9: no Dask scheduler answers there" in done.stderr
    assert len(still_asked(board, ("diagnosis",))) == 2


@pytest.mark.parametrize(
    "words",
    [
        ("answer", "BOARD", "--workers", "2"),
        ("rows", "BOARD", "--limit", "9"),
        ("leave-out", "BOARD", "--limit", "9"),
        ("whole", "--seed", "1", "--output", "BOARD", "--docs", "BOARD", "--limit", "9"),
    ],
)
def test_a_cluster_has_no_limit_and_its_own_size(tmp_path: Path, words: tuple[str, ...]) -> None:
    given = [tmp_path if word == "BOARD" else word for word in words]
    done = _run(*given, "--scheduler", "tcp://127.0.0.1:9")
    assert done.exit_code == 2
    assert f"give --scheduler or {words[-2]}, not both" in done.stderr
    assert list(tmp_path.iterdir()) == []
