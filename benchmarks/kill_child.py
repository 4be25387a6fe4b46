"""Record a simulated rig in a process of its own, and say every sample on the output.

``python -m benchmarks.kill_child PACE FOLDER SECONDS``, or ``... PACE FOLDER PLAN.toml RUN``, with
``real`` or ``fast`` for PACE.
"""

import os
import struct
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Literal, TypeAlias, cast

import numpy as np
from can.interfaces import BACKENDS
from numpy.typing import NDArray

from hardware.carry_over import opening_of
from hardware.pacing import FreeRunning, RealTime
from hardware.rig import Rig
from hardware.rig_configuration import read_rig
from pmm.cli import cli
from pmm.recorder.header import LiveSettings, RunHeader
from pmm.recorder.live_path import LivePath, header_channels
from pmm.recorder.run_recorder import RunEnd as RunOutcome
from pmm.recorder.run_recorder import RunRecorder
from sim.devices.bench_file import DRIVERS
from sim.devices.parts import Scene
from sim.devices.plant import PlantConditions
from sim.devices.registry import running
from sim.devices.world import World
from sim.rig import vertical_rig

if TYPE_CHECKING:
    from hardware.roles import Shaft

Pace: TypeAlias = Literal["real", "fast"]

RATE_HZ: Final = 100.0
SAID: Final = struct.Struct("<qd3d")  # SYNC, wall time, shaft angle and two forces
FIRST_WORD: Final = b"opening\n"
_NAME: Final = "killed"
_OUTPUT = 1  # where a recording process says its samples


def tables(name: str) -> dict[str, Any]:
    """Return a rig of a shaft with its photocell and two amplifiers."""
    gauge = {"object": "9130:1", "scale": 0.01, "full_scale": 490.0}
    amplifier = {"driver": "cia404-amplifier"}
    return {
        "bus": {"interface": "pmm-simulated", "channel": name, "receive_thread": False,
                "sync_rate_hz": RATE_HZ},
        "shaft": {"driver": "cia402-shaft", "node": 1, "counts_per_turn": 2**17,
                  "highest_frequency_hz": 2.0, "acceleration_hz_per_s": 1.0,
                  "quick_stop_hz_per_s": 5.0, "touch_probe": True},
        "forces": [{**amplifier, "node": 4, "channels": [{**gauge, "name": "force_aft"}]},
                   {**amplifier, "node": 5, "channels": [{**gauge, "name": "force_fore"}]}],
        "photocell": {"driver": "touch-probe"},
    }  # fmt: skip


def record(pace: Pace, folder: Path, seconds: float) -> None:
    """Record a simulated rig and close the run; say every sample on the output."""
    BACKENDS.setdefault("pmm-simulated", ("sim.devices.bus", "SimulatedBus"))
    described = tables(_NAME)
    configuration = read_rig(described, DRIVERS)
    world = World(configuration, Scene(vertical_rig(), PlantConditions(1.2), 0.02, 0.5))
    taps: list[Any] = []

    def observe(frame: Any) -> None:
        for tap in taps:
            tap(frame)

    with (
        running(_NAME, world),
        Rig(configuration, lambda: world.time_s, FreeRunning(), lambda _: None,
            observers=(observe,)) as rig,
    ):  # fmt: skip
        shaft = cast("Shaft", rig.shaft)
        rig.prepare()
        shaft.enable()
        rig.run_until(lambda: shaft.enabled, 100, "enable")
        shaft.turn(1.0)
        rig.run_until(lambda: shaft.at_speed, 500, "speed")
        _say(FIRST_WORD)
        live, first = LiveSettings(), rig.number + 1
        path = LivePath(rig)
        header = RunHeader(
            run_name="killed", channels=header_channels(rig), kind="oscillation",
            sample_rate_hz=RATE_HZ, started_utc="", first_sync=first, rig_tables=described,
            opening=opening_of(rig), live=live,
        )  # fmt: skip
        if pace == "real":
            rig._pacer = RealTime(1.0 / RATE_HZ, time.monotonic, time.sleep)
        with RunRecorder(folder, header) as recorder:
            taps.append(recorder.frame)
            for _ in range(round(seconds * RATE_HZ)):
                cycle = rig.cycle()
                taken = path.step()
                recorder.samples(taken.first, taken.values)
                for i, sample in enumerate(taken.values.T):
                    _say(SAID.pack(taken.first + i, time.monotonic(), *sample))
                for pulse in taken.pulses:
                    recorder.pulse(pulse)
                recorder.cycle_statistics(cycle.lateness_s)
                recorder.tick(time.monotonic())
            recorder.close(RunOutcome.COMPLETE)


def carry_out(pace: Pace, folder: Path, plan: str, run: str) -> None:
    """Carry out one run of a plan with ``pmm run``; say every sample on the output."""
    keep, opening = RunRecorder.samples, [FIRST_WORD]

    def told(self: RunRecorder, first_sync: int, values: NDArray[np.float64]) -> None:
        if self.folder != folder:  # of the run that is thrown away before the rig moves
            keep(self, first_sync, values)
            return
        while opening:
            _say(opening.pop())
        keep(self, first_sync, values)
        for i, sample in enumerate(values[:3].T):
            _say(SAID.pack(first_sync + i, time.monotonic(), *sample))

    RunRecorder.samples = told  # type: ignore[method-assign]
    words = ["run", plan, "--only", run, "--output", str(folder.parent)]
    cli.main([*words, "--real-time"] if pace == "real" else words, prog_name="pmm")


def _say(data: bytes) -> None:
    os.write(_OUTPUT, data)


if __name__ == "__main__":
    _OUTPUT = os.dup(1)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # what pmm run prints is for nobody here
    paced, where = cast("Pace", sys.argv[1]), Path(sys.argv[2])
    if len(sys.argv) == 4:
        record(paced, where, float(sys.argv[3]))
    else:
        carry_out(paced, where, *sys.argv[3:])
