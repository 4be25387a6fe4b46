"""The archive of ten thousand runs: taking folders in, conditions, trends, what changed."""

import shutil
import sqlite3
import statistics
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from benchmarks.campaign_folder import make_campaign
from benchmarks.outcome import Benchmark, Outcome, Report, Row
from pmm.archive.database import open_archive
from pmm.archive.indexing import AddedFolder, add_folders
from pmm.archive.queries import campaigns, find_coefficients, find_runs
from pmm.archive.results import AnalysedCampaign, Analyses
from pmm.archive.trends import coefficient_trends, repeat_trends
from pmm.cli.archive_analyses import analysed_folder
from pmm.parallel import InThisProcess

_RUNS, _SECONDS = 20, 20.0  # of a campaign, and of each of its runs
_TIMES = 15
_NOW = "2026-01-01T00:00:00+00:00"

Query = Callable[[sqlite3.Connection], object]
_QUERIES: dict[str, Query] = {
    "runs, by set-point": lambda db: find_runs(db, "frequency_hz > 0.55 and hull = 'h7'", None, 1),
    "runs, by time and verdict": lambda db: find_runs(
        db, "recorded_utc < '2026' and not verdict = 'effect' and eccentricity_m > 0.02", None, 1
    ),
    "runs, by a harmonic": lambda db: find_runs(db, "amplitude > 1e9", "force_aft", 1),
    "coefficients": lambda db: find_coefficients(db, "coefficient = 'Z_w' and value > 1e9"),
    "a coefficient's trend": lambda db: coefficient_trends(db, "Z_w", 0.99),
    "a run's repeats": lambda db: repeat_trends(db, *_first(db), "force_aft", 1, 0.99),
}


def run(quick: bool, report: Report) -> Outcome:
    """Analyse one campaign, copy it, take all copies in, and ask."""
    folders = 5 if quick else 500
    with tempfile.TemporaryDirectory() as name:
        place = Path(name)
        report("making a campaign")
        made = place / "made"
        made.mkdir()
        make_campaign(made, _RUNS, _SECONDS)
        began = time.process_time()
        found = analysed_folder(made)
        analysed_s = time.process_time() - began
        report("copying it")
        copies = [_copy(made, place / str(k), k) for k in range(folders)]
        size = sum(one.stat().st_size for one in copies[0].iterdir())
        bare_s = _added(place / "bare.sqlite", copies, Analyses(), report)
        stored = _scattered(found)
        full_s = _added(place / "full.sqlite", copies, stored, report)
        with open_archive(place / "full.sqlite") as connection:
            began = time.perf_counter()
            changed = sum(bool(one["changes"]) for one in campaigns(connection))
            listed_s = time.perf_counter() - began
            rows = [_asked(connection, what, one) for what, one in _QUERIES.items()]
            (harmonics,) = connection.execute("SELECT count(*) FROM harmonics").fetchone()
    runs = folders * _RUNS
    table: list[Row] = [
        {"what": f"{runs} runs in {folders} folders taken in, not analysed", "s": bare_s},
        {"what": f"the same with their {harmonics} harmonics at hand", "s": full_s},
        {"what": f"listed, with a look for changes ({changed} found)", "s": listed_s},
        {"what": f"{_RUNS} runs analysed, processor", "s": analysed_s},
    ]
    notes = (
        f"A folder has {_RUNS} recordings of {_SECONDS:g} s, 9 channels, 200 Hz: "
        f"{size / 1e6:.1f} MB. All are copies of one, whose analysis is computed once and, for the "
        "second row, scattered by 1 % and kept for each.",
        f"A query is the median of {_TIMES}, all rows fetched.",
    )
    measured = {
        "added_s": full_s,
        "query_ms": max(float(one["median, ms"]) for one in rows),
    }
    return Outcome({"Taking in": table, "Queries": rows}, measured, notes)


def _copy(made: Path, folder: Path, number: int) -> Path:
    shutil.copytree(made, folder)
    file = folder / "campaign.toml"
    head = f'model_name = "h{number % 10}"\n'
    file.write_text(head + file.read_text(encoding="utf-8"), encoding="utf-8")
    return folder


def _scattered(found: AnalysedCampaign) -> Analyses:
    def analyse(folder: Path) -> AnalysedCampaign:
        factor = 1.0 + 0.01 * ((int(folder.name) * 7919) % 101 - 50) / 50.0
        coefficients = tuple(replace(one, value=one.value * factor) for one in found.coefficients)
        return replace(found, coefficients=coefficients)

    return Analyses(analyse)


def _added(file: Path, folders: list[Path], analyses: Analyses, report: Report) -> float:
    report(f"taking {len(folders)} folders in")
    began = time.perf_counter()
    with open_archive(file, create=True) as connection:
        for outcome in add_folders(connection, folders, analyses, _NOW, InThisProcess()):
            if not isinstance(outcome, AddedFolder):
                raise outcome
    return time.perf_counter() - began


def _first(connection: sqlite3.Connection) -> tuple[str, str]:
    """Return a run and its campaign's folder."""
    run, folder = connection.execute(
        "SELECT run, folder FROM runs JOIN campaigns ON campaigns.id = runs.campaign LIMIT 1"
    ).fetchone()
    return str(run), str(folder)


def _asked(connection: sqlite3.Connection, what: str, query: Query) -> Row:
    times = []
    for _ in range(_TIMES):
        began = time.perf_counter()
        query(connection)
        times.append(1e3 * (time.perf_counter() - began))
    return {"query": what, "median, ms": statistics.median(times), "longest, ms": max(times)}


BENCHMARK = Benchmark("archive", "The archive of ten thousand runs", run)
