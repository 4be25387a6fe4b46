"""How often 95 % intervals hold the truth, and what the estimates' variance is over the bound."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from analysis.recording import Recording
from analysis.resolver.basis import harmonic_basis
from analysis.resolver.estimate import resolve
from analysis.resolver.hann import resolve_hann
from analysis.resolver.harmonics import Harmonics
from analysis.resolver.reference import PhaseReference, from_frequency
from analysis.resolver.sums import period_sums
from benchmarks import coverage_memory
from benchmarks.noises import NOISES, SAMPLES_PER_PERIOD, Noise, white
from benchmarks.outcome import Benchmark, Outcome, Report, Row
from benchmarks.signals import recorded
from hardware.description.arrays import FloatArray

_LEVEL = 0.95
_ORDERS = np.arange(1.0, 4.0)
_AT_ONCE = 1_000  # channels, all with their own noise
_GATES = (2, 3, 5, 10, 30)
_JUDGED = (5, 10, 30)
_HANN_JUDGED = (10, 30)
_LEAD = 4  # samples before the gate, and after it


@dataclass(frozen=True)
class _Batch:
    """Many channels of noise alone: the truth of every harmonic is zero."""

    recording: Recording
    reference: PhaseReference
    edges_cycles: FloatArray

    @property
    def inside(self) -> tuple[FloatArray, FloatArray]:
        """Cycles and values of the samples in the gate."""
        times_s = self.recording.time_s()
        cycles = self.reference.cycles_at(times_s)
        gate = (cycles >= self.edges_cycles[0]) & (cycles < self.edges_cycles[-1])
        return cycles[gate], self.recording.samples[:, : len(times_s)][:, gate]


def _batches(noise: Noise, periods: int, trials: int) -> Iterator[_Batch]:
    rng = np.random.default_rng(1963 + periods)
    for start in range(0, trials, _AT_ONCE):
        step = 1.0 / SAMPLES_PER_PERIOD * rng.uniform(0.99, 1.01)  # not commensurate
        count = int(periods / step) + 2 * _LEAD
        opening = (_LEAD - rng.random()) * step  # between two samples, at theta = 0
        from_middle = np.arange(count, dtype=np.float64) * step - (opening + periods / 2.0)
        recording = recorded(noise(min(_AT_ONCE, trials - start), from_middle, rng), 1.0)
        reference = from_frequency(step, 0.0, recording.end_s, -2.0 * np.pi * opening)
        yield _Batch(recording, reference, np.arange(periods + 1.0))


def run(quick: bool, report: Report) -> Outcome:
    """Draw trials of every noise and gate."""
    trials = 20 if quick else 20_000
    rows: list[Row] = []
    for name, noise in NOISES.items():
        for periods in _GATES:
            report(f"{name}, m = {periods}")
            rows.append(_covered(name, noise, periods, trials))
    variances = [_variances(periods, trials) for periods in _GATES]
    fewer = trials // 5
    memories = coverage_memory.rows(_readings, fewer, report)
    tables = {
        "Share of 95 % intervals that hold the truth": rows,
        "The same under long memory and beats": memories,
        "Variance in white noise over the Cramer-Rao bound of the same model": variances,
    }
    measured = {**_judged(rows), **coverage_memory.judged(memories), **_largest_variance(variances)}
    return Outcome(tables, measured, _notes(trials) + coverage_memory.notes(fewer))


def _notes(trials: int) -> tuple[str, ...]:
    return (
        f"{trials} trials of every row, 100 samples a period, gate edges between samples; every "
        "noise has a standard deviation of 1, the drift is 1 per period and so is the random "
        "walk's spread after a period. Harmonics 1 to 3: S and C together, the worst harmonic.",
        "Whole periods are analysed with the drift taken out, as by default; so is the Hann taper, "
        "which needs five periods.",
        "The rival is a plain least-squares fit (with a trend column) whose residual is taken as "
        "white.",
        f"One standard error of a share of 0.95 is {np.sqrt(0.95 * 0.05 / 2 / trials):.4f}, of a "
        f"variance ratio {np.sqrt(2.0 / trials):.3f}.",
        "The inflation is the bound of S1's variance with a trend in the model over that without.",
    )


def _covered(name: str, noise: Noise, periods: int, trials: int) -> Row:
    """Return the shares for one noise and gate."""
    whole, tapered, naive = [], [], []
    for batch in _batches(noise, periods, trials):
        whole.append(_holds(_whole_periods(batch)))
        if periods >= 5:
            tapered.append(_holds(_hann(batch)))
        naive.append(_naive(batch))
    shares = np.concatenate(whole).mean(axis=0)
    return {
        "noise": name,
        "m": periods,
        "whole periods, n = 1": _of_order(shares)[0],
        "whole periods, worst n": min(_of_order(shares)),
        "whole periods, mean": float(shares[0]) if _mean_is_known(name, periods) else "",
        "Hann, worst n": _worst(tapered),
        "residual as white, n = 1": _of_order(np.concatenate(naive).mean(axis=0))[0],
    }


def _mean_is_known(noise: str, periods: int) -> bool:
    """Tell whether the mean has a truth, which is zero, and an interval is given for it."""
    return periods > 2 and noise != "random_walk"


def _worst(parts: list[FloatArray]) -> float | str:
    return min(_of_order(np.concatenate(parts).mean(axis=0))) if parts else ""


def _of_order(shares: FloatArray) -> list[float]:
    return [float(shares[2 * n - 1 : 2 * n + 1].mean()) for n in (1, 2, 3)]


def _whole_periods(batch: _Batch, *, take_out_drift: bool = True) -> Harmonics:
    sums = period_sums(batch.recording, batch.reference, edges_cycles=batch.edges_cycles)
    return resolve(batch.recording, sums, take_out_drift=take_out_drift)


def _readings(noise: Noise, periods: int, trials: int) -> Iterator[Harmonics]:
    return (_whole_periods(batch) for batch in _batches(noise, periods, trials))


def _hann(batch: _Batch) -> Harmonics:
    return resolve_hann(batch.recording, batch.reference, batch.edges_cycles, 3)


def _holds(found: Harmonics) -> FloatArray:
    """Tell which intervals hold zero, shape ``(channels, 7)``; NaN where there is none."""
    half = found.half_width(_LEVEL)
    return np.where(np.isfinite(half), np.abs(found.coefficients) <= half, np.nan)


def _naive(batch: _Batch) -> FloatArray:
    """Do the same for least squares whose residual is taken as white."""
    cycles, values = batch.inside
    basis = np.vstack((harmonic_basis(cycles, _ORDERS), np.linspace(-1.0, 1.0, len(cycles))))
    inverse = np.linalg.inv(basis @ basis.T)
    coefficients = values @ basis.T @ inverse
    residual = values - coefficients @ basis
    variance = (residual**2).sum(axis=1) / (len(cycles) - len(basis))
    half = 1.96 * np.sqrt(variance[:, None] * np.diag(inverse))
    return np.asarray(np.abs(coefficients) <= half, dtype=np.float64)[:, :7]


def _variances(periods: int, trials: int) -> Row:
    """Return variances over the bounds of the models without a trend and with one."""
    ratios: dict[bool, FloatArray] = {}
    inflation = []
    for drifting in (False, True):
        squares, bounds = [], []
        for batch in _batches(white, periods, trials):
            found = _whole_periods(batch, take_out_drift=drifting)
            plain, with_trend = _bounds(batch)
            squares.append((found.coefficients**2).mean(axis=0))
            bounds.append(with_trend if drifting else plain)
            inflation.append(with_trend[1] / plain[1])
        ratios[drifting] = np.mean(squares, axis=0) / np.mean(bounds, axis=0)
    plain, trend = ratios[False], ratios[True]
    return {
        "m": periods,
        "no drift taken out, S1": float(plain[1]),
        "no drift taken out, worst": float(plain.max()),
        "drift taken out, S1": float(trend[1]),
        "drift taken out, worst": float(trend.max()),
        "inflation of the bound by a trend, S1": float(np.mean(inflation)),
        "drift taken out over the bound without, S1": float(trend[1] * np.mean(inflation)),
    }


def _bounds(batch: _Batch) -> tuple[FloatArray, FloatArray]:
    """Cramer-Rao bounds of unit white noise, shape ``(7,)`` each: without a trend, and with one.

    Time counts from mid-gate, where the mean is stated.
    """
    cycles = batch.inside[0]
    basis = harmonic_basis(cycles, _ORDERS)
    with_trend = np.vstack((basis, cycles - batch.edges_cycles.mean()))
    inverses = (np.linalg.inv(rows @ rows.T) for rows in (basis, with_trend))
    plain, trend = (np.diag(inverse)[:7] for inverse in inverses)
    return plain, trend


def _judged(rows: list[Row]) -> dict[str, float]:
    """Pick what the thresholds judge."""

    def shares(gates: tuple[int, ...], noise: str = "") -> list[float]:
        chosen = [row for row in rows if row["m"] in gates and noise in ("", row["noise"])]
        return [float(row["whole periods, worst n"]) for row in chosen]

    measured = {name: min(shares(_JUDGED, name)) for name in NOISES}
    measured["mean"] = min(
        float(row["whole periods, mean"])
        for row in rows
        if row["m"] in _JUDGED and row["whole periods, mean"] != ""
    )
    measured["white_largest"] = max(shares(_JUDGED, "white"))
    measured["short"] = min(shares((2, 3)))
    measured["hann"] = min(float(r["Hann, worst n"]) for r in rows if r["m"] in _HANN_JUDGED)
    return measured


def _largest_variance(rows: list[Row]) -> dict[str, float]:
    return {
        "variance": max(float(row["no drift taken out, worst"]) for row in rows),
        "variance_with_drift": max(float(row["drift taken out, worst"]) for row in rows),
    }


BENCHMARK = Benchmark("coverage", "Honest intervals", run)
