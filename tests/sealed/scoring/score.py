"""The whole board: every column of every row."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from tests.sealed.scoring.answers import Answer
from tests.sealed.scoring.board import Board, Row
from tests.sealed.scoring.columns import Entry
from tests.sealed.scoring.keys import Truth
from tests.sealed.scoring.left_out import LeftOut, left_out
from tests.sealed.scoring.rows import DETERMINABLE, RowScore, binned, row_score
from tests.sealed.scoring.shrinkage import SEEN, gap, shrunk

Gains = Mapping[str, tuple[float, float]]
CarryOut = Callable[[Sequence[tuple[str, Mapping[str, Any] | None]]], Gains]
"""Takes cases with the runs that are proposed for them, or ``None``.

Returns for each case by how much the run raises the log-odds of the true class, and by how much a
random one does.
"""


@dataclass(frozen=True)
class Score:
    """A scored board."""

    seed: str
    cases: int
    kinds: Mapping[str, int]
    rows: tuple[RowScore, ...]
    left_out: LeftOut | None
    notes: tuple[str, ...]


def score(board: Board, carry_out: CarryOut | None = None) -> Score:
    """Score all rows of a board.

    Parameters
    ----------
    carry_out
        Makes further runs in the sealed reality; without it the value of the proposed runs is left
        out.
    """
    floors = floors_of(board)
    rows = [(row, entries_of(board.truths, row, floors, carry_out)) for row in board.rows]
    scored = [(row.name, entries, binned(entries)) for row, entries in rows]
    shown = {key for _, _, bins in scored for key in bins[-1].figures}
    return Score(
        board.seed,
        len(board.truths),
        _kinds(board.truths),
        tuple(row_score(name, entries, bins, shown) for name, entries, bins in scored),
        left_out(board.truths, board.left_out),
        tuple(_notes(board, carry_out)),
    )


def floors_of(board: Board) -> list[float]:
    """Return for each case the smallest gap that any row foretells without an effect."""
    return [
        min((gap(a.before, truth) for a in answers if a.before), default=0.0)
        for truth, *answers in zip(board.truths, *(row.answers for row in board.rows), strict=True)
    ]


def entries_of(
    truths: Sequence[Truth], row: Row, floors: Sequence[float], carry_out: CarryOut | None = None
) -> list[Entry]:
    """Return a row's answers beside their keys."""
    wanted = [
        (truth.case, answer.next_run)
        for truth, answer in zip(truths, row.answers, strict=True)
        if truth.verdict == "gap" and truth.snr >= DETERMINABLE
    ]
    proposes = any(run is not None for _, run in wanted)
    gains = carry_out(wanted) if carry_out is not None and proposes else {}
    return [
        Entry(answer, truth, shrunk(answer, truth, floor), _own_share(answer, truth),
              gains.get(truth.case))
        for truth, answer, floor in zip(truths, row.answers, floors, strict=True)
    ]  # fmt: skip


def entry_of(answer: Answer, truth: Truth) -> Entry:
    """Return one answer beside its key, as of a board with no other row."""
    row = Row("", (answer,))
    floor = gap(answer.before, truth) if answer.before else 0.0
    return entries_of([truth], row, [floor])[0]


def _own_share(answer: Answer, truth: Truth) -> float | None:
    if not answer.after or gap(answer.before, truth) < SEEN:
        return None
    return 1.0 - gap(answer.after, truth) / gap(answer.before, truth)


def _kinds(truths: Sequence[Truth]) -> dict[str, int]:
    found: dict[str, int] = {}
    for truth in truths:
        found[truth.kind] = found.get(truth.kind, 0) + 1
    return dict(sorted(found.items()))


def _notes(board: Board, carry_out: CarryOut | None) -> list[str]:
    notes = []
    if carry_out is None:
        notes.append(
            "The proposed runs were not carried out: that takes the sealed generator "
            "(python -m tests.sealed score)."
        )
    silent = [row.name for row in board.rows if not any(one.after for one in row.answers)]
    if silent:
        notes.append(f"No forecast of the withheld runs by: {', '.join(silent)}.")
    if not board.left_out:
        notes.append("No answers with the right effect left out of the catalogue were given.")
    return notes
