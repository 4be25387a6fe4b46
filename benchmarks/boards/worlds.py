"""Sealed cases of worlds A to D: each made, answered and marked by itself, and marks alone kept.

The seed of all cases is the hash of the commit whose diagnosis is measured; every line has it, and
nothing but that diagnosis adds lines to them.
"""

import subprocess
import time
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any, Final

from benchmarks.machine import MEASURED, ROOT
from tests.sealed.answering import DIAGNOSIS, Asked, answer_case
from tests.sealed.board import make_one, nulls_of
from tests.sealed.scoring.answers import read_answer
from tests.sealed.scoring.by_world import Marks, marks_of
from tests.sealed.scoring.keys import read_truth
from tests.sealed.scoring.score import entry_of

Line = dict[str, Any]

WORLDS: Final = ("A", "B", "C", "D")
CASES: Final = 300  # with something wrong, and as many nulls, in each world


def frozen(rows: Sequence[Line]) -> str:
    """Return the hash of the commit that is measured: that of the lines, else the present one.

    Raises
    ------
    SystemExit
        If what is checked out differs from it.
    """
    name = str(rows[0]["frozen"]) if rows else _git("rev-parse", "HEAD").stdout.strip()
    _check_unchanged_since(name, MEASURED)
    return name


def check_unchanged(rows: Sequence[Line]) -> None:
    """Refuse to add to lines that other code measured, the boards' own counted.

    Raises
    ------
    SystemExit
        If what is checked out differs from the commit of the first line.
    """
    name = str(rows[0]["commit"]).partition(" ")[0] if rows else "HEAD"
    _check_unchanged_since(name, (*MEASURED, "benchmarks/boards"))


def _check_unchanged_since(name: str, measured: Sequence[str]) -> None:
    if _git("diff", "--quiet", name, "--", *measured).returncode:
        raise SystemExit(
            f"the lines are of commit {name[:7]}, and what measures has changed since: go on in a "
            "work tree of that commit, with --output for the folder of these lines"
        )


def _git(*arguments: str) -> subprocess.CompletedProcess[str]:
    command = ["git", "-C", str(ROOT), *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def marked(world: str, index: int, commit: str, size: int = CASES) -> Line:
    """Make a case, have it answered without its key, and return its marks.

    Parameters
    ----------
    index
        From 0, among cases and nulls together.
    commit
        Its hash is the seed.
    """
    from benchmarks.boards.judged import scratch

    with scratch() as folder:
        name = made(world, index, commit, size, folder)
        (folder / "answers").mkdir()
        began = time.process_time()
        answer_case(Asked(folder, name, (DIAGNOSIS,), proposes=False))
        taken_s = time.process_time() - began
        truth = read_truth(folder / "keys" / name / "truth.json")
        answer = read_answer(folder / "answers" / f"{name}.json", known_effects(), truth)
        marks = marks_of(entry_of(answer, truth))
    line = {"campaign": world, "seed": index, "frozen": commit, **asdict(marks)}
    return {**line, "cpu_s": round(taken_s, 2)}


def made(world: str, index: int, commit: str, size: int, board: Path) -> str:
    """Make a case as :func:`marked` names it, with its key, on a board; return its name."""
    seed = int(commit, 16)
    return make_one((seed, index + 1, nulls_of(seed, size, size)[index], board, world))


def known_effects() -> frozenset[str]:
    """Return the names that an answer may say."""
    from sim.effects.catalogue import catalogue

    return frozenset(catalogue())


def marks_in(lines: Sequence[Line], world: str) -> dict[str, list[Marks]]:
    """Return the marks of a world's lines, as the diagnosis's row."""
    there = [one for one in lines if one["campaign"] == world]
    return {DIAGNOSIS: [Marks(one["is_clear"], one["values"], one["stated"]) for one in there]}
