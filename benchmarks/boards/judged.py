"""One campaign through ``pmm gap``'s own functions, and whether what came out is right."""

import shutil
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final

from benchmarks.boards import friction
from benchmarks.boards.campaigns import NULLS
from benchmarks.boards.outside import FRICTION
from benchmarks.boards.where import arose
from hardware.description.errors import PmmError
from pmm.gap.examination import Options, examine
from pmm.gap.report import GapReport, gap_report

Row = dict[str, Any]
_DIGITS: Final = 4
_WHOLE: Final = Options()


def null(name: str, seed: int, options: Options = _WHOLE) -> Row:
    """Examine a campaign in which nothing is wrong, with a seed of its own."""
    with scratch() as folder:
        recipe = NULLS[name]
        row = _examined(recipe.make(folder, seed, ()), options)
    return with_outcome("nulls", {"campaign": name, "seed": seed, **row})


def planted(name: str, seed: int) -> Row:
    """Examine a campaign with friction below the dynamometers."""
    with scratch() as folder:
        made, known = friction.made(name, folder, seed)
        row = _examined(made, Options())
    rounded = {key: round(value, _DIGITS) for key, value in known.items()}
    return with_outcome("friction", {"campaign": name, "seed": seed, **rounded, **row})


def with_outcome(board: str, row: Row) -> Row:
    """Return a line with whether what is said in it is right; refusals and breakdowns stay so."""
    if "verdict" not in row:
        return row
    recipe = NULLS[row["campaign"]]
    there = [{FRICTION, *recipe.unstated}] if board == "friction" else [{*recipe.unstated}]
    is_right = {*row["answer"].split("+")} in there
    if board == "friction":
        is_right = is_right or (row["verdict"] == "effect" and FRICTION in row["stated"])
        return {**row, "outcome": "right" if is_right else "missed"}
    silent = ("none", "coefficients") if recipe.coefficients_off else ("none",)
    return {**row, "outcome": "right" if is_right or row["verdict"] in silent else "alarm"}


@contextmanager
def scratch() -> Iterator[Path]:
    """Lend a folder, in memory where the machine has such a file system."""
    memory = Path("/dev/shm")  # noqa: S108 - the folder in it is our own
    folder = Path(tempfile.mkdtemp(dir=memory if memory.is_dir() else None))
    try:
        yield folder
    finally:
        shutil.rmtree(folder)


def _examined(folder: Path, options: Options) -> Row:
    began = time.process_time()
    try:
        row = _said(gap_report(examine(folder, options)))
    except (PmmError, OSError) as error:
        row = {"outcome": "refused", "said": str(error).replace(str(folder), "...")[:300]}
    except Exception as error:  # what may never happen is counted
        row = {"outcome": "traceback", "said": arose(error)}
    return {**row, "cpu_s": round(time.process_time() - began, 2)}


def _said(report: GapReport) -> Row:
    said = report.conclusion
    share = next(iter(said.weighing.shares.values()), 0.0)  # the most probable comes first
    # A pair says of no single effect that it is the one.
    stated = {one for name in said.names for one in (name, *said.weighing.alike.get(name, ()))}
    return {
        "verdict": said.verdict,
        "answer": "+".join(said.names) or said.verdict,
        "probability": round(share, _DIGITS),
        "stated": sorted(stated) if len(said.names) == 1 else [],
    }
