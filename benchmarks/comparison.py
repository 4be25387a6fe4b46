"""Two channels of one motion against exact signals: errors, intervals, and an hour's time."""

import time
from collections import Counter
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from analysis.comparison.compare import compare
from analysis.comparison.result import ChannelComparison
from analysis.comparison.settings import ComparisonSettings
from analysis.recording import Recording
from benchmarks.comparison_bound import least_errors, memory_of
from benchmarks.comparison_motion import SPREAD, Seen, noise, sines
from benchmarks.outcome import Benchmark, Outcome, Report, Row
from hardware.description.arrays import BoolArray, FloatArray
from hardware.description.channels import Channel
from hardware.description.errors import DataError

_RECORDS: Final = 500
_DURATION_S: Final = 60.0
_NOISY: Final = 300
_NOISY_SPREAD: Final = {"coloured": 0.1}  # over the signal's; of all others 0.5
_PLACES: Final = {"in the first": (1, 0), "in the second": (0, 1), "in both": (1, 1)}
_KINDS: Final = ("one frequency", "harmonics", "irregular", "irregular, derivative 2", "coloured")


def _record(values: FloatArray, rate_hz: float, start_s: float) -> Recording:
    return Recording("exact", (Channel("x", "m"),), values[None, :], rate_hz, start_s)


@dataclass(frozen=True)
class _Trial:
    """A record's errors of gain, lag and clock rate; half-widths; least errors of the last two."""

    kind: str
    errors: FloatArray
    halves: FloatArray
    least: FloatArray


def _trial(seed: int, spreads: tuple[float, float] = (SPREAD, SPREAD)) -> _Trial:
    rng = np.random.default_rng(seed)
    kind = _KINDS[seed % len(_KINDS)]
    motion, order = sines(kind, rng), 2 if "derivative" in kind else 0
    gain, lag_s = rng.uniform(0.5, 2.0), rng.uniform(-0.3, 0.3)
    rate = rng.uniform(-1.0, 1.0) * (8e-3 if seed % 2 else 3e-4)
    first_s = np.arange(int(100 * _DURATION_S)) / 100.0 - rng.uniform(0.0, 1.0)
    second_s = np.arange(int(240 * _DURATION_S)) / 240.0
    seen = Seen(gain, lag_s, rate, _DURATION_S / 2.0, order)
    first = motion.at(first_s)
    second = gain * motion.at(seen.times_s(second_s), order)
    found = compare(
        _record(first + noise(kind, first, rng, spreads[0]), 100.0, float(first_s[0])),
        "x",
        _record(second + noise(kind, second, rng, spreads[1]), 240.0, 0.0),
        "x",
        ComparisonSettings(order=order),
    )
    there = replace(seen, lag_s=lag_s + rate * (found.mid_s - seen.mid_s), mid_s=found.mid_s)
    least = least_errors(motion, there, first_s, second_s, memory_of(kind))
    return _Trial(kind, *_errors(found, there), least)


