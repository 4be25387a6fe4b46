"""Struts led along an exact yaw by set-points: ten minutes by the clock, and an hour of SYNCs."""

import math
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING, Any, cast
from unittest.mock import patch

import numpy as np
from can.interfaces import BACKENDS

from analysis.response.pure_rotation import pure_rotation
from benchmarks.outcome import Benchmark, Outcome, Report, Row
from hardware import strut_path
from hardware.description.arrays import FloatArray
from hardware.description.lines import Line
from hardware.description.oscillator import HORIZONTAL_1963
from hardware.pacing import FreeRunning, RealTime
from hardware.path_shaft import PathShaft
from hardware.rig import Rig
from hardware.rig_configuration import read_rig
from pmm.real_time import before_others
from sim.devices.bench_file import DRIVERS
from sim.devices.parts import Scene
from sim.devices.plant import PlantConditions
from sim.devices.registry import running
from sim.devices.world import World
from sim.rig import horizontal_rig

if TYPE_CHECKING:
    from hardware.roles import PositionAxis

_NAME = "path-benchmark"
_CLOCK_HZ, _HOUR_HZ = 100.0, 25.0
_FREQUENCY_HZ, _SPEED_M_S, _AMPLITUDE_M = 0.2, 0.8, 0.28
_BINS_MS = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, math.inf)
_TURN = 2.0 * math.pi


def _tables(rate_hz: float) -> dict[str, Any]:
    strut = {"counts_per_unit": 1e7, "low": -0.31, "high": 0.31, "speed": 1.0, "tolerance": 1e-4}
    strut |= {"acceleration": 10.0, "quick_stop": 5.0, "standard_uncertainty": 1e-5}
    strut |= {"following_error": 2e-3, "homing_method": 35}
    setting = {"driver": "path-setting", "low": 0.0, "standard_uncertainty": 1e-5}
    return {
        "bus": {
            "interface": "pmm-simulated",
            "channel": _NAME,
            "receive_thread": False,
            "sync_rate_hz": rate_hz,
        },
        "shaft": {
            "driver": "path-struts",
            "aft": {**strut, "node": 1},
            "fore": {**strut, "node": 2},
            "highest_frequency_hz": 2.0,
            "acceleration_hz_per_s": 0.2,
            "approach_speed": 0.1,
        },
        "eccentricity": {**setting, "high": 0.3},
    }


@contextmanager
def _turning(lines: tuple[Line, ...], rate_hz: float) -> Iterator[Rig]:
    """Open a rig whose struts follow the path at speed, the transient of the start over."""
    BACKENDS.setdefault("pmm-simulated", ("sim.devices.bus", "SimulatedBus"))
    configuration = read_rig(_tables(rate_hz), DRIVERS)
    bare = replace(horizontal_rig().ideal(), photocell=None)
    world = World(configuration, Scene(bare, PlantConditions(_SPEED_M_S)))
    with (
        running(_NAME, world),
        Rig(configuration, lambda: world.time_s, FreeRunning(), lambda _: None) as rig,
    ):
        rig.prepare()
        shaft, axis = _shaft(rig), cast("PositionAxis", rig.eccentricity)
        shaft.enable()
        rig.run_until(lambda: shaft.enabled and not shaft.moving, 300, "enable")
        axis.home()
        rig.run_until(lambda: axis.homed and not axis.moving, 300, "home")
        shaft.follow(lines)
        axis.move_to(_AMPLITUDE_M)
        rig.run_until(lambda: axis.settled, 3000, "the path's beginning")
        shaft.turn(_FREQUENCY_HZ)
        rig.run_until(lambda: shaft.at_speed, 300, "speed")
        for _ in range(200):
            rig.cycle()
        shaft.take()
        yield rig


def _shaft(rig: Rig) -> PathShaft:
    return cast("PathShaft", rig.shaft)


def _taken(rig: Rig, seen: list[tuple[int, FloatArray]]) -> None:
    seen += [(block.first, block.values) for block in _shaft(rig).take()]


def _by_the_clock(lines: tuple[Line, ...], duration_s: float) -> tuple[FloatArray, FloatArray]:
    """Return the lateness of each cycle in seconds, and the samples as :func:`_hour` does."""
    late = np.zeros(round(duration_s * _CLOCK_HZ))
    seen: list[tuple[int, FloatArray]] = []
    # The whole histogram, beyond what would stop a run.
    with (
        patch.object(strut_path, "LATE_PERIODS", math.inf),
        _turning(lines, _CLOCK_HZ) as rig,
        before_others(),
    ):
        rig._pacer = RealTime(1.0 / _CLOCK_HZ, time.monotonic, time.sleep)
        for i in range(len(late)):
            late[i] = rig.cycle().lateness_s
        _taken(rig, seen)
    return late, np.concatenate([one for _, one in seen], axis=1)


