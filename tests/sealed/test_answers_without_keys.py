"""Whoever answers needs no keys, and says the same where they lie beside the cases."""

import json
import shutil
from pathlib import Path
from typing import Any

import pytest

from sim.effects.catalogue import catalogue
from tests.sealed.answering import DIAGNOSIS, Given, answers, still_asked
from tests.sealed.board import generate, jobs_of
from tests.sealed.controls import CONTROLS
from tests.sealed.scoring.answers import read_answer
from tests.sealed.scoring.keys import read_truth

OTHERS = ("largest-residual", *CONTROLS)
KNOWN = {"amplifier-lag", "coulomb-friction", "gain-error", "quadratic-damping", "speed-ripple"}


@pytest.fixture(scope="module")
def board(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a sealed board of one case in which nothing is: the quickest to diagnose."""
    folder = tmp_path_factory.mktemp("sealed") / "board"
    assert list(generate(jobs_of(6, 0, 1, folder))) == ["case-0001"]
    return folder


@pytest.fixture(scope="module")
def apart(board: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the same board as it is handed over: the cases and nothing else."""
    folder = tmp_path_factory.mktemp("handed") / "over"
    shutil.copytree(board / "cases", folder / "cases")
    assert (board / "keys" / "case-0001" / "truth.json").is_file()
    assert [path.name for path in folder.iterdir()] == ["cases"]
    return folder


def _answers(board: Path, rows: tuple[str, ...]) -> dict[str, Any]:
    """Answer the board's case, in a process of one thread as always; return what each row says."""
    left_out = tuple(sorted({*catalogue()} - KNOWN))
    (asked,) = still_asked(board, rows, {"case-0001": left_out})
    assert list(answers([asked], 1)) == [Given("case-0001", {})]
    said = {row: json.loads(asked.target(row).read_text()) for row in rows}
    return {row: {**one, "seconds": None} for row, one in said.items()}


@pytest.mark.slow
def test_a_board_without_keys_is_answered(board: Path, apart: Path) -> None:
    said = _answers(apart, (DIAGNOSIS, *OTHERS))
    truth = read_truth(board / "keys" / "case-0001" / "truth.json")
    path = apart / "answers" / "case-0001.json"
    assert read_answer(path, frozenset(catalogue()), truth).said == truth.verdict == "none"
    assert {row: said[row] for row in OTHERS} == _answers(board, OTHERS)
