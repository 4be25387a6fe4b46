"""Answers to a board's cases, one process each at a time; a case that fails is answered as failed.

Whoever answers is given the folder of one case and nothing else. Each answer is written at once, so
that a board that was broken off goes on where it was. A cluster's workers hand answers back to be
written here: they only read.
"""

import json
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from platform import node
from typing import Any, Final

from hardware.description.errors import DataError
from pmm.parallel import as_done, open_executor, task_folder
from tests.sealed.pool import each
from tests.sealed.rows import SHARING, answered_by, missing, prepared

DIAGNOSIS: Final = "diagnosis"
LEFT_OUT: Final = "leave-one-out"
LIMIT_S: Final = 300.0


@dataclass(frozen=True)
class Asked:
    """A case, who is to answer it, and the effects that are taken out of the catalogue.

    Attributes
    ----------
    proposes
        Whether the diagnosis is to say which run it would make next.
    """

    board: Path
    case: str
    rows: tuple[str, ...]
    left_out: tuple[str, ...] = ()
    proposes: bool = True

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
    board = board.absolute()  # a cluster's workers began in another folder
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


def answers(
    asked: Sequence[Asked],
    workers: int,
    limit_s: float = LIMIT_S,
    scheduler: str | None = None,
) -> Iterator[Given]:
    """Answer, and yield what came of each case.

    Parameters
    ----------
    limit_s
        Seconds that the answers to one case may take together; after that it has failed.
    scheduler
        Address of a Dask scheduler, whose workers answer in place of processes; they know no limit.

    Raises
    ------
    DataError
        If no scheduler answers there, its workers die again and again, or one of them does not see
        a case or lacks a package. No case counts as failed for that.
    """
    for place in {one.target(row).parent for one in asked for row in one.rows}:
        place.mkdir(exist_ok=True)
    if scheduler is not None:
        yield from _on_cluster(asked, scheduler)
        return
    for done in each(answer_case, asked, workers, limit_s):
        if done.value is not None:
            yield Given(done.job.case, done.value)
            continue
        open_ones = [row for row in done.job.rows if not done.job.target(row).exists()]
        for row in open_ones:
            _write(done.job.target(row), _failure(done.job.case, done.failed))
        yield Given(done.job.case, dict.fromkeys(open_ones, done.failed))


def _on_cluster(asked: Sequence[Asked], scheduler: str) -> Iterator[Given]:
    with open_executor(scheduler=scheduler, module=__name__) as executor:
        for one, said in as_done(executor, answered_there, asked):
            for row, found in said.items():
                _write(one.target(row), found)
            yield Given(one.case, _failed(said))


def answered_there(asked: Asked) -> tuple[Asked, dict[str, dict[str, Any]]]:
    """Return a case with its answers by row, nothing written: what a cluster's worker does.

    Raises
    ------
    DataError
        If this computer does not see the case, or lacks what a row needs.
    """
    task_folder(asked.folder)
    for row in asked.rows:
        if needs := missing(row):
            raise DataError(f"{row}: {needs} is not installed on {node()} (extra peers)")
    return asked, dict(_said(asked))


def answer_case(asked: Asked) -> dict[str, str]:
    """Write a case's answers; return for each row that failed, why."""
    said = {}
    for row, found in _said(asked):
        _write(asked.target(row), found)
        said[row] = found
    return _failed(said)


def _failed(said: Mapping[str, Mapping[str, Any]]) -> dict[str, str]:
    return {row: str(found["failed"]) for row, found in said.items() if "failed" in found}


def _said(asked: Asked) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield each row with its answer as soon as there is one."""
    shared_s = None
    for row in asked.rows:
        if row in SHARING and shared_s is None:
            shared_s = _seconds_of_preparing(asked.folder)
        started = time.process_time()
        try:
            found = dict(_answer(row, asked))
        except Exception as error:  # one case must not end the board, whatever it is
            found = _failure(asked.case, f"{type(error).__name__}: {error}")
        own_s = time.process_time() - started
        found["seconds"] = round(own_s + ((shared_s or 0.0) if row in SHARING else 0.0), 3)
        yield row, found


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
        from pmm.cli.gap.answer import diagnosed
        from tests.sealed.true_forms import knowing, read_forms

        with knowing(read_forms(asked.folder)):  # the oracle's cases alone have any
            return diagnosed(asked.folder, asked.left_out, proposes=asked.proposes)
    return answered_by(row)(asked.folder)


def _failure(case: str, why: str) -> dict[str, Any]:
    return {"schema": "sealed-answer-1", "case": case, "probabilities": {}, "stages": {},
            "failed": why}  # fmt: skip


def _write(target: Path, found: Mapping[str, Any]) -> None:
    part = target.with_suffix(".part")
    part.write_text(json.dumps(found, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    part.replace(target)
