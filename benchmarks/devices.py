"""Speed of a whole simulated rig through the protocol stack, and what arrives of its samples."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from can.interfaces import BACKENDS

from benchmarks.outcome import Benchmark, Outcome, Report, Row
from hardware.pacing import FreeRunning, Pacer, RealTime
from hardware.rig import Rig
from hardware.rig_configuration import read_rig
from sim.devices.bench_file import DRIVERS
from sim.devices.parts import Scene
from sim.devices.plant import PlantConditions
from sim.devices.registry import running
from sim.devices.world import World
from sim.rig import vertical_rig

if TYPE_CHECKING:
    from hardware.roles import Photocell, Shaft

_NAME = "benchmark"
_NEWTON_PER_COUNT = 0.01
_ECCENTRICITY_M, _PHASE_RAD = 0.02, 0.5
_FREQUENCY_HZ = 1.0


@dataclass(frozen=True)
class _Run:
    """What a run cost and what arrived."""

    seconds: float  # of the host's clock
    cpu_s: float
    simulated_s: float
    cycles: int
    lost: int
    error_counts: float
    latest_ms: float


def _amplifier(node: int, channel: str) -> dict[str, Any]:
    one = {"name": channel, "object": "9130:1", "scale": _NEWTON_PER_COUNT, "full_scale": 490.0}
    return {"driver": "cia404-amplifier", "node": node, "channels": [{**one, "status": "6150:1"}]}


def tables(rate_hz: float) -> dict[str, Any]:
    """Return the tables of a rig of three drives and two amplifiers."""
    axis: dict[str, Any] = {"driver": "cia402-axis", "tolerance": 1e-4}
    axis |= {"speed": 0.01, "acceleration": 0.1, "quick_stop": 1.0, "standard_uncertainty": 1e-5}
    return {
        "bus": {
            "interface": "pmm-simulated",
            "channel": _NAME,
            "receive_thread": False,
            "sync_rate_hz": rate_hz,
        },
        "shaft": {
            "driver": "cia402-shaft",
            "node": 1,
            "counts_per_turn": 2**17,
            "highest_frequency_hz": 2.0,
            "acceleration_hz_per_s": 1.0,
            "quick_stop_hz_per_s": 5.0,
            "touch_probe": True,
        },
        "eccentricity": {**axis, "node": 2, "counts_per_unit": 1e6, "low": 0.0, "high": 0.06,
                         "home_position": _ECCENTRICITY_M},
        "phase": {**axis, "node": 3, "unit": "rad", "counts_per_unit": 1e5, "low": -3.2,
                  "high": 3.2, "home_position": _PHASE_RAD},
        "forces": [_amplifier(4, "force_aft"), _amplifier(5, "force_fore")],
        "photocell": {"driver": "touch-probe"},
    }  # fmt: skip


@contextmanager
def _turning(rate_hz: float) -> Iterator[tuple[Rig, World]]:
    """Open a rig whose shaft turns at speed, axes homed where they stand."""
    BACKENDS.setdefault("pmm-simulated", ("sim.devices.bus", "SimulatedBus"))
    configuration = read_rig(tables(rate_hz), DRIVERS)
    around = PlantConditions(carriage_speed_m_s=1.2)
    world = World(configuration, Scene(vertical_rig(), around, _ECCENTRICITY_M, _PHASE_RAD))
    with (
        running(_NAME, world),
        Rig(configuration, lambda: world.time_s, FreeRunning(), lambda _: None) as rig,
    ):
        rig.prepare()
        for one in rig.powered():
            one.enable()
        rig.run_until(lambda: all(one.enabled for one in rig.powered()), 100, "enable")
        axes = [one for one in (rig.eccentricity, rig.phase) if one is not None]
        shaft = cast("Shaft", rig.shaft)
        rig.run_until(lambda: not shaft.moving, 1000, "rest")
        for one in axes:
            one.home()
        rig.run_until(lambda: all(one.homed and not one.moving for one in axes), 1000, "home")
        shaft.turn(_FREQUENCY_HZ)
        rig.run_until(lambda: shaft.at_speed, 1000, "speed")
        yield rig, world


def _measure(rate_hz: float, duration_s: float, pacer: Pacer) -> _Run:
    """Run for a time, and compare what arrived with what the chain said."""
    with _turning(rate_hz) as (rig, world):
        rig._pacer = pacer  # set up free-running, measured as asked for
        cast("Photocell", rig.photocell).expect(_FREQUENCY_HZ)
        _empty(rig)
        first, cycles = rig.number + 1, round(duration_s * rate_hz)
        latest = 0.0
        true = np.empty((2, cycles))
        begun, used = time.perf_counter(), time.process_time()
        for i in range(cycles):
            latest = max(latest, rig.cycle().lateness_s)
            true[0, i] = world.plant.value("recorded_force_aft")
            true[1, i] = world.plant.value("recorded_force_fore")
        seconds, cpu_s = time.perf_counter() - begun, time.process_time() - used
        lost, error = 0, 0.0
        for row, device in zip(true, rig.forces, strict=True):
            blocks = device.take()
            lost += cycles - sum(one.values.shape[1] for one in blocks)
            for one in blocks:
                at = one.first - first
                off = one.values[0] - row[at : at + one.values.shape[1]]
                error = max(error, float(np.max(np.abs(off))) / _NEWTON_PER_COUNT)
        return _Run(seconds, cpu_s, cycles / rate_hz, cycles, lost, error, 1e3 * latest)


def _empty(rig: Rig) -> None:
    for device in rig.forces:
        device.take()


def _free(rounds: int, duration_s: float) -> list[_Run]:
    return [_measure(100.0, duration_s, FreeRunning()) for _ in range(rounds)]


def _paced(duration_s: float) -> _Run:
    rate_hz = 200.0
    return _measure(rate_hz, duration_s, RealTime(1.0 / rate_hz, time.monotonic, time.sleep))


def run(quick: bool, report: Report) -> Outcome:
    """Measure free-running at 100 Hz and in real time at 200 Hz."""
    report("free-running")
    free = _free(1 if quick else 5, 2.0 if quick else 120.0)
    report("real time")
    paced = _paced(0.5 if quick else 20.0)
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
            "latest cycle, ms": one.latest_ms,
        }
        for one in everything
    ]
    return Outcome(
        {"Rig of three drives and two amplifiers, eleven TPDOs a cycle": rows},
        {
            "times_real_time": best.simulated_s / best.seconds,
            "real_time_share": paced.cpu_s / paced.seconds,
            "sample_error_counts": max(one.error_counts for one in everything),
            "lost_samples": float(sum(one.lost for one in everything)),
        },
        (
            "Controller, protocols, simulated devices, hydrodynamics and the comparison of every "
            "sample run in one thread; the best of the free runs counts, because the machine is "
            "shared.",
        ),
    )


BENCHMARK = Benchmark("devices", "A simulated rig through its protocols", run)
