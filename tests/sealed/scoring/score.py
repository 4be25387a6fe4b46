"""The whole board: every column of every row."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from tests.sealed.scoring.answers import Answer
from tests.sealed.scoring.board import Board, Row
from tests.sealed.scoring.columns import Entry
from tests.sealed.scoring.keys import Truth
from tests.sealed.scoring.left_out import LeftOut, left_out
from tests.sealed.scoring.rows import RowScore, binned, row_score
from tests.sealed.scoring.shrinkage import SEEN, gap, shrunk


@dataclass(frozen=True)
class Score:
    """A scored board."""

    seed: str
    cases: int
    kinds: Mapping[str, int]
    rows: tuple[RowScore, ...]
    left_out: LeftOut | None
    notes: tuple[str, ...]


def score(board: Board) -> Score:
    """Score all rows of a board."""
    floors = floors_of(board)
    rows = [(row, entries_of(board.truths, row, floors)) for row in board.rows]
    scored = [(row.name, entries, binned(entries)) for row, entries in rows]
    shown = {key for _, _, bins in scored for key in bins[-1].figures}
    return Score(
        board.seed,
        len(board.truths),
        _kinds(board.truths),
        tuple(row_score(name, entries, bins, shown) for name, entries, bins in scored),
        left_out(board.truths, board.left_out),
        tuple(_notes(board)),
    )


def floors_of(board: Board) -> list[float]:
    """Return for each case the smallest gap that any row foretells without an effect."""
    return [
        min((gap(a.before, truth) for a in answers if a.before), default=0.0)
        for truth, *answers in zip(board.truths, *(row.answers for row in board.rows), strict=True)
    ]


def entries_of(truths: Sequence[Truth], row: Row, floors: Sequence[float]) -> list[Entry]:
    """Return a row's answers beside their keys."""
    return [
        Entry(answer, truth, shrunk(answer, truth, floor), _own_share(answer, truth))
        for truth, answer, floor in zip(truths, row.answers, floors, strict=True)
    ]


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


def _notes(board: Board) -> list[str]:
    notes = []
    silent = [row.name for row in board.rows if not any(one.after for one in row.answers)]
    if silent:
        notes.append(f"No forecast of the withheld runs by: {', '.join(silent)}.")
    if not board.left_out:
        notes.append("No answers with the right effect left out of the catalogue were given.")
    return notes
