"""The 1963 table: what each old mode gives beside the new estimator on the same record."""

from dataclasses import dataclass

import numpy as np

from analysis.recording import Recording
from analysis.resolver.classic_average import SETTLED_AFTER
from analysis.resolver.classic_recording import gated_readings, running_average
from analysis.resolver.estimate import resolve
from analysis.resolver.photocell import from_photocell
from analysis.resolver.sums import period_sums
from benchmarks.outcome import Benchmark, Outcome, Report, Row
from benchmarks.signals import Truth, draw_coefficients, recorded
from hardware.description.arrays import FloatArray

_RATE_HZ = 100.0
_HARMONICS = (1.0, 1.0, 0.2, 0.1)  # mean and harmonics 1 to 3
_DRIFT, _NOISE, _INTERFERENCE = 0.1, 0.1, 0.1
_INTERFERENCE_ORDER = 1.37
_TIME_CONSTANTS = (1.5, 5.0)  # periods
_FAST_HZ, _SLOW_HZ = 1.0137, 0.10137
_LEAD = 1.3  # periods before the first pulse of interest
_STAYS_WITHIN = 0.01  # of the first harmonic's amplitude: settled


@dataclass(frozen=True)
class _Disturbance:
    """A record: its mean and harmonics 1 to 3, and what it holds besides."""

    name: str
    amplitudes: tuple[float, ...] = _HARMONICS
    drift: bool = False
    noise: bool = False
    interference: bool = False


_UNDISTURBED = _Disturbance("nothing else")
_TARED = _Disturbance("nothing else, mean tared", (0.0, *_HARMONICS[1:]))
_PURE = _Disturbance("first harmonic alone, mean tared", (0.0, 1.0, 0.0, 0.0))
_EVERYTHING = _Disturbance("everything at once", drift=True, noise=True, interference=True)
_DISTURBANCES = (
    _UNDISTURBED,
    _TARED,
    _Disturbance("drift", drift=True),
    _Disturbance("white noise", noise=True),
    _Disturbance("interference", interference=True),
    _EVERYTHING,
)


@dataclass(frozen=True)
class _Record:
    """Many draws of the same record, one a channel, and their truth."""

    recording: Recording
    truth: Truth

    def rms(self, in_phase: FloatArray, quadrature: FloatArray) -> float:
        """RMS error of readings, shapes ``(channels, 3)``."""
        wanted = self.truth.coefficients
        errors = np.concatenate((in_phase - wanted[:, 1::2], quadrature - wanted[:, 2::2]))
        return float(np.sqrt(np.mean(errors**2)))


def _draw(disturbance: _Disturbance, frequency_hz: float, periods: float, draws: int) -> _Record:
    rng = np.random.default_rng(1963)
    coefficients = draw_coefficients(disturbance.amplitudes, draws, rng)
    truth = Truth(frequency_hz, -0.1234, coefficients)
    times_s = np.arange(round(periods / frequency_hz * _RATE_HZ)) / _RATE_HZ
    cycles = truth.cycles(times_s)
    values = truth.values(times_s)
    if disturbance.drift:
        values += _DRIFT * rng.choice([-1.0, 1.0], draws)[:, None] * cycles
    if disturbance.noise:
        values += _NOISE * rng.standard_normal(values.shape)
    if disturbance.interference:
        phase = rng.random(draws)[:, None]
        values += _INTERFERENCE * np.sin(2.0 * np.pi * (_INTERFERENCE_ORDER * cycles + phase))
    return _Record(recorded(values, _RATE_HZ, truth.edges_s(float(times_s[-1]))), truth)


def run(quick: bool, report: Report) -> Outcome:
    """Resolve the same records by the old modes and by the new estimator."""
    draws = 50 if quick else 1_000
    fast, slow = [], []
    for disturbance in _DISTURBANCES:
        report(disturbance.name)
        fast += [_average_row(disturbance, tau, draws) for tau in _TIME_CONSTANTS]
        slow += [_gate_row(disturbance, periods, draws) for periods in (1, 2, 3, 4)]
    report("settling")
    tables = {
        "Running average, 1 Hz: RMS error of S and C, harmonics 1 to 3": fast,
        "Gated integration, 0.1 Hz: RMS error of S and C, harmonics 1 to 3": slow,
        "Settling of the running average, 1 Hz: S1 and C1": _settling(draws),
    }
    measured = {"running_average": _largest(fast), "gated_integration": _largest(slow)}
    return Outcome(tables, measured, _notes(draws))


