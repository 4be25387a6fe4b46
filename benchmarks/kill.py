"""Kills a recording process at random moments and recovers what it leaves.

The process (:mod:`benchmarks.kill_child`) runs a simulated rig and records it, in real time or as
fast as it goes; through a pipe it says of each sample when it was taken and what it was. So what
recovery gives is held against the truth, bit by bit. ``python -m benchmarks kill`` kills a plain
loop over the rig's cycle, and ``pmm run``, each in both times.
"""

import signal
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any, Final, cast

import numpy as np

from analysis.readers import read_recording
from benchmarks.kill_child import FIRST_WORD, RATE_HZ, SAID, Pace
from benchmarks.machine import ROOT
from benchmarks.outcome import Benchmark, Outcome, Report, Row
from hardware.description.errors import DataError
from pmm.recorder.recovery import recover

_RECORD_S: Final[dict[Pace, float]] = {"real": 3.0, "fast": 200.0}  # of the rig's time
_LATEST_S = 3.5  # kills come up to then, so that some of them strike while the run is closed
_LATEST_PLAN_S = 6.0
_LONGEST_LOSS_S = 1.0  # of wall time, at either pace
_RIG, _RUN = ROOT / "examples/vertical/rig.toml", "heave-f0.83-a20"
_PLAN = f"""name = "kills"
rig = "{_RIG.as_posix()}"
runs = [{{ motion = "heave", frequencies_hz = 0.83, amplitudes_mm = 20.0, periods = 400 }}]
"""  # longer than most kills wait for, at either pace
_KILLS: Final = 50  # of each way and pace


@dataclass(frozen=True)
class Kill:
    """One kill and what was recovered.

    Attributes
    ----------
    after_s
        Seconds from the opening of the recorder, of ``pmm run`` from its first sample, to SIGKILL.
    samples
        Recovered samples; 0 if there were none yet.
    lost
        Samples that were taken and not recovered.
    loss_s
        Wall time from the last recovered sample to the kill, or from the first one taken if there
        were none; 0 where nothing was lost.
    valid
        Whether every recovered sample is the true one, bit by bit, and a second recovery changes
        nothing.
    """

    after_s: float
    samples: int
    lost: int
    loss_s: float
    valid: bool
    closed: bool


def kill_once(folder: Path, after_s: float, *what: str, pace: Pace = "real") -> Kill:
    """Start a recording process, kill it after a time, recover and compare.

    Parameters
    ----------
    what
        Seconds to record in a plain loop, or the plan and the run that ``pmm run`` carries out.
    """
    command = [sys.executable, "-m", "benchmarks.kill_child", pace, str(folder), *what]
    with (
        subprocess.Popen(
            command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
        ) as process,
        ThreadPoolExecutor(1) as listener,
    ):
        output = cast("IO[bytes]", process.stdout)
        if output.readline() != FIRST_WORD:
            raise RuntimeError("the recording process ended before it began to record")
        opened = time.monotonic()
        hearing = listener.submit(output.read)  # a full pipe would hold the process up
        time.sleep(after_s)
        killed = time.monotonic()
        process.send_signal(signal.SIGKILL)
        said = hearing.result()
    if process.returncode not in {0, -signal.SIGKILL}:
        raise RuntimeError(f"the recording process had ended with {process.returncode}")
    whole = len(said) // SAID.size * SAID.size
    return judge(folder, list(SAID.iter_unpack(said[:whole])), killed - opened, killed)


