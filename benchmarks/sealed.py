"""Sealed data: what a case and a board cost, and how exact their reality is without flaws."""

import statistics
import tempfile
import time
from dataclasses import replace
from itertools import product
from pathlib import Path

import numpy as np

from benchmarks.outcome import Benchmark, Outcome, Report, Row
from tests.sealed.board import generate, jobs_of
from tests.sealed.closed_forms import HEAVE, impedance, phasors, still
from tests.sealed.generator.case import make
from tests.sealed.generator.parameters import P

_SEED = 13
_FULL = 300  # cases, and as many nulls
_WORKERS = 2


def _made(index: int, null: bool) -> Row:
    """Make one case and its recordings in memory; return what that took of a core."""
    started = time.process_time()
    case = make(_SEED, index, null=null)
    for number, run in enumerate(case.campaign.runs):
        case.recorded(run, number)
    return {
        "case": case.name,
        "kind": case.content.kind,
        "runs": len(case.campaign.runs),
        "s": time.process_time() - started,
    }


def _null_error(quick: bool) -> float:
    """Return the largest error of heave against Z_n y_n, relative, orders 1 to 3.

    Struts move as they move; a rod lends them a second harmonic, a third one is too small to tell.
    """
    largest = 0.0
    for rod_m, frequency_hz in product((0.0, 1.5), (1.2,) if quick else (0.5, 0.8, 1.2)):
        p = still()
        p[P.ROD] = rod_m
        run = replace(HEAVE, frequency_hz=frequency_hz)
        seen = phasors(p, run)
        first = abs(seen.of["force"][1])
        for order in (1, 2, 3):
            moved = seen.of["displacement_aft"][order]
            there = impedance(order, 2.0 * np.pi * frequency_hz) * moved
            if abs(there) > 1e-3 * first:
                largest = max(largest, float(abs(seen.of["force"][order] - there) / abs(there)))
    return largest


def _board(cases: int, nulls: int, workers: int) -> tuple[float, int]:
    """Make a board of so many cases and nulls; return the minutes, and how many there are."""
    with tempfile.TemporaryDirectory() as folder:
        started = time.perf_counter()
        jobs = jobs_of(_SEED, cases, nulls, Path(folder) / "board")
        made = len(list(generate(jobs, workers)))
        return (time.perf_counter() - started) / 60.0, made


def run(quick: bool, report: Report) -> Outcome:
    """Measure cases on one core, the null against theory, and a board on two cores."""
    report("the first case, which compiles")
    make(_SEED, 1, null=True)
    report("cases")
    rows = [_made(index, null) for null in (False, True) for index in range(1, 2 if quick else 13)]
    report("the null against theory")
    error = _null_error(quick)
    report("a board")
    minutes, made = _board(0, 1, 1) if quick else _board(16, 16, _WORKERS)
    whole = minutes / made * 2 * _FULL
    seconds = [float(row["s"]) for row in rows]
    return Outcome(
        {
            "Cases, their recordings in memory": rows,
            "Board": [{"cases made": made, "minutes": minutes, "300 and 300, minutes": whole}],
        },
        {"case_s": max(seconds), "null_error": error, "board_minutes": whole},
        (
            f"Median of a case {statistics.median(seconds):.2f} s of processor time; the largest "
            "one counts.",
            f"A board is made by {_WORKERS} processes, with all files, keys and ceilings; its time "
            "is by the clock and scaled to 300 cases and 300 nulls.",
        ),
    )


BENCHMARK = Benchmark("sealed", "Sealed data", run)
