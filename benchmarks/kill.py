"""Kills a recording process at random moments and recovers what it leaves.

The process runs a simulated rig in real time and records it; through a pipe it says of each sample
when it was taken and what it was. So what recovery gives is held against the truth, bit by bit.
``python -m benchmarks kill`` kills a plain loop over the rig's cycle, and then ``pmm run``. One
process alone: ``python -m benchmarks.kill FOLDER SECONDS``, or ``... FOLDER PLAN.toml RUN``.
"""

import os
import signal
import struct
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any, cast

import can
import numpy as np
from numpy.typing import NDArray

from benchmarks.machine import ROOT
from benchmarks.outcome import Benchmark, Outcome, Report, Row
from hardware.description.errors import DataError

if TYPE_CHECKING:
    from hardware.roles import Shaft

_RECORD_S = 3.0  # then the run is closed
_LATEST_S = 3.5  # kills come up to then, so that some of them strike while it is closed
_LATEST_PLAN_S = 6.0
_PLAN, _RUN = "examples/vertical/plan.toml", "heave-f0.83-a20"
_RATE_HZ = 100.0
_NAME = "killed"
_SAID = struct.Struct("<qd3d")  # SYNC, wall time, shaft angle and two forces
_FIRST_WORD = b"opening\n"
_OUTPUT = 1  # where a recording process says its samples


