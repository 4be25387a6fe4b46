"""Runs of simulated rigs, recorded as run control does it, with what truly happened beside."""

import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from itertools import count
from pathlib import Path
from typing import Any

import numpy as np

from hardware.carry_over import opening_of
from hardware.description.channels import Channel
from hardware.description.setpoint import SetPoint
from hardware.pacing import FreeRunning
from hardware.raw_log import Frame
from hardware.rig import Rig
from hardware.rig_configuration import read_rig
from hardware.roles import Pulse, Reading
from pmm.recorder.disk import DiskFullError
from pmm.recorder.header import LiveSettings, RunHeader
from pmm.recorder.live_path import (
    CycleSamples,
    GateResolver,
    LivePath,
    as_record,
    header_channels,
    sampled_devices,
)
from pmm.recorder.run_recorder import RunRecorder
from sim.devices.bench_file import DRIVERS
from sim.devices.parts import Scene
from sim.devices.plant import PlantConditions
from sim.devices.registry import running
from sim.devices.world import World
from sim.rig import vertical_rig
from tests.hardware.rigs import nobody
from tests.sim.devices.benches import WHOLE, turning

CHANNELS = (Channel("shaft_angle", "rad"), Channel("force_aft", "N", 490.0))
_NAMES = count()


def header(**more: Any) -> RunHeader:
    """A header of two channels at 100 Hz."""
    given: dict[str, Any] = {
        "run_name": "heave 1",
        "channels": CHANNELS,
        "sample_rate_hz": 100.0,
        "started_utc": "2026-11-21T12:00:00Z",
        "kind": "oscillation",
        "set_point": SetPoint(1.0, 0.02),
        "configuration_sha256": {"rig.toml": "12ab"},
        "readings": {"eccentricity": Reading(0.02, 1e-5, "encoder")},
    }
    return RunHeader(**(given | more))


def fed(recorder: RunRecorder, numbers: range, tick_s: float = 0.01) -> np.ndarray:
    """Feed a recorder what :func:`truth` says, a block of ten at a time; return the truth."""
    for first in numbers[::10]:
        recorder.samples(first, truth(range(first, min(first + 10, numbers.stop))))
        recorder.cycle_statistics(1e-4)
        recorder.frame(Frame(timestamp=first / 100.0, arbitration_id=0x181, data=[first % 256] * 8))
        recorder.line(first, "photocell", b"P,%d" % first)
        if first % 100 == 0:
            recorder.pulse(Pulse(first // 100, first / 100.0 + 0.0123))
        recorder.tick(first * tick_s)
    return truth(numbers)


def until_full(recorder: RunRecorder, begin: int = 1) -> tuple[int, DiskFullError]:
    """Record until the disk is full; return the first SYNC not taken whole, and the error."""
    for first in range(begin, 100_001, 100):
        try:
            fed(recorder, range(first, first + 100))
        except DiskFullError as error:
            return first, error
        while recorder._journal.behind:
            time.sleep(1e-4)
    raise AssertionError("the disk never filled")


def truth(numbers: range) -> np.ndarray:
    """What the two channels are at these SYNCs."""
    n = np.arange(numbers.start, numbers.stop, dtype=float)
    return np.array([n * 0.0628, np.sin(n * 0.0628) * 100.0 + 1.0 / 3.0])


@dataclass
class Session:
    """A simulated rig that lives through many runs."""

    rig: Rig
    world: World
    tables: Mapping[str, Any]
    observe: list[Callable[[Frame], None]] = field(default_factory=list)
    hear: list[Callable[[int, str, bytes], None]] = field(default_factory=list)

    def record(
        self, folder: Path, cycles: int, live: LiveSettings, *, readings: bool = True
    ) -> tuple[RunRecorder, list[CycleSamples]]:
        """Record some cycles; the recorder is not closed."""
        first = self.rig.number + 1
        rate_hz, channels = self.rig.configuration.sample_rate_hz, header_channels(self.rig)
        about = header(
            channels=channels,
            sources={c.name: one.name for one in sampled_devices(self.rig) for c in one.channels},
            first_sync=first,
            sample_rate_hz=rate_hz,
            rig_tables=self.tables,
            opening=opening_of(self.rig),
            live=live,
        )
        recorder = RunRecorder(folder, about)
        path, resolving = LivePath(self.rig), GateResolver(channels, rate_hz, live, first)
        self.observe[:], self.hear[:] = [recorder.frame], [recorder.line]
        found = []
        for _ in range(cycles):
            cycle = self.rig.cycle()
            taken = path.step()
            found.append(taken)
            recorder.samples(taken.first, taken.values)
            harmonics = resolving.push(taken)
            for pulse in taken.pulses:
                recorder.pulse(pulse)
                harmonics += (
                    resolving.resolver.pulse(pulse.time_s) if resolving.takes(pulse) else []
                )
            for reading in harmonics if readings else ():
                recorder.harmonic(as_record(reading))
            recorder.cycle_statistics(cycle.lateness_s)
            recorder.tick(cycle.time_s)
        self.observe.clear()
        self.hear.clear()
        return recorder, found


@contextmanager
def session(serial: tuple[str, ...] = (), **parts: Any) -> Iterator[Session]:
    """A whole simulated rig, its shaft turning at 1 Hz."""
    name = f"recorded-{next(_NAMES)}"
    bus = {"interface": "pmm-simulated", "channel": name, "receive_thread": False}
    tables: dict[str, Any] = {**WHOLE, **parts, "bus": bus}
    for part in serial:
        tables[part] = {**tables[part], "port": {"url": f"sim://{name}/{part}"}}
    configuration = read_rig(tables, DRIVERS)
    world = World(configuration, Scene(vertical_rig(), PlantConditions(1.2, seed=7), 0.019, 0.45))
    observe: list[Callable[[Frame], None]] = []
    hear: list[Callable[[int, str, bytes], None]] = []
    with (
        running(name, world),
        Rig(
            configuration,
            lambda: world.time_s,
            FreeRunning(),
            nobody,
            observers=(lambda frame: [each(frame) for each in observe] and None,),
            line_observers=(lambda *heard: [each(*heard) for each in hear] and None,),
        ) as rig,
    ):
        rig.prepare()
        turning(rig, 0.02, 0.5, 1.0)
        yield Session(rig, world, tables, observe, hear)
