"""Speed of run control: controller, recorder, live resolver and simulated rig in one process."""

import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

from can.interfaces import BACKENDS

from analysis.readers import read_recording
from benchmarks.devices import tables
from benchmarks.outcome import Benchmark, Outcome, Report, Row
from hardware.description.kinds import Motion, RunKind
from hardware.description.oscillator import VERTICAL_1963
from hardware.description.setpoint import SetPoint
from hardware.pacing import FreeRunning, Pacer, RealTime
from hardware.rig import Rig
from hardware.rig_configuration import read_rig
from pmm.plan.plan import Plan
from pmm.plan.rig_file import RigFile
from pmm.plan.run_plan import RunPlan
from pmm.run.journal import Taps
from pmm.run.recorder_factory import RecorderFactory
from pmm.run.run_control import RunControl
from pmm.run.states import Command, State
from pmm.run.view import View
from sim.devices.bench_file import DRIVERS
from sim.devices.parts import Scene
from sim.devices.plant import PlantConditions
from sim.devices.registry import running
from sim.devices.world import World
from sim.rig import vertical_rig

_NAME = "run control"
_E_M, _PHASE_RAD, _FREQUENCY_HZ = 0.02, 0.5, 1.0


@dataclass(frozen=True)
class _Run:
    """What the gate of a run cost, and what its recording lacks."""

    seconds: float
    cpu_s: float
    simulated_s: float
    cycles: int
    lost: int
    latest_ms: float
    p99_ms: float


class _Watching:
    """A view that looks ten times a second, as the terminal's does four times."""

    def __init__(self) -> None:
        self._due_s = 0.0

    def show(self, control: RunControl) -> None:
        """Take a status when it is time."""
        now_s = time.monotonic()
        if now_s >= self._due_s:
            self._due_s = now_s + 0.1
            control.status()


@contextmanager
def _control(
    rate_hz: float, periods: int, folder: Path, view: View[RunControl]
) -> Iterator[RunControl]:
    BACKENDS.setdefault("pmm-simulated", ("sim.devices.bus", "SimulatedBus"))
    whole = tables(rate_hz)
    whole["bus"] = {**whole["bus"], "channel": _NAME}
    configuration = read_rig(whole, DRIVERS)
    around = PlantConditions(carriage_speed_m_s=1.2)
    world = World(configuration, Scene(vertical_rig(), around, _E_M, _PHASE_RAD))
    point = SetPoint(_FREQUENCY_HZ, _E_M, _PHASE_RAD)
    run = RunPlan(
        "run", RunKind.OSCILLATION, Motion.PHASE, point, periods=periods, max_periods=periods
    )
    no_file = Path()
    rig_file = RigFile(
        path=no_file,
        sha256="",
        oscillator=VERTICAL_1963,
        hardware=configuration,
        hardware_tables=MappingProxyType(whole),
    )
    plan = Plan("benchmark", no_file, no_file, (run,), "", "")
    taps = Taps()
    with (
        running(_NAME, world),
        Rig(
            configuration, time.monotonic, FreeRunning(), lambda _: None, observers=(taps.frame,)
        ) as rig,
    ):
        rig.prepare()
        recording = RecorderFactory(rig, rig_file, plan, folder, lambda: "", taps)
        control = RunControl(rig, rig_file, plan.runs, recording.begin, time.monotonic, view)
        control.request(Command.START)
        yield control


def _measure(rate_hz: float, periods: int, pacer: Pacer) -> _Run:
    """Time a gate, with everything that goes on in it; the closing of the recording beside it."""
    with (
        tempfile.TemporaryDirectory() as folder,
        _control(rate_hz, periods, Path(folder), _Watching()) as control,
    ):
        _until(control, State.GATE_OPEN)
        control.rig._pacer = pacer  # brought to speed free-running, measured as asked for
        first = control.rig.number
        begun, used = time.perf_counter(), time.process_time()
        _until(control, State.HOLD)
        seconds, cpu_s = time.perf_counter() - begun, time.process_time() - used
        cycles = control.rig.number - first
        control.rig._pacer = FreeRunning()
        while not control.finished:
            control.step()
        (outcome,) = control.outcomes
        late = outcome.statistics
        recording = read_recording(outcome.file)
        lost = _missing(recording)
        worst, p99 = (1e3 * late.worst_s, 1e3 * late.p99_s) if late else (0.0, 0.0)
        return _Run(seconds, cpu_s, cycles / rate_hz, cycles, lost, worst, p99)


def _until(control: RunControl, state: State) -> None:
    while control.state is not state:
        control.step()
        if control.fault is not None:
            raise control.fault


def _missing(recording: Any) -> int:
    import numpy as np

    names = recording.channel_names
    return int(sum(np.isnan(recording.values(name)).sum() for name in names))


def run(quick: bool, report: Report) -> Outcome:
    """Measure free-running at 100 Hz and in real time at 200 Hz."""
    report("free-running")
    rounds, periods = (1, 3) if quick else (5, 120)
    free = [_measure(100.0, periods, FreeRunning()) for _ in range(rounds)]
    report("real time")
    paced = _measure(200.0, 1 if quick else 20, RealTime(1.0 / 200.0, time.monotonic, time.sleep))
    best = max(free, key=lambda one: one.simulated_s / one.seconds)
    everything = [*free, paced]
    rows: list[Row] = [
        {
            "run": "real time, 200 Hz" if one is paced else "free-running, 100 Hz",
            "simulated s": one.simulated_s,
            "host s": one.seconds,
            "times real time": one.simulated_s / one.seconds,
            "us a cycle (CPU)": 1e6 * one.cpu_s / one.cycles,
            "share of a core": one.cpu_s / one.seconds,
            "samples lost": one.lost,
            "p99 lateness, ms": one.p99_ms,
            "latest cycle, ms": one.latest_ms,
        }
        for one in everything
    ]
    return Outcome(
        {"Three drives, two amplifiers, recorder, live resolver": rows},
        {
            "times_real_time": best.simulated_s / best.seconds,
            "real_time_share": paced.cpu_s / paced.seconds,
            "lost_samples": float(sum(one.lost for one in everything)),
        },
        (
            "The gate of a run of 120 periods at 1 Hz, from its opening to its closing: run "
            "control, protocols, raw bus log, journals, live resolver, simulated devices and "
            "hydrodynamics; a view looks ten times a second. The best of the free runs counts.",
        ),
    )


BENCHMARK = Benchmark("run_control", "Run control", run)
