"""What recording costs the loop and the disk, and how long recovery takes."""

import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.outcome import Benchmark, Outcome, Report, Row
from hardware.description.channels import Channel
from hardware.raw_log import Frame
from pmm.recorder.header import RunHeader
from pmm.recorder.recovery import recover
from pmm.recorder.run_recorder import RunEnd as RunOutcome
from pmm.recorder.run_recorder import RunRecorder

_FAST_HZ, _WIDE, _BLOCK_S = 10_000.0, 16, 0.01
_SLOW_HZ, _FRAMES = 100.0, 13


@dataclass(frozen=True)
class _Run:
    """What recording took."""

    recorded_s: float
    host_s: float
    tick_ms: tuple[float, float, float]  # half, 99 % and all of the calls are quicker
    journal_bytes: int
    close_s: float


def _header(channels: int, rate_hz: float) -> RunHeader:
    return RunHeader(
        run_name="benchmark",
        channels=tuple(Channel(f"force_{i}", "N") for i in range(channels)),
        sample_rate_hz=rate_hz,
        started_utc="",
        kind="oscillation",
    )


def _fast(folder: Path, seconds: float, *, real_time: bool) -> _Run:
    """Record 16 channels at 10 kHz in blocks of 10 ms, as fast as it goes or on time."""
    rows = round(_BLOCK_S * _FAST_HZ)
    values = np.random.default_rng(3).normal(size=(_WIDE, rows))
    took = []
    with RunRecorder(folder, _header(_WIDE, _FAST_HZ)) as recorder:
        begun = time.perf_counter()
        for block in range(round(seconds / _BLOCK_S)):
            if real_time:
                time.sleep(max(0.0, begun + block * _BLOCK_S - time.perf_counter()))
            at = time.perf_counter()
            recorder.samples(1 + block * rows, values)
            recorder.cycle_statistics(1e-4)
            recorder.tick(time.monotonic())
            took.append(time.perf_counter() - at)
        recorder.tick(time.monotonic() + 1.0)
        while recorder._journal.behind:
            time.sleep(1e-4)
        host_s = time.perf_counter() - begun
        size = recorder._journal.size
        at = time.perf_counter()
        recorder.close(RunOutcome.COMPLETE)
        close_s = time.perf_counter() - at
    half, most, worst = (1e3 * float(np.quantile(took, q)) for q in (0.5, 0.99, 1.0))
    return _Run(seconds, host_s, (half, most, worst), size, close_s)


def _frame(number: int, node: int) -> Frame:
    data = (number * 7919 + node).to_bytes(8, "little")
    return Frame(
        timestamp=number / _SLOW_HZ, arbitration_id=0x180 + node, data=data, is_extended_id=False
    )


def _cycles(folder: Path, count: int) -> tuple[float, int]:
    """Record cycles of 13 frames and 4 channels; return the loop's seconds, and the log's bytes."""
    frames = [[_frame(number, node) for node in range(_FRAMES)] for number in range(256)]
    values = np.random.default_rng(4).normal(size=(4, 1))
    with RunRecorder(folder, _header(4, _SLOW_HZ)) as recorder:
        spent = 0.0
        for number in range(1, count + 1):
            at = time.perf_counter()
            for frame in frames[number % 256]:
                recorder.frame(frame)
            recorder.samples(number, values)
            recorder.cycle_statistics(1e-4)
            recorder.tick(number / _SLOW_HZ)
            spent += time.perf_counter() - at
            while recorder._journal.behind > 50:  # an hour goes by in seconds
                time.sleep(1e-3)
    return spent, (folder / "bus.blf").stat().st_size


def _timed(work: Callable[[], object]) -> float:
    at = time.perf_counter()
    work()
    return time.perf_counter() - at


def _torn_hour(folder: Path, seconds: float) -> tuple[float, float, int]:
    """Leave a run torn, recover it; return us a cycle, seconds of recovery, bytes of the log."""
    count = round(seconds * _SLOW_HZ)
    spent, log_bytes = _cycles(folder, count)
    for name in ("samples.arrows", "bus.blf"):
        with (folder / name).open("rb+") as file:
            file.truncate((folder / name).stat().st_size - 100)
    return 1e6 * spent / count, _timed(lambda: recover(folder)), log_bytes


def run(quick: bool, report: Report) -> Outcome:
    """Measure throughput, what a call costs, and recovery."""
    with tempfile.TemporaryDirectory() as place:
        report("as fast as it goes")
        free = _fast(Path(place) / "free", 2.0 if quick else 120.0, real_time=False)
        report("in real time")
        paced = _fast(Path(place) / "paced", 1.0 if quick else 30.0, real_time=True)
        report("an hour, torn")
        hour_s = 20.0 if quick else 3600.0
        cycle_us, recover_s, log_bytes = _torn_hour(Path(place) / "hour", hour_s)
    rows: list[Row] = [
        {
            "16 channels at 10 kHz": name,
            "recorded s": one.recorded_s,
            "times real time": one.recorded_s / one.host_s,
            "call p50, ms": one.tick_ms[0],
            "call p99, ms": one.tick_ms[1],
            "call worst, ms": one.tick_ms[2],
            "MB/s of test time": one.journal_bytes / one.recorded_s / 1e6,
            "close, s": one.close_s,
        }
        for name, one in (("as fast as it goes", free), ("in real time", paced))
    ]
    hour: list[Row] = [
        {
            "4 channels at 100 Hz, 13 frames a cycle": "torn at the end",
            "recorded s": hour_s,
            "us a cycle": cycle_us,
            "recover, s": recover_s,
            "raw log, bytes a frame": log_bytes / (hour_s * _SLOW_HZ * _FRAMES),
        }
    ]
    samples = 8.0 * _WIDE * _FAST_HZ * free.recorded_s
    return Outcome(
        {"Recording": rows, "An hour of a rig": hour},
        {
            "times_real_time": free.recorded_s / free.host_s,
            "tick_p99_ms": paced.tick_ms[1],
            "cycle_us": cycle_us,
            "journal_over_samples": free.journal_bytes / samples,
            "recover_hour_s": recover_s,
        },
        (
            "Noise in the samples and other bytes in every frame, so that nothing packs too well. "
            "A call is samples, lateness and tick of one block of 10 ms; everything is brought to "
            "the disk (fdatasync) every half second, and before the clock is read at the end.",
        ),
    )


BENCHMARK = Benchmark("recorder", "Recording", run)
