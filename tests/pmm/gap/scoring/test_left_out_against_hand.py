"""Answers without the right effect, worked out by hand.

Each imitator leaves SNR times the sine of its angle: for cosine 0.99 and SNR 20 that is 2.8 sigma,
which is nothing to tell them apart by; for 0.9 it is 8.7.
"""

import json
from pathlib import Path

import pytest

from pmm.gap.scoring.board import read_board
from pmm.gap.scoring.left_out import LeftOut
from pmm.gap.scoring.score import score


def _scored(board: Path, shares: dict[str, float], stage: str) -> LeftOut:
    key = board / "keys" / "case-0007" / "truth.json"
    table = json.loads(key.read_text())
    table["imitators"] = [{"name": "cable", "cosine": 0.99}, {"name": "memory", "cosine": 0.9}]
    key.write_text(json.dumps(table))
    folder = board / "answers-leave-one-out"
    folder.mkdir()
    said = {"schema": "sealed-answer-1", "case": "case-0007", "probabilities": shares,
            "stages": {stage: 1.0}}  # fmt: skip
    (folder / "case-0007.json").write_text(json.dumps(said))
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
