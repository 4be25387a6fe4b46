"""Large text files: processor time over that of Arrow's own reader, and peak memory."""

import gzip
import json
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pyarrow as pa
from pyarrow import csv

from benchmarks.machine import ROOT
from benchmarks.outcome import Benchmark, Outcome, Report, Row

CHANNELS, RATE_HZ = 16, 1000.0
_BLOCK = 1 << 22  # bytes rewritten at a time
_ROUNDS = 2


def run(quick: bool, report: Report) -> Outcome:
    """Read three files of the same numbers, each in new processes, the rivals by turns."""
    rows = 50_000 if quick else 2_000_000
    table: list[Row] = []
    ratios, peaks = [], []
    with tempfile.TemporaryDirectory() as folder:
        report("writing the files")
        for path in written(Path(folder), rows):
            found = _compared(path, report)
            ratios.append(found["ours"]["cpu_s"] / found["arrow"]["cpu_s"])
            peaks.append(found["ours"]["peak_gb"])
            size = path.stat().st_size / 1e6
            table += [_row(path.name, size, who, found) for who in ("ours", "arrow")]
    notes = (
        f"{CHANNELS} channels and time, {rows} rows. Processor time of the whole process, start "
        f"and imports included; the least of {_ROUNDS} rounds by turns. Ours is `read_recording`: "
        "also the hash of the file, the time base, spikes, missing and saturated samples.",
        "The rival is `pyarrow.csv.read_csv`, told separator and decimal sign.",
    )
    measured = {"over_arrow": max(ratios), "peak_gb": max(peaks)}
    return Outcome({"Reading text": table}, measured, notes)


def written(folder: Path, rows: int) -> list[Path]:
    """Write the same record with points, with decimal commas, and packed; return the paths."""
    point, comma, packed = (folder / name for name in ("run.csv", "comma.csv", "run.csv.gz"))
    rng = np.random.default_rng(1963)
    time = np.arange(rows) / RATE_HZ
    columns = {"time [s]": np.round(time, 3)}
    for k in range(CHANNELS):
        force = 40.0 * np.sin(2.0 * np.pi * 0.8 * time + k) + rng.normal(0.0, 0.4, rows)
        columns[f"F{k} [N]"] = np.round(force, 4)
    csv.write_csv(pa.table(columns), point)
    with point.open("rb") as plain, comma.open("wb") as other:
        while block := plain.read(_BLOCK):
            other.write(block.translate(bytes.maketrans(b",.", b";,")))
    with point.open("rb") as plain, gzip.open(packed, "wb", compresslevel=1) as file:
        shutil.copyfileobj(plain, file)
    return [point, comma, packed]


def _compared(path: Path, report: Report) -> dict[str, dict[str, float]]:
    best: dict[str, dict[str, float]] = {}
    for k in range(_ROUNDS):
        for who in ("ours", "arrow"):
            report(f"{path.name}, {who}, round {k + 1} of {_ROUNDS}")
            command = [sys.executable, "-m", "benchmarks.text_child", who, str(path)]
            done = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True)
            found = json.loads(done.stdout)
            if who not in best or found["cpu_s"] < best[who]["cpu_s"]:
                best[who] = found
    return best


def _row(name: str, size: float, who: str, found: dict[str, dict[str, float]]) -> Row:
    one = found[who]
    return {
        "file": name,
        "MB": size,
        "reader": who,
        "cpu, s": one["cpu_s"],
        "over Arrow": one["cpu_s"] / found["arrow"]["cpu_s"],
        "peak, GB": one["peak_gb"],
    }


BENCHMARK = Benchmark("text", "Text files", run)
