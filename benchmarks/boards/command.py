"""The command line of the boards; a slice that is broken off goes on where it was."""

import argparse
import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from benchmarks.boards.rows import (
    EVERY,
    RESULTS,
    SEALED,
    SEEDED_BY,
    TRAINING,
    Job,
    Line,
    case_of,
    jobs_of,
    keep,
    kept,
    measured,
    missing,
)
from benchmarks.boards.worlds import check_unchanged, frozen
from benchmarks.machine import commit, describe
from tests.sealed.pool import each
from tests.sealed.rows import known_rows
from tests.sealed.rows import missing as missing_package

# Of one case, with all that is asked of it; what takes longer is asked again next time.
_LIMIT_S = dict.fromkeys(("loops", "beside"), 3600.0)
_USUAL_LIMIT_S = 600.0


def main(arguments: Sequence[str]) -> int:
    """Measure what is asked for and is not there yet."""
    request = _parse(arguments)
    now = commit()
    rows = kept(request.board, request.output)
    jobs = jobs_of(request.board, request.campaign, request.seeds)
    asked_of = kept(SEEDED_BY.get(request.board, ""), request.output)
    if request.board in SEALED:
        jobs = [replace(job, frozen=frozen(rows)) for job in jobs]
    if request.board in SEEDED_BY:
        _check_rows()
        check_unchanged(rows)
        common = {"frozen": _seed(request.board, asked_of), "training": request.training}
        there = {case_of(line) for line in asked_of}
        jobs = [replace(job, **common, folder=request.output) for job in jobs if job.key in there]
    todo = list(missing(jobs, rows, now if request.again else None))
    print(
        f"{request.board}: {len(jobs) - len(todo)} of {len(jobs)} there, commit {now}", flush=True
    )
    _measure(todo, request, now)
    return 0


def _check_rows() -> None:
    """Refuse to count a row as wrong for want of its package."""
    needed = sorted({package for row in known_rows() if (package := missing_package(row))})
    if needed:
        raise SystemExit(f"not installed: {', '.join(needed)} (extra peers)")


def _seed(board: str, rows: Sequence[Line]) -> str:
    """Return the commit whose hash is the seed of a board's cases."""
    if not rows:
        raise SystemExit(f"{board} answers the cases of {SEEDED_BY[board]}, which has no lines")
    return str(rows[0]["frozen"])


def _measure(todo: Sequence[Job], request: argparse.Namespace, now: str) -> None:
    began, machine = time.monotonic(), describe()["cpu"]
    if not todo:
        return
    limit_s = _LIMIT_S.get(request.board, _USUAL_LIMIT_S) if request.workers > 1 else None
    for done in each(measured, todo, request.workers, limit_s):
        if done.value is None and done.job.frozen:  # what breaks down by itself has marks
            print(done.job.campaign, done.job.first, f"asked again next time: {done.failed}")
            continue
        row = done.value or {
            "campaign": done.job.campaign,
            "seed": done.job.first,
            "outcome": "failed",
            "said": done.failed,
        }
        keep(request.board, {**row, "commit": now, "cpu": machine}, request.output)
        shown = {key: row[key] for key in ("outcome", "answer", "said", "cpu_s") if key in row}
        print(done.job.campaign, done.job.first, shown or row.get("outcomes"), flush=True)
        if request.seconds is not None and time.monotonic() - began > request.seconds:
            return


def _parse(arguments: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.boards", description=__doc__)
    parser.add_argument("board", choices=EVERY)
    parser.add_argument(
        "--campaign", action="append", default=[], metavar="NAME", help="repeatable"
    )
    parser.add_argument("--seeds", type=_span, metavar="A:B", help="from A to before B")
    parser.add_argument("--seconds", type=float, metavar="S", help="begin nothing more after that")
    parser.add_argument("--workers", type=int, default=1, metavar="N", help="processes")
    parser.add_argument(
        "--training",
        default=str(RESULTS / TRAINING),
        metavar="FILE",
        help="campaigns that rows learn from, of python -m tests.sealed.learning keep",
    )
    parser.add_argument("--again", action="store_true", help="also what another commit measured")
    parser.add_argument("--output", type=Path, default=RESULTS, metavar="FOLDER")
    return parser.parse_args(arguments)


def _span(text: str) -> tuple[int, int]:
    first, _, stop = text.partition(":")
    return int(first), int(stop)