@dataclass(frozen=True)
class Kill:
    """One kill and what was recovered.

    Attributes
    ----------
    after_s
        Seconds from the opening of the recorder to SIGKILL.
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


def tables(name: str) -> dict[str, Any]:
    """Return a rig of a shaft with its photocell and two amplifiers."""
    gauge = {"object": "9130:1", "scale": 0.01, "full_scale": 490.0}
    amplifier = {"driver": "cia404-amplifier"}
    return {
        "bus": {"interface": "pmm-simulated", "channel": name, "receive_thread": False,
                "sync_rate_hz": _RATE_HZ},
        "shaft": {"driver": "cia402-shaft", "node": 1, "counts_per_turn": 2**17,
                  "highest_frequency_hz": 2.0, "acceleration_hz_per_s": 1.0,
                  "quick_stop_hz_per_s": 5.0, "touch_probe": True},
        "forces": [{**amplifier, "node": 4, "channels": [{**gauge, "name": "force_aft"}]},
                   {**amplifier, "node": 5, "channels": [{**gauge, "name": "force_fore"}]}],
        "photocell": {"driver": "touch-probe"},
    }  # fmt: skip


def record(folder: Path, seconds: float) -> None:
    """Record a simulated rig in real time and close the run; say every sample on the output."""
    from hardware.opening import opening_of
    from hardware.pacing import FreeRunning, RealTime
    from hardware.rig import Rig
    from hardware.rig_configuration import read_rig
    from pmm.recorder.header import LiveSettings, RunHeader
    from pmm.recorder.live_path import LivePath, as_record
    from pmm.recorder.run_recorder import Outcome as RunOutcome
    from pmm.recorder.run_recorder import RunRecorder
    from sim.devices.bench_file import DRIVERS
    from sim.devices.plant import Surroundings
    from sim.devices.registry import running
    from sim.devices.world import Scene, World
    from sim.rig import vertical_rig

    can.interface.BACKENDS.setdefault("pmm-simulated", ("sim.devices.bus", "SimulatedBus"))
    described = tables(_NAME)
    configuration = read_rig(described, DRIVERS)
    world = World(configuration, Scene(vertical_rig(), Surroundings(1.2), 0.02, 0.5))
    taps: list[Any] = []
    with (
        running(_NAME, world),
        Rig(configuration, lambda: world.time_s, FreeRunning(), lambda _: None,
            observers=(lambda frame: [tap(frame) for tap in taps] and None,)) as rig,
    ):  # fmt: skip
        shaft = cast("Shaft", rig.shaft)
        rig.prepare()
        shaft.enable()
        rig.run_until(lambda: shaft.enabled, 100, "enable")
        shaft.turn(1.0)
        rig.run_until(lambda: shaft.at_speed, 500, "speed")
        _say(_FIRST_WORD)
        live, first = LiveSettings(), rig.number + 1
        path = LivePath(rig, first, live)
        header = RunHeader(
            run_name="killed", channels=path.channels, sources=path.sources, kind="oscillation",
            sample_rate_hz=_RATE_HZ, started_utc="", first_sync=first, rig_tables=described,
            opening=opening_of(rig), live=live,
        )  # fmt: skip
        rig._pacer = RealTime(1.0 / _RATE_HZ, time.monotonic, time.sleep)
        with RunRecorder(folder, header) as recorder:
            taps.append(recorder.frame)
            for _ in range(round(seconds * _RATE_HZ)):
                cycle = rig.cycle()
                taken = path.step(cycle.number)
                for number, values in taken.samples:
                    recorder.samples(number, values)
                    for i, sample in enumerate(values.T):
                        _say(_SAID.pack(number + i, time.monotonic(), *sample))
                for pulse in taken.pulses:
                    recorder.pulse(pulse)
                for reading in taken.readings:
                    recorder.harmonic(as_record(reading))
                recorder.cycle_statistics(cycle.lateness_s)
                recorder.tick(time.monotonic())
            recorder.close(RunOutcome.COMPLETE)


def carry_out(folder: Path, plan: str, run: str) -> None:
    """Carry out one run of a plan with ``pmm run`` in real time; say every sample on the output."""
    from pmm.cli import cli
    from pmm.recorder.run_recorder import RunRecorder

    keep, begin = RunRecorder.samples, RunRecorder.__init__

    def told(self: RunRecorder, first_sync: int, values: NDArray[np.float64]) -> None:
        keep(self, first_sync, values)
        for i, sample in enumerate(values[:3].T):
            _say(_SAID.pack(first_sync + i, time.monotonic(), *sample))

    def begun(self: RunRecorder, *arguments: Any, **options: Any) -> None:
        _say(_FIRST_WORD)
        begin(self, *arguments, **options)

    RunRecorder.samples, RunRecorder.__init__ = told, begun  # type: ignore[method-assign]
    words = ["run", plan, "--only", run, "--output", str(folder.parent), "--real-time"]
    cli.main(words, prog_name="pmm")


def kill_once(folder: Path, after_s: float, *what: str) -> Kill:
    """Start a recording process, kill it after a time, recover and compare.

    Parameters
    ----------
    what
        Seconds to record in a plain loop, or the plan and the run that ``pmm run`` carries out.
    """
    command = [sys.executable, "-m", "benchmarks.kill", str(folder), *what]
    with subprocess.Popen(
        command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
    ) as process:
        output = cast("IO[bytes]", process.stdout)
        if output.readline() != _FIRST_WORD:
            raise RuntimeError("the recording process ended before it began to record")
        opened = time.monotonic()
        time.sleep(after_s)
        killed = time.monotonic()
        process.send_signal(signal.SIGKILL)
        said = output.read()
    whole = len(said) // _SAID.size * _SAID.size
    return judge(folder, list(_SAID.iter_unpack(said[:whole])), killed - opened, killed)


def judge(folder: Path, said: list[Any], after_s: float, killed: float) -> Kill:
    """Recover a killed run and hold it against what its process said."""
    from analysis.readers import read_recording
    from pmm.recorder.recovery import recover

    truth = {int(one[0]): one[2:] for one in said}
    at = {int(one[0]): one[1] for one in said}
    try:
        found = recover(folder)
    except (DataError, OSError):
        # Nothing whole yet: right if nothing older than a second had been taken.
        loss_s = killed - said[0][1] if said else 0.0
        return Kill(after_s, 0, len(said), loss_s, len(said) <= _RATE_HZ, False)
    recording = read_recording(found.path)
    values = recording.samples[0:3, 0 : recording.sample_count]
    first = round(recording.start_s * _RATE_HZ)
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
    """Kill at 50 seeded moments, and ``pmm run`` at 10 more."""
    moments = np.random.default_rng(1963)
    loop, plan = [], []
    with tempfile.TemporaryDirectory() as folder:
        for k in range(2 if quick else 50):
            report(f"kill {k + 1}")
            after_s = moments.uniform(0.0, _LATEST_S)
            loop.append(kill_once(Path(folder) / f"run {k}", after_s, str(_RECORD_S)))
        for k in range(0 if quick else 10):
            report(f"kill {k + 1} of pmm run")
            after_s = moments.uniform(0.0, _LATEST_PLAN_S)
            place = Path(folder) / f"campaign {k}" / _RUN
            plan.append(kill_once(place, after_s, str(ROOT / _PLAN), _RUN))
    kills = [*loop, *plan]
    return Outcome(
        {
            "Recording processes, killed at random moments and recovered": _rows(loop),
            **({"The same, pmm run": _rows(plan)} if plan else {}),
        },
        {
            "valid": sum(one.valid for one in kills) / len(kills),
            "worst_loss_s": max(one.loss_s for one in kills),
        },
        (
            "A simulated rig in real time at 100 Hz: shaft, two amplifiers, touch probe; moments "
            f"uniform over {_LATEST_S:g} s from the recorder's opening, the run is closed after "
            f"{_RECORD_S:g} s; every recovered sample compared bit by bit with what the process "
            f"had said of it. pmm run: {_RUN} of {_PLAN}, the first {_LATEST_PLAN_S:g} s.",
        ),
    )


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


def _say(data: bytes) -> None:
    os.write(_OUTPUT, data)


BENCHMARK = Benchmark("kill", "Recordings of killed processes", run)

if __name__ == "__main__":
    _OUTPUT = os.dup(1)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # what pmm run prints is for nobody here
    if len(sys.argv) == 3:
        record(Path(sys.argv[1]), float(sys.argv[2]))
    else:
        carry_out(Path(sys.argv[1]), *sys.argv[2:])
