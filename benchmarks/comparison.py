"""Two channels of one motion against exact signals: errors, intervals, and an hour's time."""

import time
from dataclasses import dataclass
from typing import Final

import numpy as np

from analysis.comparison.compare import compare
from analysis.comparison.result import ChannelComparison
from analysis.comparison.settings import ComparisonSettings
from analysis.recording import Recording
from benchmarks.outcome import Benchmark, Outcome, Report, Row
from hardware.description.arrays import FloatArray
from hardware.description.channels import Channel

_RECORDS: Final = 500
_DURATION_S: Final = 60.0
_NOISE: Final = 0.01  # of the signal's spread: 40 dB
_KINDS: Final = ("one frequency", "harmonics", "irregular", "irregular, derivative 2", "coloured")


@dataclass(frozen=True)
class _Motion:
    """A sum of sines, exact at any time."""

    turn: FloatArray
    size: FloatArray
    phase: FloatArray

    def at(self, time_s: FloatArray, order: int = 0) -> FloatArray:
        total = np.zeros(len(time_s))
        for w, a, p in zip(self.turn, self.size, self.phase, strict=True):
            total += a * w**order * np.sin(w * time_s + p + order * np.pi / 2.0)
        return total


def _motion(kind: str, rng: np.random.Generator) -> _Motion:
    if kind.startswith(("one", "harm")):
        size = np.array([1.0]) if kind.startswith("one") else np.array([1.0, 0.2, 0.05])
        turn = 2.0 * np.pi * rng.uniform(0.5, 1.5) * np.arange(1.0, len(size) + 1.0)
    else:
        turn = 2.0 * np.pi * rng.uniform(0.3, 1.5, 40)
        size = np.exp(-(((turn / 2.0 / np.pi - 0.8) / 0.25) ** 2)) * rng.rayleigh(size=40)
    return _Motion(turn, size, rng.uniform(0.0, 2.0 * np.pi, len(turn)))


def _noise(kind: str, values: FloatArray, rng: np.random.Generator) -> FloatArray:
    drawn = rng.standard_normal(len(values))
    if kind == "coloured":  # a first-order memory of twenty samples
        for k in range(1, len(drawn)):
            drawn[k] = 0.95 * drawn[k - 1] + np.sqrt(1.0 - 0.95**2) * drawn[k]
    return np.asarray(_NOISE * values.std() * drawn)


def _record(values: FloatArray, rate_hz: float, start_s: float) -> Recording:
    return Recording("exact", (Channel("x", "m"),), values[None, :], rate_hz, start_s)


def _trial(seed: int) -> tuple[str, FloatArray, FloatArray]:
    """Return the kind, the errors of gain, lag and clock rate, and their half-widths."""
    rng = np.random.default_rng(seed)
    kind = _KINDS[seed % len(_KINDS)]
    motion, order = _motion(kind, rng), 2 if "derivative" in kind else 0
    gain, lag_s = rng.uniform(0.5, 2.0), rng.uniform(-0.3, 0.3)
    rate = rng.uniform(-1.0, 1.0) * (8e-3 if seed % 2 else 3e-4)
    first_s = np.arange(int(100 * _DURATION_S)) / 100.0 - rng.uniform(0.0, 1.0)
    second_s = np.arange(int(240 * _DURATION_S)) / 240.0
    mid_s = _DURATION_S / 2.0
    first = motion.at(first_s)
    second = gain * motion.at(second_s - lag_s - rate * (second_s - mid_s), order)
    found = compare(
        _record(first + _noise(kind, first, rng), 100.0, float(first_s[0])),
        "x",
        _record(second + _noise(kind, second, rng), 240.0, 0.0),
        "x",
        ComparisonSettings(order=order),
    )
    return kind, *_errors(found, gain, lag_s + rate * (found.mid_s - mid_s), rate)


