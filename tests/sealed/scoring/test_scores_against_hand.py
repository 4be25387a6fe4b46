"""Hand-made answers are scored as the page works them out."""

import json
import re
from pathlib import Path
from typing import Any

import pytest

from tests.sealed.scoring import handmade
from tests.sealed.scoring.answers import Answer
from tests.sealed.scoring.board import read_board
from tests.sealed.scoring.columns import COLUMNS, Entry
from tests.sealed.scoring.files import checked
from tests.sealed.scoring.keys import Truth
from tests.sealed.scoring.right import best_name
from tests.sealed.scoring.score import Score, score


@pytest.fixture
def found(board: Path) -> Score:
    return score(read_board(board))


def test_every_column_is_worked_out_on_the_page(found: Score) -> None:
    rows = handmade.page_table("column", "over all but the hidden")
    stated = {row["column"]: float(row["over all but the hidden"]) for row in rows}
    reached = {key: figure.value for key, figure in found.rows[0].bins[-1].figures.items()}
    assert reached == pytest.approx(stated, abs=1e-9)
    assert set(stated) == {column.key for column in COLUMNS} | {"auroc"}


def test_mean_ceiling_and_the_hidden_are_as_on_the_page(found: Score) -> None:
    row = found.rows[0]
    stated = re.search(r"mean of the columns is .*? = ([0-9.]+)\. The", handmade.PAGE.read_text())
    assert stated is not None
    assert row.mean == pytest.approx(float(stated[1]), abs=1e-9)
    by_class = row.figure("all", "top_1_by_class")
    ranked = row.figure("all", "ranked_by_class")
    hidden = row.figure("hidden", "brier")
    assert by_class is not None
    assert ranked is not None
    assert hidden is not None
    assert by_class.ceiling == pytest.approx(0.92)
    assert ranked.ceiling == by_class.ceiling
    assert hidden.value == pytest.approx(0.98)
    assert {one.key: one.cases for one in row.bins} == {
        "no_gap": 3, "coefficients": 1, "hidden": 1, "low": 1, "middle": 3, "high": 3, "all": 11,
    }  # fmt: skip


def test_a_right_name_behind_none_is_ranked_right(found: Score) -> None:
    hidden = {one.key: one for one in found.rows[0].bins}["hidden"].figures
    ranked, said = hidden["ranked_by_class"], hidden["top_1_by_class"]
    assert (ranked.value, ranked.count, ranked.ceiling) == (1.0, 1, 0.1)
    assert (said.value, said.count, said.ceiling) == (0.0, 1, 0.1)


@pytest.mark.parametrize("row", handmade.page_table("said", "best name"), ids=lambda r: r["said"])
def test_best_names_are_those_of_the_page(row: handmade.Row) -> None:
    case = next(r for r in handmade.page_table("case", "kind") if r["case"] == "case-0007")
    shares = {name: float(p) for name, p in map(str.split, row["said"].split(","))}
    said = Answer("sealed-answer-1", "case-0007", shares, {})
    truth = checked(Truth, handmade.PAGE, {**handmade.truth(case), "right": [["cable"]],
                                           "classes": {"cable": ["cable"]}})  # fmt: skip
    column = next(one for one in COLUMNS if one.key == "ranked_by_class")
    assert (best_name(said) or "") == row["best name"]
    assert list(column.values(Entry(said, truth))) == [float(row["counts"])]


def test_angles_split_what_is_outside_the_catalogue(found: Score) -> None:
    near, far = found.rows[0].angles
    assert (near.low_deg, near.unknown.value, far.low_deg, far.unknown.value) == (0, 0, 50, 1)
    assert near.auroc is not None
    assert far.auroc is not None
    assert near.auroc.value == pytest.approx(4.5 / 5)
    assert far.auroc.value == 1.0


def test_nobody_gains_by_a_larger_gap_before(board: Path) -> None:
    plain = score(read_board(board)).rows[0].figure("all", "shrinkage")
    (board / "answers").rename(board / "answers-honest")
    (board / "answers").mkdir()
    for path in (board / "answers-honest").iterdir():
        row = next(
            r for r in handmade.page_table("case", "probabilities") if r["case"] == path.stem
        )
        boasting = handmade.answer({**row, "off before": str(100.0 * float(row["off before"]))})
        (board / "answers" / path.name).write_text(json.dumps(boasting))
    boast, honest = score(read_board(board)).rows
    assert boast.figure("all", "shrinkage") == honest.figure("all", "shrinkage") == plain


def test_an_empty_column_counts_nothing_reached(board: Path) -> None:
    (board / "answers-silent").mkdir()
    for row in handmade.page_table("case", "probabilities"):
        nothing: dict[str, Any] = {
            key: {} for key in ("before", "after", "after_rival", "after_polynomial")
        }
        silent = {**handmade.answer(row), **nothing}
        path = board / "answers-silent" / f"{row['case']}.json"
        path.write_text(json.dumps(silent))
    full, silent_row = score(read_board(board)).rows
    assert silent_row.figure("all", "shrinkage") is None
    assert silent_row.mean == pytest.approx(full.mean - 0.9 / 11)


def test_controls_need_not_be_foretold(board: Path) -> None:
    for path in (board / "answers").iterdir():
        table = json.loads(path.read_text())
        del table["after_rival"], table["after_polynomial"]
        path.write_text(json.dumps(table))
    figures = score(read_board(board)).rows[0].bins[-1].figures
    assert not [key for key in figures if key.endswith(("_rival", "_polynomial"))]
    assert figures["shrinkage"].value == pytest.approx(0.9)


def test_answers_that_failed_are_wrong_everywhere(board: Path) -> None:
    for case in ("case-0001", "case-0007"):
        said = {"schema": "sealed-answer-1", "case": case, "probabilities": {}, "stages": {},
                "failed": "it took longer than it may"}  # fmt: skip
        (board / "answers" / f"{case}.json").write_text(json.dumps(said))
    figures = score(read_board(board)).rows[0].bins[-1].figures
    for row in handmade.page_table("changed", "over all but the hidden"):
        stated = float(row["over all but the hidden"])
        assert figures[row["changed"]].value == pytest.approx(stated, abs=1e-9), row["changed"]


def test_nothing_shrinks_where_an_answer_failed_and_another_row_foretells(board: Path) -> None:
    (board / "answers").rename(board / "answers-peer")
    (board / "answers").mkdir()
    for path in (board / "answers-peer").iterdir():
        said = {"schema": "sealed-answer-1", "case": path.stem, "probabilities": {}, "stages": {},
                "failed": "it took longer than it may"}  # fmt: skip
        (board / "answers" / path.name).write_text(json.dumps(said))
    figures = score(read_board(board)).rows[0].bins[-1].figures
    assert figures["shrinkage"].value == 0.0
    assert figures["gap_after"].value == figures["gap_before"].value == 10.0
