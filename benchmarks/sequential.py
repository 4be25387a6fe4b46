"""Campaigns that choose their runs: killed at random moments and resumed; the time of a look.

``python -m benchmarks sequential`` carries out a campaign on the simulated vertical rig without a
break, then kills others at a moment each, resumes them, and holds them against it.
"""

import json
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from shutil import copy
from typing import Any, Final

import numpy as np

from benchmarks.machine import ROOT
from benchmarks.outcome import Benchmark, Outcome, Report, Row
from pmm.design.design_file import read_design
from pmm.recorder.files import RECORDING
from pmm.recorder.line_shapes import read_marker
from pmm.recorder.run_recorder import RunEnd
from pmm.sequential.growing_plan import PLAN
from pmm.sequential.targets import TargetGoal

_KILLS: Final = 50
_PACES: Final = {"": (), "_real_time": ("--real-time",)}
_PMM: Final = (
    "import can; can.interface.BACKENDS.setdefault("
    "'pmm-simulated', ('sim.devices.bus', 'SimulatedBus')); from pmm.cli import main; main()"
)
_DESIGN: Final = """
name = "kills"
rig = "rig.toml"
[defaults]
settling_periods = 1
periods = 4
[zero]
duration_s = 2.0
every = 2
[[grid]]
motion = "heave"
frequencies_hz = [0.8, 1.0]
amplitudes_mm = [10.0, 20.0]
[[grid]]
motion = "pitch"
frequencies_hz = [0.8, 1.0]
amplitudes_mm = [10.0, 20.0]
[noise]
force_n = 0.5
repeat_relative = {repeat}
[targets]
Z_w = "3 %"
M_q = "3 %"
"""
_CALM, _QUICK = 0.006, 0.003  # what repeats differ by: runs that the targets take


@dataclass(frozen=True)
class Kill:
    """A campaign that was killed and resumed.

    Attributes
    ----------
    after_s
        From the start of the command.
    complete
        Runs that were complete when it was killed.
    same
        Whether its end is that of the campaign without a break: runs, plan, decisions, ending.
    kept
        Whether each run that was complete is as it was, byte by byte, and none was made twice.
    """

    after_s: float
    complete: int
    same: bool
    kept: bool


@dataclass(frozen=True)
class Story:
    """What makes two campaigns the same: plan, names of what is complete, decisions."""

    plan: str
    complete: tuple[str, ...]
    decisions: tuple[Any, ...]

    @classmethod
    def of(cls, folder: Path) -> "Story":
        """Return that of a campaign's folder; values measured are left out."""
        kept = json.loads((folder / "decisions.json").read_text(encoding="utf-8"))["decisions"]
        keys = ("runs", "kept", "added", "ending")
        told = tuple(str([one[key] for key in keys]) for one in kept)
        return cls((folder / PLAN).read_text(encoding="utf-8"), tuple(_complete(folder)), told)


def _complete(folder: Path) -> dict[str, bytes]:
    """Return the recordings of the runs that are complete, tries that were moved aside too."""
    found = {}
    for path in sorted(folder.glob(f"*/{RECORDING}")):
        if (read_marker(path.parent) or {}).get("outcome") == RunEnd.COMPLETE:
            found[path.parent.name] = path.read_bytes()
    return found


def _command(design: Path, folder: Path, *more: str) -> list[str]:
    words = ["run", str(design), "--until", "targets", "--approve", "all", "--output", str(folder)]
    return [sys.executable, "-c", _PMM, *words, "--json", *more]


def _whole(design: Path, folder: Path, *more: str) -> float:
    """Carry a campaign out to its end; return how long that took, in seconds."""
    started = time.monotonic()
    subprocess.run(_command(design, folder, *more), cwd=ROOT, capture_output=True, check=True)
    return time.monotonic() - started


def _killed(design: Path, folder: Path, after_s: float, whole: Story, pace: Sequence[str]) -> Kill:
    """Kill a campaign after a time, resume it and hold it against the one without a break."""
    with subprocess.Popen(
        _command(design, folder, *pace),
        cwd=ROOT,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    ) as process:
        time.sleep(after_s)
        process.send_signal(signal.SIGKILL)
    before = _complete(folder)
    _whole(design, folder, "--resume", *pace)
    after = _complete(folder)
    kept = all(after.get(name) == data for name, data in before.items())
    return Kill(after_s, len(before), Story.of(folder) == whole, kept)


def _look_s(folder: Path) -> tuple[float, int]:
    """Return the processor time of a look at the horizontal example's campaign, and its runs."""
    for one in (ROOT / "examples" / "horizontal").glob("*.toml"):
        copy(one, folder)
    design = folder / "design.toml"
    _whole(design, folder / "campaign")
    goal = TargetGoal(read_design(design), folder / "campaign")
    began = time.process_time()
    look = goal.look()
    return time.process_time() - began, len(look.runs)


def run(quick: bool, report: Report) -> Outcome:
    """Kill at seeded moments and resume; then look at a campaign of usual length."""
    moments, lengths = np.random.default_rng(1963), list[str]()
    with tempfile.TemporaryDirectory() as place:
        for one in (ROOT / "examples" / "vertical").glob("*.toml"):
            copy(one, place)
        design = Path(place) / "design.toml"
        design.write_text(_DESIGN.format(repeat=_QUICK if quick else _CALM), encoding="utf-8")
        measured: dict[str, float] = {}
        rows: dict[str, list[Row]] = {}
        for name, pace in list(_PACES.items())[: 1 if quick else None]:
            said = "in real time" if pace else "as fast as it goes"
            own = Path(place) / said.replace(" ", "-")
            own.mkdir()
            report(f"without a break, {said}")
            whole_s = _whole(design, own / "whole", *pace)
            whole = Story.of(own / "whole")
            lengths.append(f"{whole_s:.0f} s {said}")
            kills = []
            for k in range(1 if quick else _KILLS):
                report(f"kill {k + 1}, {said}")
                after_s = moments.uniform(0.0, whole_s)
                kills.append(_killed(design, own / f"kill-{k}", after_s, whole, pace))
            same = sum(one.same and one.kept for one in kills) / len(kills)
            measured |= {f"same{name}": same, f"kills{name}": len(kills)}
            rows[f"Campaigns, killed and resumed, {said}"] = list(map(_row, kills))
        if not quick:
            report("a campaign of usual length")
            own = Path(place) / "usual"
            own.mkdir()
            measured["look_s"], runs = _look_s(own)
            rows["A look in a new process"] = [{"runs": runs, "s": measured["look_s"]}]
    return Outcome(
        rows,
        measured,
        (
            f"A campaign of {len(whole.complete)} runs, zero runs among them, on the simulated "
            f"vertical rig, {' and '.join(lengths)} with the program's start; moments "
            "uniform over that. The same: plan, names of the runs that are complete, what was "
            "planned after each and the ending are those of the campaign without a break; each run "
            "that was complete when it was killed is as it was byte by byte. A look reads all "
            "recordings of the horizontal example's designed campaign and designs the rest anew, "
            "processor time of one core.",
        ),
    )


def _row(one: Kill) -> Row:
    return {
        "after, s": one.after_s,
        "runs complete": one.complete,
        "the same": "yes" if one.same else "NO",
        "runs kept": "yes" if one.kept else "NO",
    }


BENCHMARK = Benchmark("sequential", "Campaigns that choose their runs", run)
