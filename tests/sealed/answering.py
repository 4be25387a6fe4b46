"""Answers to a board's cases, one process each at a time; a case that fails is answered as failed.

Whoever answers is given the folder of one case and nothing else. Each answer is written at once, so
that a board that was broken off goes on where it was.
"""

import json
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from tests.sealed.pool import each
from tests.sealed.rows import SHARING, answered_by, prepared

DIAGNOSIS: Final = "diagnosis"
LEFT_OUT: Final = "leave-one-out"
LIMIT_S: Final = 300.0


@dataclass(frozen=True)
class Asked:
    """A case, who is to answer it, and the effects that are taken out of the catalogue."""

    board: Path
    case: str
    rows: tuple[str, ...]
    left_out: tuple[str, ...] = ()

    @property
    def folder(self) -> Path:
        """What whoever answers may see."""
        return self.board / "cases" / self.case

    def target(self, row: str) -> Path:
        """Where the answer of a row goes."""
        room = "answers" if row == DIAGNOSIS else f"answers-{row}"
        return self.board / room / f"{self.case}.json"


@dataclass(frozen=True)
class Given:
    """What came of a case: for each row that failed, why."""

    case: str
    failed: Mapping[str, str]


def still_asked(
    board: Path, rows: Sequence[str], left_out: Mapping[str, Sequence[str]] | None = None
) -> list[Asked]:
    """Return what has no answer yet, in the order of the board.

    Parameters
    ----------
    left_out
        Effects to take out, by case; only these cases are asked. All of them if ``None``.
    """
    names = sorted(path.name for path in (board / "cases").iterdir())
    everything = [
        Asked(board, name, tuple(rows), tuple((left_out or {}).get(name, ())))
        for name in names
        if left_out is None or name in left_out
    ]
    open_ones = [
        Asked(one.board, one.case, tuple(row for row in one.rows if not one.target(row).exists()),
              one.left_out)
        for one in everything
    ]  # fmt: skip
    return [one for one in open_ones if one.rows]


def answers(asked: Sequence[Asked], workers: int, limit_s: float = LIMIT_S) -> Iterator[Given]:
    """Answer, and yield what came of each case.

    Parameters
    ----------
    limit_s
        Seconds that the answers to one case may take together; after that it has failed.
    """
    for place in {one.target(row).parent for one in asked for row in one.rows}:
        place.mkdir(exist_ok=True)
    for done in each(answer_case, asked, workers, limit_s):
        if done.value is not None:
            yield Given(done.job.case, done.value)
            continue
        open_ones = [row for row in done.job.rows if not done.job.target(row).exists()]
        for row in open_ones:
            _write(done.job.target(row), _failure(done.job.case, done.failed))
        yield Given(done.job.case, dict.fromkeys(open_ones, done.failed))


def answer_case(asked: Asked) -> dict[str, str]:
    """Write a case's answers; return for each row that failed, why."""
    failed, shared_s = {}, None
    for row in asked.rows:
        if row in SHARING and shared_s is None:
            shared_s = _seconds_of_preparing(asked.folder)
        started = time.process_time()
        try:
            found = dict(_answer(row, asked))
        except Exception as error:  # one case must not end the board, whatever it is
            failed[row] = f"{type(error).__name__}: {error}"
            found = _failure(asked.case, failed[row])
        own_s = time.process_time() - started
        found["seconds"] = round(own_s + ((shared_s or 0.0) if row in SHARING else 0.0), 3)
        _write(asked.target(row), found)
    return failed


def _seconds_of_preparing(case: Path) -> float:
    """Prepare what the peers share, and return its processor time; each of them counts it."""
    started = time.process_time()
    try:
        prepared(case)
    except Exception:  # each peer that shares it fails by itself, and says why
        return 0.0
    return time.process_time() - started


def _answer(row: str, asked: Asked) -> Mapping[str, Any]:
    if row in (DIAGNOSIS, LEFT_OUT):
        from pmm.cli.gap_answering import diagnosed

        return diagnosed(asked.folder, asked.left_out)
    return answered_by(row)(asked.folder)


def _failure(case: str, why: str) -> dict[str, Any]:
    return {"schema": "sealed-answer-1", "case": case, "probabilities": {}, "stages": {},
            "failed": why}  # fmt: skip


def _write(target: Path, found: Mapping[str, Any]) -> None:
    part = target.with_suffix(".part")
    part.write_text(json.dumps(found, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    part.replace(target)
