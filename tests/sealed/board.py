"""A whole board of sealed cases, made by a pool of processes; one that was broken off goes on."""

import shutil
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from tests.sealed.pool import each

SCHEMA = "sealed-board-1"
_MAKING = ".making"

Job = tuple[int, int, bool, Path, str]
"""Seed, index, whether it is a null, the board's folder, and the world."""


def nulls_of(seed: int, cases: int, nulls: int) -> list[bool]:
    """Return for each case whether it is a null, in an order that the seed shuffles."""
    flags = np.array([False] * cases + [True] * nulls)
    return [bool(flag) for flag in np.random.default_rng([seed, 0xB0A2D]).permutation(flags)]


def make_one(job: Job) -> str:
    """Make one case below the board's folder; return its name.

    It is made beside the others and moved to them when it is whole, its key first: what lies
    among the cases is whole.
    """
    from tests.sealed.generator.case import make
    from tests.sealed.generator.files import write

    seed, index, null, board, where = job
    case = make(seed, index, null=null, where=where)
    made = board / _MAKING / case.name
    for stale in (made, board / "keys" / case.name):
        shutil.rmtree(stale, ignore_errors=True)
    write(case, made / "cases", made / "keys")
    for room in ("keys", "cases"):
        (board / room).mkdir(exist_ok=True)
        (made / room / case.name).rename(board / room / case.name)
    shutil.rmtree(made)
    return case.name


def jobs_of(seed: int, cases: int, nulls: int, board: Path, where: str = "A") -> list[Job]:
    """Return what is still to be made of a board; its list of cases is written first.

    Raises
    ------
    FileExistsError
        If the folder holds something else: a board is never mixed with another.
    """
    flags = nulls_of(seed, cases, nulls)
    names = [f"case-{index:04d}" for index in range(1, len(flags) + 1)]
    listed = ", ".join(f'"{name}"' for name in names)
    told = "" if where == "A" else f'world = "{where}"\n'
    text = f'schema = "{SCHEMA}"\nseed = "{seed:x}"\n{told}cases = [{listed}]\n'
    file = board / "board.toml"
    if board.exists() and any(board.iterdir()) and not _same(file, text):
        raise FileExistsError(
            f"{board} is not empty and no board of this seed and size: name another"
        )
    board.mkdir(parents=True, exist_ok=True)
    file.write_text(text)
    return [
        (seed, index, null, board, where)
        for index, (name, null) in enumerate(zip(names, flags, strict=True), start=1)
        if not (board / "cases" / name).is_dir()
    ]


def _same(file: Path, text: str) -> bool:
    return file.is_file() and file.read_text() == text


def generate(jobs: list[Job], workers: int = 1) -> Iterator[str]:
    """Make what is still to be made; yield each case's name when it is there.

    Raises
    ------
    RuntimeError
        With the cases that could not be made, when all others are there.
    """
    failed = []
    for done in each(make_one, jobs, workers):
        if done.value is None:
            failed.append(f"case {done.job[1]}: {done.failed}")
        else:
            yield done.value
    if failed:
        raise RuntimeError("; ".join(failed))
    for board in {job[3] for job in jobs}:
        shutil.rmtree(board / _MAKING, ignore_errors=True)
