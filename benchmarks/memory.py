"""Peak memory of analysing an hour of 16 channels at 10 kHz."""

import importlib.util
import json
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from analysis.readers import write_recording
from benchmarks.machine import ROOT
from benchmarks.memory_child import CHANNELS, RATE_HZ, generated
from benchmarks.outcome import Benchmark, Outcome, Report, Row

_GIB = 2.0**30
_ROOM = 1.2  # of the data: what a file of it needs on disk


def run(quick: bool, report: Report) -> Outcome:
    """Analyse from a lazy source and from a file, each in a new process."""
    seconds = 60.0 if quick else 3600.0
    data_gib = CHANNELS * seconds * RATE_HZ * 8.0 / _GIB
    notes = [
        f"{CHANNELS} channels of {seconds / 60.0:.0f} min at 10 kHz, {data_gib:.2f} GiB of "
        "samples; `analyse` with its default settings, in a process of its own, interpreter and "
        "libraries included.",
        "The rival reads the same file into memory first; `over data` is the peak over the size of "
        "the samples.",
    ]
    report("a generated record")
    found = _child("generated", str(seconds))
    rows = [_row("samples generated when asked for", found, data_gib)]
    measured = {"generated_gib": found["peak"] / _GIB}
    with tempfile.TemporaryDirectory() as folder:
        free_gib = shutil.disk_usage(folder).free / _GIB
        if free_gib < _ROOM * data_gib:
            notes.append(f"No file was written: {free_gib:.1f} GiB free in the temporary folder.")
        else:
            report("writing the file")
            path = write_recording(generated(seconds), Path(folder) / "hour.nc")
            report("analysing the file")
            found = _child("file", str(path))
            rows.append(_row("NetCDF file", found, data_gib))
            measured["file_gib"] = found["peak"] / _GIB
            _rival(path, data_gib, rows, notes)
    return Outcome({"Peak memory": rows}, measured, tuple(notes))


def _rival(path: Path, data_gib: float, rows: list[Row], notes: list[str]) -> None:
    """Read the whole file first, where the machine has the memory."""
    if importlib.util.find_spec("psutil") is None:
        notes.append("The rival was left out: psutil, which tells the memory left, is missing.")
        return
    import psutil

    available_gib = psutil.virtual_memory().available / _GIB
    if available_gib < 2.0 * data_gib:
        notes.append(f"The rival was left out: {available_gib:.1f} GiB of memory available.")
        return
    rows.append(_row("rival: file read into memory", _child("loaded", str(path)), data_gib))


def _child(source: str, where: str) -> dict[str, float]:
    command = [sys.executable, "-m", "benchmarks.memory_child", source, where]
    done = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True)
    found: dict[str, float] = json.loads(done.stdout)
    return found


def _row(name: str, found: dict[str, float], data_gib: float) -> Row:
    return {
        "source": name,
        "periods": int(found["periods"]),
        "before, GiB": found["before"] / _GIB,
        "peak, GiB": found["peak"] / _GIB,
        "over data": found["peak"] / _GIB / data_gib,
        "time, s": found["seconds"],
    }


BENCHMARK = Benchmark("memory", "Memory", run)