def _errors(
    found: ChannelComparison, gain: float, lag_s: float, rate: float
) -> tuple[FloatArray, FloatArray]:
    off_s = found.lag_s.value - lag_s
    if found.modulo_s is not None:
        off_s -= found.modulo_s * round(off_s / found.modulo_s)
    halves = [one.half_width() for one in (found.gain, found.lag_s, found.clock_rate)]
    errors = [found.gain.value / gain - 1.0, off_s, found.clock_rate.value - rate]
    halves[0] /= gain
    return np.array(errors), np.array(halves)


def _hour(seconds: float) -> tuple[float, float]:
    """Return processor and clock time of a comparison at 1 kHz, the better of two."""
    rng = np.random.default_rng(0)
    motion, time_s = _motion("irregular", rng), np.arange(int(1000 * seconds)) / 1000.0
    first, second = motion.at(time_s), motion.at(time_s - 0.1 - 2e-4 * time_s)
    records = [
        _record(one + _NOISE * one.std() * rng.standard_normal(len(one)), 1000.0, 0.0)
        for one in (first, second)
    ]
    taken = []
    for _ in range(2):
        clock, processor = time.perf_counter(), time.process_time()
        compare(records[0], "x", records[1], "x")
        taken.append((time.process_time() - processor, time.perf_counter() - clock))
    return min(taken)


def run(quick: bool, report: Report) -> Outcome:
    """Draw records of every kind."""
    records = 10 if quick else _RECORDS
    trials = []
    for seed in range(records):
        if seed % 50 == 0:
            report(f"record {seed}")
        trials.append(_trial(seed))
    report("an hour at 1 kHz")
    processor_s, clock_s = _hour(60.0 if quick else 3600.0)
    errors = np.abs(np.array([one[1] for one in trials]))
    halves = np.array([one[2] for one in trials])
    held = (errors <= halves).mean(axis=0)
    white = errors[[one[0] != "coloured" for one in trials]]
    measured = {
        "lag_ms": 1e3 * float(errors[:, 1].max()),
        "rate_ppm": 1e6 * float(errors[:, 2].max()),
        "lag_white_ms": 1e3 * float(white[:, 1].max()),
        "rate_white_ppm": 1e6 * float(white[:, 2].max()),
        "hour_s": processor_s,
    }
    for name, part in zip(("gain", "lag", "rate"), held, strict=True):
        measured[f"{name}_covered"] = measured[f"{name}_not_too_often"] = float(part)
    rows = [_row(kind, trials) for kind in _KINDS]
    notes = (
        f"{records} records of {_DURATION_S:g} s, the first channel at 100 Hz, the second at "
        "240 Hz, noise of a hundredth of the signal's spread in both; lags to 0.3 s, clock rates "
        "to 8000 ppm. The motion is a sum of sines, evaluated at exactly warped times.",
        "Noise with a memory has thirty times as much power where the motion is, which no method "
        "takes out: the largest errors are judged in all records, and in those of white noise.",
        f"An hour of both at 1 kHz took {processor_s:.2f} s of processor, {clock_s:.2f} s by the "
        "clock of a machine that had other work.",
    )
    return Outcome({"Two channels of one motion": rows}, measured, notes)


def _row(kind: str, trials: list[tuple[str, FloatArray, FloatArray]]) -> Row:
    own = [(error, half) for name, error, half in trials if name == kind]
    errors = np.abs(np.array([one[0] for one in own]))
    halves = np.array([one[1] for one in own])
    held = (errors <= halves).mean(axis=0)
    return {
        "motion": kind,
        "records": len(own),
        "largest error of the lag, ms": 1e3 * float(errors[:, 1].max()),
        "its median half-width, ms": 1e3 * float(np.median(halves[:, 1])),
        "largest error of the clock rate, ppm": 1e6 * float(errors[:, 2].max()),
        "its median half-width, ppm": 1e6 * float(np.median(halves[:, 2])),
        "gain held": float(held[0]),
        "lag held": float(held[1]),
        "clock rate held": float(held[2]),
    }


BENCHMARK = Benchmark("comparison", "Two channels of one motion", run)
