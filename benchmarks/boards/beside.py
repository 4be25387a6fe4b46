"""What stands beside the diagnosis on a world's first cases: the oracle, other rows, other records.

A case is made anew from the seed of the worlds' lines, answered by every row and again as a slower
or shorter recorder would have it; marks alone are kept, as with :mod:`benchmarks.boards.worlds`.
"""

import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np

from benchmarks.boards.worlds import known_effects, made
from tests.sealed.answering import DIAGNOSIS, Asked, answer_case
from tests.sealed.oracle import answered_as, told
from tests.sealed.rows import known_rows
from tests.sealed.scoring.answers import UNKNOWN, Answer, read_answer
from tests.sealed.scoring.board import Board, Row
from tests.sealed.scoring.by_world import (
    ORACLE,
    PAIRED,
    Figure,
    Marks,
    figures_of,
    marks_of,
    mean_figure,
)
from tests.sealed.scoring.columns import COLUMNS
from tests.sealed.scoring.intervals import auroc
from tests.sealed.scoring.keys import Truth, read_truth
from tests.sealed.scoring.rows import BINS, mean_of
from tests.sealed.scoring.score import entries_of, floors_of
from tests.sealed.variations import VARIATIONS, agreements, varied

Line = dict[str, Any]

CASES: Final = 100  # of each world: its first ones
_VARIED: Final = "varied"
_SAMPLED: Final = tuple(one.name for one in VARIATIONS if one.part == 1.0)


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
        ask(told(folder), name, (DIAGNOSIS,))
        answered_as(folder, folder / ORACLE)
        for again in varied(folder, folder / _VARIED, 1):
            ask(folder / _VARIED, again, (DIAGNOSIS,))
        truth = read_truth(folder / "keys" / name / "truth.json")
        alike = {
            one.name: [one.same_class, one.near]
            for one in agreements(folder, folder / _VARIED)
        }  # fmt: skip
        rows = dict(marks_by_row(folder, truth, (DIAGNOSIS, ORACLE, *known_rows())))
    line = {"campaign": world, "seed": index, "frozen": commit, "rows": rows, "alike": alike}
    counts = {"counts": BINS[-1].holds(truth), "verdict": truth.verdict}
    return {**line, **counts, "cpu_s": round(time.process_time() - began, 2)}


def ask(board: Path, case: str, rows: Sequence[str]) -> None:
    """Have a case answered by some rows of a board."""
    asked = Asked(board, case, tuple(rows))
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


def figures_beside(lines: Sequence[Line]) -> dict[str, Figure]:
    """Return the figures of a world's lines that take other rows, or the case again."""
    marks = {
        name: [Marks(one["is_clear"], one["values"], one["stated"]) for one in row]
        for name, row in _rows(lines).items()
        if name in (DIAGNOSIS, ORACLE)
    }
    out = {key: one for key, one in figures_of(marks).items() if key in PAIRED} if marks else {}
    alike = [line["alike"][name] for line in lines for name in _SAMPLED if name in line["alike"]]
    for at, key in enumerate(("invariance_class", "invariance_probability")):
        out[key] = mean_figure(np.array([float(one[at]) for one in alike]))
    means = row_means([line for line in lines if line["counts"]])
    others = [mean for name, mean in means.items() if name not in (DIAGNOSIS, ORACLE)]
    if others:
        ahead = means[DIAGNOSIS] - max(others)
        out["ahead_of_others"] = (ahead, ahead, ahead, len(lines))
    return out


def row_means(lines: Sequence[Line]) -> dict[str, float]:
    """Return the mean of columns of every row."""
    found = {name: _figures(lines, row) for name, row in _rows(lines).items()}
    shown = {key for row in found.values() for key in row}
    return {name: mean_of(row, shown) for name, row in found.items()}


def _rows(lines: Sequence[Line]) -> dict[str, list[Line]]:
    return {
        name: [line["rows"][name] for line in lines] for name in (lines[0]["rows"] if lines else ())
    }


def _figures(lines: Sequence[Line], row: Sequence[Line]) -> dict[str, float]:
    found = {
        one.key: one.figure([x for mark in row for x in mark["values"][one.key]]) for one in COLUMNS
    }
    verdicts = [line["verdict"] for line in lines]
    inside, outside = (
        [mark["unknown"] for mark, verdict in zip(row, verdicts, strict=True) if verdict == which]
        for which in (UNKNOWN, "gap")
    )
    found["auroc"] = auroc(inside, outside)
    return {key: figure.value for key, figure in found.items() if figure is not None}
