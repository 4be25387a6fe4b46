"""A day of the simulated rig: whether ``pmm run`` grows, keeps handles open, or loses a sample.

``pmm run`` is a process of its own, as a user starts it, and its time is that of the simulated rig,
as fast as it goes. It is looked at whenever the gate of an oscillation opens, which is every half
hour of the rig's time, and always at the same place of a run. What it recorded is held against the
cycles at which it said that recording began and ended.
"""

import re
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
import psutil
import pyarrow as pa

from analysis.readers import read_recording
from benchmarks.machine import ROOT
from benchmarks.outcome import Benchmark, Outcome, Report, Row
from pmm.recorder.files import SAMPLES

_RIG: Final = ROOT / "examples" / "vertical" / "rig.toml"
_RATE_HZ: Final = 100.0  # of this rig
_PLAN: Final = """name = "soak"
rig = "{rig}"

[zero]
duration_s = 20.0
every = 6

[[runs]]
motion = "heave"
frequencies_hz = 0.83
amplitudes_mm = [10.0, 20.0]
periods = {periods}
repeats = {repeats}
pause_s = 5.0
"""
_PMM: Final = "from pmm.cli import main; main()"
_WARM_S: Final = 3600.0  # of the rig's time: from then on nothing may grow
_EACH: Final = 5  # looks whose median is a level
_SAID: Final = re.compile(r"\s*([\d.]+) s  (starting|gate open|done) +(\S+)")
_MEGA: Final = 1e6


@dataclass(frozen=True)
class _Look:
    """The process at a moment of the rig's time."""

    time_s: float
    resident: int
    handles: int
    threads: int


@dataclass(frozen=True)
class _Kept:
    """What a run recorded, beside how many cycles it was recording by its own word."""

    cycles: int
    samples: int
    gaps: int


class _Watched:
    """A process that carries a plan out: what it said of its runs, and how large it was."""

    def __init__(self, command: Sequence[str]) -> None:
        self.began: dict[str, float] = {}
        self.ended: dict[str, float] = {}
        self.looks: list[_Look] = []
        begun = time.monotonic()
        with subprocess.Popen(
            command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        ) as process:
            watched, said = psutil.Process(process.pid), []
            for line in process.stdout or ():
                said.append(line)
                self._take(line, watched)
        self.host_s = time.monotonic() - begun
        if process.returncode:
            raise RuntimeError("".join(said[-20:]))

    def _take(self, line: str, watched: psutil.Process) -> None:
        found = _SAID.match(line)
        if found is None:
            return
        time_s, state, run = float(found[1]), found[2], found[3]
        if state == "gate open":
            if not run.startswith("zero"):
                self.looks.append(_look(time_s, watched))
        else:
            (self.began if state == "starting" else self.ended)[run] = time_s


def _look(time_s: float, watched: psutil.Process) -> _Look:
    handles = watched.num_handles() if sys.platform == "win32" else watched.num_fds()
    return _Look(time_s, watched.memory_info().rss, handles, watched.num_threads())


def _carry_out(folder: Path, periods: int, repeats: int) -> _Watched:
    plan = folder / "plan.toml"
    text = _PLAN.format(rig=_RIG.as_posix(), periods=periods, repeats=repeats)
    plan.write_text(text, encoding="utf-8")
    words = ["run", str(plan), "--output", str(folder / "out")]
    return _Watched([sys.executable, "-c", _PMM, *words])


def _kept(folder: Path, watched: _Watched) -> Iterator[_Kept]:
    """Compare each run's journal and recording with the cycles of its own word."""
    for run, began_s in watched.began.items():
        cycles = round((watched.ended[run] - began_s) * _RATE_HZ)
        with (folder / run / SAMPLES).open("rb") as file:
            sync = pa.ipc.open_stream(file).read_all()["sync"].to_numpy()
        recording = read_recording(folder / run / "run.nc")
        whole = np.isfinite(recording.samples[:, :]).all(axis=0)
        yield _Kept(cycles, int(whole.sum()), int((np.diff(sync) != 1).sum()))


def run(quick: bool, report: Report) -> Outcome:
    """Carry out a day of half hours."""
    periods, repeats = (3, 1) if quick else (1500, 25)
    with tempfile.TemporaryDirectory() as place:
        report("pmm run")
        watched = _carry_out(Path(place), periods, repeats)
        report("reading what it recorded")
        kept = list(_kept(Path(place) / "out", watched))
    hours = max(watched.ended.values()) / 3600.0
    warm = [one for one in watched.looks if quick or one.time_s >= _WARM_S]
    levels = [statistics.median(one.resident for one in part) for part in _ends(warm)]
    counts = [(one.handles, one.threads) for one in warm]
    lost = sum(abs(one.cycles - one.samples) for one in kept)
    gaps = sum(one.gaps for one in kept)
    total: Row = {
        "runs": len(kept),
        "simulated hours": hours,
        "host minutes": watched.host_s / 60.0,
        "cycles recording": sum(one.cycles for one in kept),
        "samples recorded": sum(one.samples for one in kept),
        "gaps of SYNC": gaps,
        "grown by, MB": (levels[1] - levels[0]) / _MEGA,
        "largest look over first, MB": _over_first(warm),
    }
    measured = {
        "hours": hours,
        "growth_mb": (levels[1] - levels[0]) / _MEGA,
        "more_handles": float(max(one[0] for one in counts) - counts[0][0]),
        "more_threads": float(max(one[1] for one in counts) - counts[0][1]),
        "lost_samples": float(lost + gaps),
    }
    return Outcome({"A day": [total], "Looks": _rows(watched.looks)}, measured, _NOTES)


_NOTES: Final = (
    "`pmm run` in a process of its own on the vertical example's simulated rig at 100 Hz, as fast "
    "as it goes: heave of 0.83 Hz at rest, 1500 periods a run, a zero run after every six.",
    f"The process is looked at as each oscillation's gate opens. What it grew by is the median of "
    f"its last {_EACH} looks less that of the first {_EACH} after an hour of the rig's time.",
    "Lost are cycles between a run's starting and its end, by the process's own word, of which "
    "run.nc has no whole sample, and gaps in the SYNC numbers of its journal.",
)


def _ends(looks: list[_Look]) -> tuple[list[_Look], list[_Look]]:
    return looks[:_EACH], looks[-_EACH:]


def _over_first(looks: list[_Look]) -> float:
    return (max(one.resident for one in looks) - looks[0].resident) / _MEGA


def _rows(looks: list[_Look]) -> list[Row]:
    return [
        {
            "simulated, h": one.time_s / 3600.0,
            "resident, MB": one.resident / _MEGA,
            "handles": one.handles,
            "threads": one.threads,
        }
        for one in looks
    ]


BENCHMARK = Benchmark("soak", "A day of the simulated rig", run)
