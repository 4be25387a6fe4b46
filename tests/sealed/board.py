"""A whole board of sealed cases, made by a pool of processes."""

from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context
from pathlib import Path

import numpy as np

SCHEMA = "sealed-board-1"


def nulls_of(seed: int, cases: int, nulls: int) -> list[bool]:
    """Return for each case whether it is a null, in an order that the seed shuffles."""
    flags = np.array([False] * cases + [True] * nulls)
    return [bool(flag) for flag in np.random.default_rng([seed, 0xB0A2D]).permutation(flags)]


def make_one(seed: int, index: int, null: bool, output: Path) -> str:
    """Make one case below ``output``; return its name."""
    from tests.sealed.generator.case import make
    from tests.sealed.generator.files import write

    case = make(seed, index, null=null)
    write(case, output / "cases", output / "keys")
    return case.name


def generate(seed: int, cases: int, nulls: int, output: Path, workers: int = 1) -> Iterator[str]:
    """Make a board; yield each case's name when it is there.

    Raises
    ------
    FileExistsError
        If ``output`` holds something already: a board is never mixed with another.
    """
    if output.exists() and any(output.iterdir()):
        raise FileExistsError(f"{output} is not empty: name another folder")
    output.mkdir(parents=True, exist_ok=True)
    flags = nulls_of(seed, cases, nulls)
    names = [f'"case-{index:04d}"' for index in range(1, len(flags) + 1)]
    text = f'schema = "{SCHEMA}"\nseed = "{seed:x}"\ncases = [{", ".join(names)}]\n'
    (output / "board.toml").write_text(text)
    jobs = [(seed, index, null, output) for index, null in enumerate(flags, start=1)]
    if workers == 1:
        yield from (make_one(*job) for job in jobs)
        return
    with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
        running = [pool.submit(make_one, *job) for job in jobs]
        for done in as_completed(running):
            yield done.result()
