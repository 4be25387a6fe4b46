"""Answers without the right effect, worked out by hand.

Each imitator leaves SNR times the sine of its angle: for cosine 0.99 and SNR 20 that is 2.8 sigma,
which is nothing to tell them apart by; for 0.9 it is 8.7. ``docs/sealed-scoring.md`` has the table.
"""

import json
from pathlib import Path
from typing import Any

import pytest

from tests.sealed.scoring import handmade
from tests.sealed.scoring.board import read_board
from tests.sealed.scoring.left_out import LeftOut, Omitted
from tests.sealed.scoring.markdown import tabulated
from tests.sealed.scoring.score import score
from tests.sealed.scoring.tables import tables


def _key(board: Path, case: str, **entries: Any) -> None:
    path = board / "keys" / case / "truth.json"
    path.write_text(json.dumps({**json.loads(path.read_text()), **entries}))


def _answer(board: Path, case: str, **entries: Any) -> None:
    folder = board / "answers-leave-one-out"
    folder.mkdir(exist_ok=True)
    said = {"schema": "sealed-answer-1", "case": case, "probabilities": {}, "stages": {}, **entries}
    (folder / f"{case}.json").write_text(json.dumps(said))


def _scored(board: Path, shares: dict[str, float], stage: str) -> LeftOut:
    near = [{"name": "cable", "cosine": 0.99}, {"name": "memory", "cosine": 0.9}]
    _key(board, "case-0007", imitators=near)
    _answer(board, "case-0007", probabilities=shares, stages={stage: 1.0})
    found = score(read_board(board)).left_out
    assert found is not None
    return found


@pytest.mark.parametrize(
    ("shares", "stage", "unknown", "good", "sure_and_wrong"),
    [
        ({"unknown": 0.9, "memory": 0.1}, "structure", 1, 1, 0),
        ({"unknown": 0.9, "memory": 0.1}, "drive", 1, 0, 0),
        ({"cable": 0.95, "unknown": 0.05}, "structure", 0, 1, 0),
        ({"memory": 0.8, "unknown": 0.2}, "structure", 0, 0, 0),
        ({"memory": 0.95, "unknown": 0.05}, "structure", 0, 0, 1),
        ({"none": 1.0}, "structure", 0, 0, 0),
    ],
)
def test_share(
    board: Path, shares: dict[str, float], stage: str, unknown: int, good: int, sure_and_wrong: int
) -> None:
    found = _scored(board, shares, stage)
    reached = (found.unknown.value, found.good.value, found.sure_and_wrong.value)
    assert reached == (unknown, good, sure_and_wrong)


@pytest.mark.parametrize("row", handmade.page_table("what is there, SNR", "said"))
def test_what_the_imitation_angle_justifies_is_not_wrong(board: Path, row: dict[str, str]) -> None:
    near = [{"name": "cable", "cosine": float(row["said"].split()[-1])}]
    _key(board, "case-0007", snr=float(row["what is there, SNR"]), imitators=near)
    _answer(board, "case-0007", probabilities={"cable": 1.0}, stages={"structure": 1.0})
    found = score(read_board(board)).left_out
    assert found is not None
    justified = row["justified"].startswith("yes")
    assert (found.good.value, found.sure_and_wrong.value) == (justified, not justified)


def test_effects_are_counted_one_by_one_and_stand_on_the_page(board: Path) -> None:
    sure = {"probabilities": {"memory": 0.95, "unknown": 0.05}, "stages": {"structure": 1.0}}
    _answer(board, "case-0006", probabilities={"unknown": 1.0}, stages={"dynamometers": 1.0})
    _answer(board, "case-0007", **sure)
    _answer(board, "case-0012", failed="it took longer than it may")
    found = score(read_board(board))
    assert found.left_out is not None
    assert found.left_out.by_effect == (
        Omitted("coulomb-friction", 1, 0, 0, 1),
        Omitted("gain-error", 1, 1, 1, 0),
        Omitted("quadratic-damping", 1, 0, 0, 1),
    )
    assert found.left_out.sure_and_wrong.value == pytest.approx(2 / 3)
    page = "\n".join(tabulated(one) for one in tables(found))
    assert "| gain-error | 1 | 1 | 1 | 0 |" in page
    assert "| another name above 0.9 | 0.667 [0.21, 0.94] n 3 |" in page
