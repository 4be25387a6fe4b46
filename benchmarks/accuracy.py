"""Errors without noise, 100 Hz and about 1 Hz: where the gate's edges fall between samples."""

from dataclasses import dataclass

import numpy as np

from analysis.resolver.estimate import resolve
from analysis.resolver.reference import from_frequency
from analysis.resolver.sums import period_sums
from benchmarks.accuracy_rivals import RIVALS, Gate
from benchmarks.outcome import Benchmark, Outcome, Report, Row
from benchmarks.signals import Truth, draw_coefficients, recorded
from hardware.description.arrays import FloatArray

_RATE_HZ = 100.0
_MODELLED = (10.0, 1.0, 0.3, 0.1)
_UNMODELLED = (0.1,) * 5
_OURS = "ours"
_LEAD = 1.5  # periods before the gate, and after it


@dataclass(frozen=True)
class _Case:
    """One column pair of the table."""

    name: str
    periods: int
    unmodelled: bool = False
    drift_per_period: float = 0.0
    key: str | None = None


_CASES = (
    _Case("m = 1", 1, key="harmonics"),
    _Case("m = 10", 10),
    _Case("m = 1, unmodelled", 1, unmodelled=True, key="unmodelled"),
    _Case("m = 10, unmodelled", 10, unmodelled=True),
    _Case("m = 1, drift", 1, drift_per_period=1.0),
    _Case("m = 2, drift", 2, drift_per_period=1.0, key="drift"),
    _Case("m = 10, drift", 10, drift_per_period=1.0),
    _Case("m = 1, both", 1, unmodelled=True, drift_per_period=1.0),
    _Case("m = 2, both", 2, unmodelled=True, drift_per_period=1.0, key="drift_unmodelled"),
    _Case("m = 10, both", 10, unmodelled=True, drift_per_period=1.0),
)


def run(quick: bool, report: Report) -> Outcome:
    """Draw frequencies and phases; collect every method's errors."""
    trials = 5 if quick else 400
    rms: dict[str, Row] = {name: {"method": name} for name in (*RIVALS, _OURS)}
    largest: dict[str, Row] = {name: {"method": name} for name in (*RIVALS, _OURS)}
    measured = {}
    for case in _CASES:
        report(case.name)
        rng = np.random.default_rng(1963)
        errors = [_trial(case, rng) for _ in range(trials)]
        for name in (*RIVALS, _OURS):
            found = np.array([error[name] for error in errors])
            rms[name][case.name] = float(np.sqrt(np.mean(found[:, 1:] ** 2)))
            largest[name][case.name] = float(np.abs(found[:, 1:]).max())
        if case.key is not None:
            own = np.array([error[_OURS] for error in errors])
            measured[case.key] = float(np.abs(own).max())
    measured["rounded_gate"] = float(rms["gate rounded to a sample"]["m = 1"])
    tables = {
        "RMS error of in-phase and quadrature parts, harmonics 1 to 3": list(rms.values()),
        "Largest error of the same": list(largest.values()),
    }
    return Outcome(tables, measured, _notes(trials))


def _notes(trials: int) -> tuple[str, ...]:
    return (
        f"{trials} draws of the frequency (0.9 to 1.1 Hz) and of all phases. Mean 10, harmonics "
        "1 to 3 of 1, 0.3 and 0.1; unmodelled are harmonics 4 to 8 of 0.1 each; the drift is 1 per "
        "period.",
        "Ours has six-point edges, the Gram solve, and takes the drift out first; at m = 1 from "
        "the periods on either side, for a gate alone cannot tell it.",
        "The thresholds take the largest error of ours, that of the mean at mid-gate included.",
    )


def _trial(case: _Case, rng: np.random.Generator) -> dict[str, FloatArray]:
    """Return each method's error of ``[A0, S1, ...]`` in one draw; the mean that at mid-gate."""
    amplitudes = _MODELLED + (_UNMODELLED if case.unmodelled else ())
    frequency_hz = rng.uniform(0.9, 1.1)
    truth = Truth(frequency_hz, rng.random(), draw_coefficients(amplitudes, 1, rng))
    opened_cycle = np.ceil(truth.opening_cycle + _LEAD)
    edges_cycles = opened_cycle + np.arange(-1.0, case.periods + 2.0)
    end_s = (opened_cycle + case.periods + _LEAD - truth.opening_cycle) / frequency_hz
    times_s = np.arange(int(end_s * _RATE_HZ)) / _RATE_HZ
    middle_s = (opened_cycle + case.periods / 2.0 - truth.opening_cycle) / frequency_hz
    drift = case.drift_per_period * frequency_hz * (times_s - middle_s)
    values = truth.values(times_s) + drift
    edges = (edges_cycles - truth.opening_cycle) / frequency_hz * _RATE_HZ
    gate = Gate(values[0], truth.cycles(times_s), edges[1], edges[-2], case.periods)
    found = {name: rival(gate) for name, rival in RIVALS.items()}
    found[_OURS] = _ours(truth, values, edges_cycles, case)
    expected = truth.coefficients[0, :7]
    return {name: value - expected for name, value in found.items()}


def _ours(truth: Truth, values: FloatArray, edges_cycles: FloatArray, case: _Case) -> FloatArray:
    recording = recorded(values, _RATE_HZ)
    opening_rad = 2.0 * np.pi * truth.opening_cycle
    reference = from_frequency(truth.frequency_hz, 0.0, recording.end_s, opening_rad)
    alone = case.periods > 1 or not case.drift_per_period
    edges = edges_cycles[1:-1] if alone else edges_cycles
    sums = period_sums(recording, reference, edges_cycles=edges)
    gate = sums if alone else sums[1:-1]
    found = resolve(recording, gate, around=None if alone else sums)
    return np.asarray(found.coefficients[0])


BENCHMARK = Benchmark("accuracy", "Accuracy", run)
