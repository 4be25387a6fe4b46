"""What stands beside the diagnosis on a world's first cases: the oracle, other rows, other records.

A case is made anew from the seed of the worlds' lines, answered by every row and again as a slower
or shorter recorder would have it; marks alone are kept, as with :mod:`benchmarks.boards.worlds`.
"""

import json
import shutil
import time
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

from benchmarks.boards.worlds import known_effects, made
from pmm.gap.case import CASE_FILE
from tests.sealed.answering import DIAGNOSIS, Asked, answer_case
from tests.sealed.oracle import answered_as, told
from tests.sealed.rows import known_rows
from tests.sealed.scoring.answers import UNKNOWN, Answer, read_answer
from tests.sealed.scoring.board import Board, Row
from tests.sealed.scoring.by_world import ORACLE, class_probability, marks_of
from tests.sealed.scoring.columns import COLUMNS, Entry
from tests.sealed.scoring.keys import Truth, read_truth
from tests.sealed.scoring.rows import BINS
from tests.sealed.scoring.score import entries_of, floors_of
from tests.sealed.true_forms import read_forms, write_forms
from tests.sealed.variations import (
    VARIATIONS,
    Variation,
    agreements,
    alike,
    counted,
    fits,
    varied,
    vary,
)

Line = dict[str, Any]

CASES: Final = 100  # of each world: its first ones
_VARIED: Final = "varied"
_WHOLE: Final = Variation("whole")
_CUT: Final = next(one for one in VARIATIONS if one.part < 1.0)


def compared(world: str, index: int, commit: str, size: int) -> Line:
    """Make a case, have it answered by every row and in every variation, and return the marks.

    Parameters
    ----------
    index
        From 0, among cases and nulls together.
    commit
        Its hash is the seed.
    size
        Cases with something wrong in the whole world, and as many nulls.
    """
    from benchmarks.boards.judged import scratch

    began = time.process_time()
    with scratch() as folder:
        name = made(world, index, commit, size, folder)
        ask(folder, name, (DIAGNOSIS, *known_rows()))
        _ask_oracle(folder, told(folder), name)
        answered_as(folder, folder / ORACLE)
        key = folder / "keys" / name / "truth.json"
        if counted(json.loads(key.read_text()), _WHOLE):
            for other in varied(folder, folder / _VARIED, 1):
                ask(folder / _VARIED, other, (DIAGNOSIS,), proposes=False)
        truth = read_truth(key)
        matched = _matched(_read(folder, DIAGNOSIS, truth), truth)
        both = agreements(folder, folder / _VARIED)
        again = {one.name: [one.same_class, one.near] for one in both}
        cut = _cut(folder, truth)
        rows = dict(marks_by_row(folder, truth, (DIAGNOSIS, ORACLE, *known_rows())))
    line = {"campaign": world, "seed": index, "frozen": commit, "rows": rows, "alike": again}
    line |= {"counts": BINS[-1].holds(truth), "verdict": truth.verdict}
    taken_s = round(time.process_time() - began, 2)
    return {**line, "matched": matched, "cut": cut, "cpu_s": taken_s}


def _cut(folder: Path, truth: Truth) -> list[float]:
    """Return whether a case that is cut has the class of the whole, and the oracle's probabilities.

    These are of the class that it says of the whole and of the cut case. Nothing where the case is
    too short to be cut or its SNR too low, and where an oracle has nothing to know.
    """
    whole, cut = truth.case, f"{truth.case}.{_CUT.name}"
    told_case, room = folder / ORACLE / "cases" / whole, folder / ORACLE / _VARIED
    key = json.loads((folder / "keys" / whole / "truth.json").read_text())
    if not (counted(key, _CUT) and fits(told_case, _CUT) and read_forms(told_case)):
        return []
    vary(told_case, room / "cases" / cut, _CUT)
    write_forms(key, room / "cases" / cut, _CUT)
    ask(room, cut, (DIAGNOSIS,), proposes=False)
    sure = (
        _sure(folder / f"answers-{ORACLE}" / f"{whole}.json", truth),
        _sure(room / "answers" / f"{cut}.json", replace(truth, case=cut)),
    )
    files = folder / "answers" / f"{whole}.json", folder / _VARIED / "answers" / f"{cut}.json"
    own, other = (json.loads(file.read_text()) for file in files)
    return [float(alike(own, other, key)[0]), *sure]


def _ask_oracle(board: Path, told_board: Path, case: str) -> None:
    """Answer a told case; where nothing more is told than the board's case says, as that was."""
    texts = [(one / "cases" / case / CASE_FILE).read_text() for one in (board, told_board)]
    if texts[0] != texts[1] or read_forms(told_board / "cases" / case):
        ask(told_board, case, (DIAGNOSIS,))
        return
    target = Asked(told_board, case, (DIAGNOSIS,)).target(DIAGNOSIS)
    target.parent.mkdir()
    shutil.copy(Asked(board, case, (DIAGNOSIS,)).target(DIAGNOSIS), target)


def _sure(file: Path, truth: Truth) -> float:
    """Return the probability of the class that an answer says; 0 if it failed."""
    answer = read_answer(file, known_effects(), truth)
    return 0.0 if answer.failed else class_probability(answer)


def _matched(answer: Answer, truth: Truth) -> dict[str, float]:
    """Return what the linear matcher of the key reaches in each column that the case is in."""
    entry, reached = Entry(answer, truth), truth.ceiling or {}
    columns = [one for one in COLUMNS if one.ceiling in reached and tuple(one.values(entry))]
    return {one.key: value for one in columns if (value := reached[str(one.ceiling)]) is not None}


def ask(board: Path, case: str, rows: Sequence[str], *, proposes: bool = True) -> None:
    """Have a case answered by some rows of a board; a further run is a column of these alone."""
    asked = Asked(board, case, tuple(rows), proposes=proposes)
    for row in asked.rows:
        asked.target(row).parent.mkdir(exist_ok=True)
    answer_case(asked)


def marks_by_row(folder: Path, truth: Truth, names: Sequence[str]) -> Iterator[tuple[str, Line]]:
    """Yield every row's marks, with all its columns and what it gives to "unknown"."""
    answers = {name: _read(folder, name, truth) for name in names}
    rows = tuple(Row(name, (answer,)) for name, answer in answers.items())
    board = Board(folder, "", (truth,), rows, {})
    for row in rows:
        (entry,) = entries_of([truth], row, floors_of(board))
        marks = marks_of(entry)
        yield (
            row.name,
            {
                "is_clear": marks.is_clear,
                "values": {one.key: [float(x) for x in one.values(entry)] for one in COLUMNS},
                "stated": marks.stated,
                "unknown": entry.answer.probabilities.get(UNKNOWN, 0.0),
            },
        )


def _read(folder: Path, row: str, truth: Truth) -> Answer:
    target = Asked(folder, truth.case, (row,)).target(row)
    return read_answer(target, known_effects(), truth)