def judge(folder: Path, said: list[Any], after_s: float, killed: float) -> Kill:
    """Recover a killed run and hold it against what its process said."""
    truth = {int(one[0]): one[2:] for one in said}
    at = {int(one[0]): one[1] for one in said}
    try:
        found = recover(folder)
    except (DataError, OSError):
        # Nothing whole yet: right if nothing older than a second had been taken.
        loss_s = killed - said[0][1] if said else 0.0
        return Kill(after_s, 0, len(said), loss_s, loss_s <= _LONGEST_LOSS_S, False)
    recording = read_recording(found.path)
    values = recording.samples[0:3, 0 : recording.sample_count]
    first = round(recording.start_s * RATE_HZ)
    numbers = range(first, first + recording.sample_count)
    # The very last sample may have been written and not yet said.
    true = [truth[n] for n in numbers if n in truth]
    valid = len(true) >= len(numbers) - 1 and np.array_equal(values[:, : len(true)].T, true)
    again = recover(found.path.parent)
    valid = valid and again.samples == found.samples and found.missing == 0
    closed = (folder / "complete.json").exists()
    last_s = at.get(numbers[-1], killed)
    lost = sum(n > numbers[-1] for n in truth)
    return Kill(after_s, len(numbers), lost, killed - last_s if lost else 0.0, valid, closed)


def run(quick: bool, report: Report) -> Outcome:
    """Kill at seeded moments: a plain loop and ``pmm run``, each in real and in fast time."""
    moments = np.random.default_rng(1963)
    found: dict[str, list[Kill]] = {}
    with tempfile.TemporaryDirectory() as place:
        plan = Path(place) / "plan.toml"
        plan.write_text(_PLAN, encoding="utf-8")
        for pace, record_s in list(_RECORD_S.items())[-1 if quick else 0 :]:
            ways = {
                "plain loop": (_LATEST_S, "run", (f"{record_s:g}",)),
                "pmm run": (_LATEST_PLAN_S, f"campaign/{_RUN}", (str(plan), _RUN)),
            }
            for way, (latest_s, folder, what) in ways.items():
                caption = f"{way}, {pace} time"
                found[caption] = kills = []
                for k in range(1 if quick else _KILLS):
                    report(f"{caption}: kill {k + 1}")
                    run_folder = Path(place) / caption / str(k) / folder
                    run_folder.parent.mkdir(parents=True)
                    after_s = moments.uniform(0.0, 1.0 if quick else latest_s)
                    kills.append(kill_once(run_folder, after_s, *what, pace=pace))
    every = [one for kills in found.values() for one in kills]
    return Outcome(
        {
            "Recording processes, killed at random moments and recovered": _summary(found),
            **{caption: _rows(kills) for caption, kills in found.items()},
        },
        {
            "valid": sum(one.valid for one in every) / len(every),
            "kills": len(every),
            "worst_loss_s": max(one.loss_s for one in every),
        },
        (
            "A simulated rig at 100 Hz, in real time or as fast as it goes; every recovered sample "
            "is compared bit by bit with what the process had said of it. Plain loop: shaft, two "
            f"amplifiers, touch probe; moments uniform over {_LATEST_S:g} s from the recorder's "
            f"opening, the run is closed after {_RECORD_S['real']:g} s in real time and "
            f"{_RECORD_S['fast']:g} s of the rig's in fast. pmm run: {_RUN} of the vertical "
            f"example with 400 periods, the first {_LATEST_PLAN_S:g} s from its first sample on.",
        ),
    )


def _summary(found: dict[str, list[Kill]]) -> list[Row]:
    return [
        {
            "what": caption,
            "kills": len(kills),
            "as it was": sum(one.valid for one in kills),
            "closed before": sum(one.closed for one in kills),
            "nothing written yet": sum(one.samples == 0 for one in kills),
            "samples recovered": sum(one.samples for one in kills),
            "worst loss, s": max(one.loss_s for one in kills),
        }
        for caption, kills in found.items()
    ]


def _rows(kills: list[Kill]) -> list[Row]:
    return [
        {
            "kill": k,
            "after, s": one.after_s,
            "samples": one.samples,
            "samples lost": one.lost,
            "lost, s": one.loss_s,
            "as it was": "yes" if one.valid else "NO",
            "closed before": "yes" if one.closed else "no",
        }
        for k, one in enumerate(kills, 1)
    ]


BENCHMARK = Benchmark("kill", "Recordings of killed processes", run)