def _notes(draws: int) -> tuple[str, ...]:
    return (
        f"{draws} draws of all phases, 100 Hz. Mean 1, harmonics 1, 0.2 and 0.1; drift "
        f"{_DRIFT:g} per period, white noise {_NOISE:g}, interference {_INTERFERENCE:g} at "
        f"{_INTERFERENCE_ORDER:g} times the frequency.",
        "The needles are read as soon as they count as settled (4.6 time constants); the new "
        "estimator gates the whole periods that have gone by then.",
        "The gate and the new estimator use the same m periods; at m = 1 the new one takes the "
        "drift from the periods on either side, which the apparatus could not.",
        "Against interference a plain gate is what it was in 1963; a Hann taper is for that.",
    )


def _largest(rows: list[Row]) -> float:
    return max(float(r["new over old"]) for r in rows if r["record"] == _EVERYTHING.name)


def _average_row(disturbance: _Disturbance, tau_periods: float, draws: int) -> Row:
    waited = SETTLED_AFTER * tau_periods
    record = _draw(disturbance, _FAST_HZ, waited + 0.05, draws)
    reference = from_photocell(_edges(record.recording))
    needles = running_average(record.recording, reference, time_constant_s=tau_periods / _FAST_HZ)
    old = record.rms(*needles.reading())
    sums = period_sums(record.recording, reference)
    new = resolve(record.recording, sums)
    return {
        "record": disturbance.name,
        "time constant, periods": tau_periods,
        "waited, periods": waited,
        **_both(old, record.rms(new.in_phase, new.quadrature)),
    }


def _gate_row(disturbance: _Disturbance, periods: int, draws: int) -> Row:
    record = _draw(disturbance, _SLOW_HZ, periods + 2.0 * _LEAD, draws)
    reference = from_photocell(_edges(record.recording))
    sums = period_sums(record.recording, reference)
    gate = sums[1 : periods + 1]
    pulses_s = np.append(gate.opened_s, gate.closed_s[-1])
    reading = gated_readings(record.recording, reference, periods=periods, pulses_s=pulses_s)[0]
    old = record.rms(reading.in_phase, reading.quadrature)
    new = resolve(record.recording, gate, around=sums if periods == 1 else None)
    return {
        "record": disturbance.name,
        "m": periods,
        **_both(old, record.rms(new.in_phase, new.quadrature)),
    }


def _both(old: float, new: float) -> Row:
    return {"old mode": old, "new estimator": new, "new over old": new / old}


def _edges(recording: Recording) -> FloatArray:
    edges_s = recording.photocell_edges_s
    return np.empty(0) if edges_s is None else edges_s


def _settling(draws: int) -> list[Row]:
    """Return when the needles of S1 and C1 come to stay near the truth, and what is promised."""
    return [
        _settling_row(disturbance, tau, min(draws, 50))
        for disturbance in (_UNDISTURBED, _PURE)
        for tau in (*_TIME_CONSTANTS, 15.0)
    ]


def _settling_row(disturbance: _Disturbance, tau_periods: float, draws: int) -> Row:
    record = _draw(disturbance, _FAST_HZ, 12.0 * tau_periods, draws)
    reference = from_photocell(_edges(record.recording))
    tau_s = tau_periods / _FAST_HZ
    needles = running_average(record.recording, reference, time_constant_s=tau_s)
    wanted = record.truth.coefficients
    off = np.hypot(
        needles.in_phase[:, 0] - wanted[:, 1:2], needles.quadrature[:, 0] - wanted[:, 2:3]
    )
    first = resolve(record.recording, period_sums(record.recording, reference)[:1])
    new = np.abs(first.coefficients[:, 1:3] - wanted[:, 1:3])
    return {
        "record": disturbance.name,
        "time constant, periods": tau_periods,
        "settled lights after, periods": SETTLED_AFTER * tau_periods,
        "largest error then": float(off[:, np.argmax(needles.settled)].max()),
        "stays within 1 % after, periods": _stays(off),
        "ripple that remains": float(off[:, -int(2.0 * _RATE_HZ / _FAST_HZ) :].max()),
        "new estimator, largest error after 1 period": float(new.max()),
    }


def _stays(off: FloatArray) -> str:
    """Return when the last channel came to stay within 1 %, or that it never did."""
    last = int(np.flatnonzero((off > _STAYS_WITHIN).any(axis=0))[-1])
    if last == off.shape[1] - 1:
        return "never: ripple"
    return f"{(last + 1) * _FAST_HZ / _RATE_HZ:.1f}"


BENCHMARK = Benchmark("classic", "The modes of 1963", run)