def _noisy(count: int) -> tuple[dict[str, float], list[Row]]:
    """Return by kind of motion, and by the place of strong noise, how often intervals hold.

    Channels that are refused, since too little of the second is explained, have none.
    """
    held: dict[tuple[str, str], list[BoolArray]] = {}
    refused: Counter[tuple[str, str]] = Counter()
    for seed in range(count):
        kind, place = _KINDS[seed % len(_KINDS)], list(_PLACES)[seed // len(_KINDS) % 3]
        spread = _NOISY_SPREAD.get(kind, 0.5)
        one, other = _PLACES[place]
        try:
            trial = _trial(10_000 + seed, (spread * one, spread * other))
        except DataError:
            refused[kind, place] += 1
            continue
        held.setdefault((kind, place), []).append(np.abs(trial.errors) <= trial.halves)
    names = ("gain", "lag", "rate")
    whole = np.concatenate(list(held.values())).mean(axis=0)
    rows: list[Row] = []
    for kind, place in sorted({*held, *refused}, key=lambda one: (one[1], one[0])):
        own = held.get((kind, place), [])
        parts = np.mean(own, axis=0).tolist() if own else [""] * len(names)
        told = {f"{name} held": part for name, part in zip(names, parts, strict=True)}
        many = {"records": len(own), "refused": refused[kind, place]}
        rows.append({"motion": kind, "noise": place, **many, **told})
    return {f"noisy_{name}": float(part) for name, part in zip(names, whole, strict=True)}, rows


def _errors(found: ChannelComparison, seen: Seen) -> tuple[FloatArray, FloatArray]:
    off_s = found.lag_s.value - seen.lag_s
    if found.modulo_s is not None:
        off_s -= found.modulo_s * round(off_s / found.modulo_s)
    halves = [one.half_width() for one in (found.gain, found.lag_s, found.clock_rate)]
    errors = [found.gain.value / seen.gain - 1.0, off_s, found.clock_rate.value - seen.rate]
    halves[0] /= seen.gain
    return np.array(errors), np.array(halves)


def _hour(seconds: float) -> tuple[float, float]:
    """Return processor and clock time of a comparison at 1 kHz, the better of two."""
    rng = np.random.default_rng(0)
    motion, time_s = sines("irregular", rng), np.arange(int(1000 * seconds)) / 1000.0
    first, second = motion.at(time_s), motion.at(time_s - 0.1 - 2e-4 * time_s)
    records = [_record(one + noise("irregular", one, rng), 1000.0, 0.0) for one in (first, second)]
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
    errors = np.abs(np.array([one.errors for one in trials]))
    held = (errors <= np.array([one.halves for one in trials])).mean(axis=0)
    white = errors[[one.kind != "coloured" for one in trials]]
    measured = {
        "lag_ms": 1e3 * float(errors[:, 1].max()),
        "rate_ppm": 1e6 * float(errors[:, 2].max()),
        "lag_white_ms": 1e3 * float(white[:, 1].max()),
        "rate_white_ppm": 1e6 * float(white[:, 2].max()),
        "over_bound": float(_over_bound(trials).max()),
        "hour_s": processor_s,
    }
    for name, part in zip(("gain", "lag", "rate"), held, strict=True):
        measured[f"{name}_covered"] = measured[f"{name}_not_too_often"] = float(part)
    rows = [_row(kind, trials) for kind in _KINDS]
    report("strong noise")
    noisy, by_place = _noisy(15 if quick else _NOISY)
    measured |= noisy
    notes = (
        f"{records} records of {_DURATION_S:g} s, the first channel at 100 Hz, the second at "
        "240 Hz, noise of a hundredth of the signal's spread in both; lags to 0.3 s, clock rates "
        "to 8000 ppm. The motion is a sum of sines, evaluated at exactly warped times.",
        "Noise with a memory has thirty times as much power where the motion is, which no method "
        "takes out: the largest errors are judged in all records, and in those of white noise.",
        "Least standard deviations: Cramer and Rao's bound, by the Fisher information of both "
        "channels' samples in their own noise, with gain, lag, clock rate, and parts and frequency "
        "of every sine unknown (benchmarks/comparison_bound.py).",
        f"In strong noise: {_NOISY} more such records with white noise of half the signal's "
        "spread, or noise with a memory of a tenth, in the channels that the table names.",
        f"An hour of both at 1 kHz took {processor_s:.2f} s of processor, {clock_s:.2f} s by the "
        "clock of a machine that had other work.",
    )
    tables = {"Two channels of one motion": rows, "In strong noise": by_place}
    return Outcome(tables, measured, notes)


def _over_bound(trials: list[_Trial]) -> FloatArray:
    """Return the root mean square of the errors of lag and clock rate over the least ones."""
    ratios = np.array([one.errors[1:] / one.least for one in trials])
    return np.asarray(np.sqrt((ratios**2).mean(axis=0)))


def _row(kind: str, trials: list[_Trial]) -> Row:
    own = [one for one in trials if one.kind == kind]
    errors = np.abs(np.array([one.errors for one in own]))
    halves = np.array([one.halves for one in own])
    held = (errors <= halves).mean(axis=0)
    least, over = np.median([one.least for one in own], axis=0), _over_bound(own)
    return {
        "motion": kind,
        "records": len(own),
        "largest error of the lag, ms": 1e3 * float(errors[:, 1].max()),
        "its median half-width, ms": 1e3 * float(np.median(halves[:, 1])),
        "its least standard deviation, median, ms": 1e3 * float(least[0]),
        "RMS of its error over that": float(over[0]),
        "largest error of the clock rate, ppm": 1e6 * float(errors[:, 2].max()),
        "its median half-width, ppm": 1e6 * float(np.median(halves[:, 2])),
        "its least standard deviation, median, ppm": 1e6 * float(least[1]),
        "RMS of its error over it": float(over[1]),
        "gain held": float(held[0]),
        "lag held": float(held[1]),
        "clock rate held": float(held[2]),
    }


BENCHMARK = Benchmark("comparison", "Two channels of one motion", run)