def _hour(lines: tuple[Line, ...], duration_s: float) -> tuple[int, FloatArray]:
    """Return how many samples are missing, and those that came: (channels, samples)."""
    cycles = round(duration_s * _HOUR_HZ)
    seen: list[tuple[int, FloatArray]] = []
    with _turning(lines, _HOUR_HZ) as rig:
        for i in range(cycles):
            rig.cycle()
            if i % 1000 == 0:
                _taken(rig, seen)
        _taken(rig, seen)
    values = np.concatenate([one for _, one in seen], axis=1)
    return cycles - values.shape[1], values


def _exact(angle: FloatArray, lines: tuple[Line, ...]) -> FloatArray:
    """Return both struts at master angles: the lines' sines written out."""
    places = np.zeros((2, len(angle)))
    for line in lines:
        for strut in range(2):
            ahead = line.phase_rad + strut * line.strut_phase_rad
            places[strut] += _AMPLITUDE_M * line.share * np.sin(line.order * angle + ahead)
    return places


def _impurity(struts: FloatArray, rate_hz: float) -> float:
    """Return the largest sway velocity of the model in any turn over its bow's speed."""
    half, count = HORIZONTAL_1963.half_spacing_m, round(rate_hz / _FREQUENCY_HZ)
    turns = struts[:, : struts.shape[1] // count * count].reshape(2, -1, count)
    order = 2j * math.pi * _FREQUENCY_HZ * np.arange(count // 2 + 1)

    def rate(wave: FloatArray) -> FloatArray:
        return np.asarray(np.fft.irfft(order * np.fft.rfft(wave, axis=-1), count, axis=-1))

    heading = np.arctan2(turns[1] - turns[0], 2.0 * half)
    ahead, aside = np.cos(heading), np.sin(heading)
    velocity = (_SPEED_M_S + rate(half * ahead), rate(turns[0] + half * aside))
    across = ahead * velocity[1] - aside * velocity[0]
    bow = half * np.abs(rate(heading)).max(axis=1)
    return float((np.abs(across).max(axis=1) / bow).max())


def run(quick: bool, report: Report) -> Outcome:
    """Lead the struts by the clock for ten minutes, and free-running for an hour."""
    lines = pure_rotation(HORIZONTAL_1963, _FREQUENCY_HZ, _SPEED_M_S, _AMPLITUDE_M)
    report("by the clock")
    late, clocked = _by_the_clock(lines, 5.0 if quick else 600.0)
    following = clocked[1:3] - clocked[3:5]
    report("an hour of SYNCs")
    begun = time.perf_counter()
    missing, values = _hour(lines, 5.0 if quick else 3600.0)
    seconds = time.perf_counter() - begun
    steps = np.diff(values[0]) - _TURN * _FREQUENCY_HZ / _HOUR_HZ
    off = np.abs(values[3:5] - _exact(values[0], lines)).max()
    told, moved = _impurity(values[3:5], _HOUR_HZ), _impurity(clocked[1:3], _CLOCK_HZ)
    edges = np.array((0.0, *_BINS_MS)) / 1e3
    counts = np.histogram(late, edges)[0]
    histogram: list[Row] = [
        {"lateness, ms": f"{1e3 * low:g} to {1e3 * high:g}", "cycles": int(count),
         "part": float(count) / len(late)}
        for low, high, count in zip(edges, edges[1:], counts, strict=False)
    ]  # fmt: skip
    clock: list[Row] = [
        {"what": "following error, rms, um", "value": 1e6 * float(following.std())},
        {"what": "the same, largest, um", "value": 1e6 * float(np.abs(following).max())},
        {"what": "sway velocity over the bow's, as moved", "value": moved},
    ]
    hour: list[Row] = [
        {"what": "samples missing", "value": missing},
        {"what": "largest step of the master angle off, rad", "value": float(np.abs(steps).max())},
        {"what": "set-points off the exact path, um", "value": 1e6 * float(off)},
        {"what": "sway velocity over the bow's, as told", "value": told},
        {"what": "times real time", "value": values.shape[1] / _HOUR_HZ / seconds},
    ]
    ms = 1e3 * np.quantile(late, [0.5, 0.99, 0.999, 1.0])
    return Outcome(
        {
            "Lateness of 100 Hz by the clock": histogram,
            "Quantiles of lateness, ms": [
                dict(zip(("median", "99 %", "99.9 %", "largest"), map(float, ms), strict=True))
            ],
            "What the struts did meanwhile": clock,
            "An hour of SYNCs at 25 Hz": hour,
        },
        {
            "late_part": float((late >= 1.0 / _CLOCK_HZ).mean()),
            "following_um": 1e6 * float(np.abs(following).max()),
            "missing": float(missing),
            "angle_step_rad": float(np.abs(steps).max()),
            "told_off_um": 1e6 * float(off),
            "told_impurity": told,
            "moved_impurity": moved,
        },
        (
            "Controller, protocols, simulated drives, hydrodynamics and the loop's clock share one "
            "process, at the priority that `pmm run` asks for, on a machine that does other work. "
            "A cycle that comes a period late ends a run; here it is only counted.",
            "The oracle of the hour draws the model between its struts, points and distances, and "
            "differentiates over each turn.",
        ),
    )


BENCHMARK = Benchmark("paths", "Struts led by set-points", run)
