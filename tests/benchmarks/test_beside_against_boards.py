"""What stands beside the diagnosis: kept marks against a board's own steps, and by hand."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from benchmarks.boards.beside import compared
from benchmarks.boards.row_figures import MATCHER, figures_beside, row_means, rows_beside
from benchmarks.boards.rows import jobs_of
from tests.sealed.board import generate
from tests.sealed.board import jobs_of as cases_of
from tests.sealed.oracle import answered_as, told
from tests.sealed.rows import known_rows
from tests.sealed.scoring.board import read_board
from tests.sealed.scoring.by_world import by_world
from tests.sealed.scoring.columns import COLUMNS
from tests.sealed.scoring.score import score
from tests.sealed.steps import answered, others
from tests.sealed.variations import agreements, varied

_COMMIT = "2b"  # a development seed


def _line(
    ours: float, theirs: float, alike: list[bool], *, said: float = 0.0, cut: Sequence[float] = ()
) -> dict[str, Any]:
    def mark(right: float) -> dict[str, Any]:
        values: dict[str, list[float]] = {one.key: [] for one in COLUMNS}
        values |= {"top_1_by_class": [right], "stage": [1.0]}
        return {"is_clear": True, "values": values, "stated": [0.9, right], "unknown": said}

    rows = {"diagnosis": mark(ours), "oracle": mark(theirs), "no-gap": mark(0.0)}
    kept = {"thin-2": alike, "cut": [False, False]}
    line = {"campaign": "A", "seed": 0, "rows": rows, "alike": kept, "verdict": "gap"}
    line |= {"counts": True}
    return {**line, "matched": {"top_1_by_class": 0.5, "stage": 0.75}, "cut": list(cut)}


@pytest.mark.slow
def test_figures_are_those_by_hand() -> None:
    """Class: 2 of 4 right beside the oracle's 3; thinned: 3 of 4 alike; what is cut is no part."""
    same, other = [True, True], [True, False]
    lines = [
        _line(1.0, 1.0, same), _line(0.0, 1.0, other),
        _line(0.0, 1.0, [False, False]), _line(1.0, 0.0, same),
    ]  # fmt: skip
    found = figures_beside(lines)
    assert (found["class_below_oracle"][0], found["class_below_oracle"][3]) == (0.25, 4)
    assert found["stage_below_oracle"][0] == 0.0
    assert (found["invariance_class"][0], found["invariance_class"][3]) == (0.75, 4)
    assert found["invariance_probability"][0] == 0.5
    # Class and stage are all that these lines show: (0.5 + 1) / 2 against (0 + 1) / 2.
    assert row_means(lines) == pytest.approx({"diagnosis": 0.75, "oracle": 0.875, "no-gap": 0.5})
    assert found["ahead_of_others"][0] == pytest.approx(0.25)
    assert found["ahead_of_others"][1] < 0.25 < found["ahead_of_others"][2]
    assert {"class", "false_alarms"}.isdisjoint(found)
    rows = {name: (figures, mean) for name, figures, mean in rows_beside(lines)}
    assert list(rows) == ["diagnosis", "oracle", "no-gap", MATCHER]
    assert rows["oracle"][0]["top_1_by_class"][0] == 0.75
    assert rows[MATCHER][0]["stage"][0] == 0.75
    assert rows[MATCHER][0]["unknown_or_like"][3] == 0


def test_a_cut_case_counts_where_the_oracle_is_sure_of_both() -> None:
    said = ([1.0, 0.95, 0.9], [0.0, 0.99, 0.92], [0.0, 0.5, 0.95], [1.0, 0.95, 0.2], ())
    found = figures_beside([_line(1.0, 1.0, [True, True], cut=one) for one in said])
    assert (found["invariance_cut"][0], found["invariance_cut"][3]) == (0.5, 2)


def test_nothing_is_said_of_no_lines() -> None:
    assert not any(one[3] for one in figures_beside([]).values())


def test_the_first_cases_of_all_worlds_take_turns() -> None:
    jobs = jobs_of("beside", [], None)
    assert [(one.campaign, one.first) for one in jobs[3:5]] == [("D", 0), ("A", 1)]
    assert len(jobs) == 400


@pytest.mark.slow
@pytest.mark.timeout(3000)
def test_a_line_is_what_the_steps_of_a_board_give(tmp_path: Path) -> None:
    """Oracle: the same case as a board of its own, answered and scored by the board's commands."""
    line = json.loads(json.dumps(compared("C", 0, _COMMIT, 1)))
    board = tmp_path / "board"
    list(generate(cases_of(int(_COMMIT, 16), 1, 1, board, "C")[:1]))
    whole = board / "board.toml"
    whole.write_text(whole.read_text().replace(', "case-0002"', ""))
    answered(board, 1, 600.0)
    others(board, 1, 600.0, known_rows())
    output = told(board)
    answered(output, 1, 600.0)
    answered_as(board, output)
    assert sum(1 for _ in varied(board, tmp_path / "varied", 1)) == len(line["alike"])
    answered(tmp_path / "varied", 1, 600.0)
    read = read_board(board)
    expected = {one.key: one.value for one in by_world(read, "C") if one.value is not None}
    found = figures_beside([line])
    for key in ("class_below_oracle", "stage_below_oracle", "unknown_below_oracle"):
        assert found.get(key, (None,))[0] == expected.get(key)
    assert row_means([line]) == pytest.approx({row.name: row.mean for row in score(read).rows})
    alike = {one.name: [one.same_class, one.near] for one in agreements(board, tmp_path / "varied")}
    assert line["alike"] == alike
