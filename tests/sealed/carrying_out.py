"""The proposed runs, and random ones, carried out in the sealed reality by a pool of processes."""

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np

Wanted = Sequence[tuple[str, Mapping[str, Any] | None]]
Gains = dict[str, tuple[float, float]]


def carrier(board: Path, workers: int) -> Callable[[Wanted], Gains]:
    """Return what the scorer hands the proposed runs of a row to."""
    return partial(_carried, board, workers)


def _carried(board: Path, workers: int, wanted: Wanted) -> Gains:
    jobs = [(board, case, run) for case, run in wanted]
    if workers == 1:
        return dict(map(_one, jobs))
    with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
        return dict(pool.map(_one, jobs))


def _one(job: tuple[Path, str, Mapping[str, Any] | None]) -> tuple[str, tuple[float, float]]:
    """Return what a proposed run and a random one add; the random one is the same for all rows."""
    from tests.sealed.generator.further import possible
    from tests.sealed.generator.worth import values

    board, case, run = job
    drawn = possible(board / "cases" / case / "case.toml", np.random.default_rng(_number(case)))
    runs = [drawn] if run is None else [run, drawn]
    gains = values(board / "keys" / case, runs)
    return case, (0.0 if run is None else gains[0], gains[-1])


def _number(case: str) -> list[int]:
    return [0xD1CE, *case.encode()]
