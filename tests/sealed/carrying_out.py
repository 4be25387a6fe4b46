"""The proposed runs, and random ones, carried out in the sealed reality by a pool of processes."""

import json
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np

from tests.sealed.pool import each
from tests.sealed.progress import told

Wanted = Sequence[tuple[str, Mapping[str, Any] | None]]
Gains = dict[str, tuple[float, float]]
Job = tuple[Path, str, Mapping[str, Any] | None]

_KEPT = ".carried-out"


def carrier(board: Path, workers: int) -> Callable[[Wanted], Gains]:
    """Return what the scorer hands the proposed runs of a row to.

    What a run was worth is kept below the board, so that a board is scored again in no time.

    Raises
    ------
    RuntimeError
        When it is called, if a run could not be carried out; all others are kept.
    """
    return partial(_carried, board, workers)


def _carried(board: Path, workers: int, wanted: Wanted) -> Gains:
    jobs = [(board, case, run) for case, run in wanted]
    todo, failed = [job for job in jobs if not _kept(job).exists()], []
    (board / _KEPT).mkdir(exist_ok=True)
    for done in told("proposed runs", len(todo), each(_one, todo, workers)):
        if done.value is None:
            failed.append(f"{done.job[1]}: {done.failed}")
        else:
            _kept(done.job).write_text(json.dumps(done.value))
    if failed:
        raise RuntimeError(f"proposed runs: {'; '.join(failed)}")
    return {job[1]: _read(job) for job in jobs}


def _kept(job: Job) -> Path:
    board, case, run = job
    digest = sha256(json.dumps(run, sort_keys=True).encode()).hexdigest()[:16]
    return board / _KEPT / f"{case}-{digest}.json"


def _read(job: Job) -> tuple[float, float]:
    proposed, drawn = json.loads(_kept(job).read_text())
    return float(proposed), float(drawn)


def _one(job: Job) -> tuple[float, float]:
    """Return what a proposed run and a random one add; the random one is the same for all rows."""
    from tests.sealed.generator.further import possible
    from tests.sealed.generator.worth import values

    board, case, run = job
    drawn = possible(board / "cases" / case / "case.toml", np.random.default_rng(_number(case)))
    runs = [drawn] if run is None else [run, drawn]
    gains = values(board / "keys" / case, runs)
    return 0.0 if run is None else gains[0], gains[-1]


def _number(case: str) -> list[int]:
    return [0xD1CE, *case.encode()]
