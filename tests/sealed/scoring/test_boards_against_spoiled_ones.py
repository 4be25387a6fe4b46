"""What is wrong with a board is named, and nothing is scored."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from hardware.description.errors import DataError
from tests.sealed.scoring.board import read_board


def _changed(**entries: Any) -> Callable[[Path], None]:
    def change(board: Path) -> None:
        path = board / "answers" / "case-0006.json"
        path.write_text(json.dumps({**json.loads(path.read_text()), **entries}))

    return change


def _copy(board: Path) -> None:
    key = board / "keys" / "case-0003" / "truth.json"
    (board / "cases" / "case-0003" / "notes.txt").write_bytes(key.read_bytes())


def _record(board: Path) -> None:
    for folder in (board / "keys" / "case-0003", board / "cases" / "case-0003"):
        (folder / "run.nc").write_bytes(b"a withheld run")


def _link(board: Path) -> None:
    (board / "cases" / "case-0003" / "more").symlink_to(board / "keys")


def _strange(board: Path) -> None:
    path = board / "answers" / "case-0001.json"
    (board / "answers" / "case-0099.json").write_text(path.read_text())


@pytest.mark.sample(7)
@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (_copy, r"notes\.txt: the key is readable"),
        (_record, r"cases/case-0003/run\.nc: the key is readable"),
        (_link, r"more: the link leads out"),
        (_strange, r"case-0099\.json: answers no case"),
        (lambda b: (b / "answers" / "case-0002.json").unlink(), "no answer to case-0002"),
        (lambda b: (b / "keys/case-0002/truth.json").unlink(), "truth.json: cannot be read"),
        (_changed(probabilities={"none": 0.5, "gain-error": 0.4}), "sum to 0.9, should be 1"),
        (_changed(probabilities={"none": 1.5, "gain-error": -0.5}), "-0.5 is no probability"),
        (_changed(probabilities={"gain-eror": 1.0}), "'gain-eror' is not known; .* 'gain-error'"),
        (_changed(probabilities={"memory+cable": 1.0}), "alphabetical order"),
        (_changed(stages={"drive": 0.2}), "stages sum to 0.2"),
        (_changed(schema="sealed-answer-2"), "'sealed-answer-2', should be 'sealed-answer-1'"),
        (_changed(case="case-0007"), "case is 'case-0007', should be 'case-0006'"),
        (_changed(failed="too slow"), "failed, and yet there are probabilities"),
        (_changed(before={}), "before and after go together"),
        (_changed(after={"withheld-1": {}}), "after.withheld-1.force_aft is missing"),
        (_changed(before={}, after={}), "after_rival stands beside after, which is missing"),
        (
            _changed(after_polynomial={"withheld-2": {}}),
            "after_polynomial.withheld-1.force_aft is missing",
        ),
        (_changed(propabilities={}), "did you mean probabilities"),
        (lambda b: (b / "answers").rename(b / "elsewhere"), "no answers yet"),
    ],
)  # fmt: skip
def test_error_is_named(board: Path, spoil: Callable[[Path], object], said: str) -> None:
    read_board(board)
    spoil(board)
    with pytest.raises(DataError, match=said):
        read_board(board)


def test_all_errors_come_at_once(board: Path) -> None:
    for number in (1, 2):
        (board / "answers" / f"case-000{number}.json").unlink()
    with pytest.raises(DataError, match="2 errors; nothing is scored"):
        read_board(board)


def test_what_was_to_be_left_out_is_not_named(board: Path) -> None:
    folder = board / "answers-leave-one-out"
    folder.mkdir()
    said = json.loads((board / "answers" / "case-0007.json").read_text())
    (folder / "case-0007.json").write_text(json.dumps(said))
    with pytest.raises(DataError, match="'coulomb-friction' is right here"):
        read_board(board)
