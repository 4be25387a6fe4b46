"""The period fit beside its peers, for success from poor starts and for accuracy.

``curve_fit`` is the peer: five parameters of one damped cosine with offset, iterated together from
the same start. A start is the truth times a factor from 0.1 to 10, evenly in its logarithm, for the
period, and as far off for amplitude and decay; the phase is anything.
"""

import time
import warnings
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from analysis.inertia.damped import fit_damped
from analysis.inertia.numeric import FloatArray

SUCCESS = 1e-3  # relative error of the period


@dataclass(frozen=True)
class Rival:
    """How one method did.

    Attributes
    ----------
    success
        Part of the starts from which the period came out to 0.1 %.
    rms_error
        Relative error of the period over the successes.
    median_s
        Time of one fit.
    """

    name: str
    starts: int
    success: float
    rms_error: float
    median_s: float


@dataclass(frozen=True)
class Truth:
    """The record that all fit: one damped cosine with offset and white noise."""

    period_s: float = 2.846
    decay_1_s: float = 0.0032
    amplitude: float = 0.075
    phase_rad: float = 1.1
    offset: float = -2e-4
    noise_rms: float = 5e-4
    duration_s: float = 60.0
    sample_rate_hz: float = 32.0

    def record(self, generator: Generator) -> tuple[FloatArray, FloatArray]:
        """Return times and values."""
        t = np.arange(0.0, self.duration_s, 1.0 / self.sample_rate_hz)
        clean = _model(
            t, self.period_s, self.decay_1_s, self.amplitude, self.phase_rad, self.offset
        )
        return t, clean + self.noise_rms * generator.standard_normal(t.size)


def compare_rivals(starts: int = 1000, *, seed: int = 0, truth: Truth | None = None) -> list[Rival]:
    """Fit the same records from the same poor starts with both methods."""
    truth = truth or Truth()
    generator = np.random.default_rng(seed)
    outcomes: dict[str, list[tuple[float, float]]] = {"projection": [], "curve_fit": []}
    for _ in range(starts):
        t, y = truth.record(generator)
        start = _poor_start(truth, generator)
        began = time.perf_counter()
        own = fit_damped(t, y, start_periods_s=(start[0],)).modes[0].period_s
        middle = time.perf_counter()
        peer = _curve_fit_period(t, y, start)
        ended = time.perf_counter()
        outcomes["projection"].append((own / truth.period_s - 1.0, middle - began))
        outcomes["curve_fit"].append((peer / truth.period_s - 1.0, ended - middle))
    return [_rival(name, np.array(rows)) for name, rows in outcomes.items()]


def _rival(name: str, rows: FloatArray) -> Rival:
    good = np.abs(rows[:, 0]) < SUCCESS
    error = float(np.sqrt(np.mean(rows[good, 0] ** 2))) if good.any() else float("nan")
    return Rival(name, len(rows), float(good.mean()), error, float(np.median(rows[:, 1])))


def _poor_start(truth: Truth, generator: Generator) -> FloatArray:
    period, decay, amplitude = 10.0 ** generator.uniform(-1.0, 1.0, 3)
    return np.array(
        [
            truth.period_s * period,
            truth.decay_1_s * decay,
            truth.amplitude * amplitude,
            generator.uniform(-np.pi, np.pi),
            0.0,
        ]
    )


def _model(
    t: FloatArray, period: float, decay: float, amplitude: float, phase: float, offset: float
) -> FloatArray:
    wave = np.cos(2.0 * np.pi * t / period + phase)
    return np.asarray(offset + amplitude * np.exp(-decay * t) * wave)


def _curve_fit_period(t: FloatArray, y: FloatArray, start: FloatArray) -> float:
    from scipy.optimize import OptimizeWarning, curve_fit

    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore", OptimizeWarning)
        try:
            found, _ = curve_fit(_model, t, y, p0=start, maxfev=2000)
        except (RuntimeError, ValueError):
            return float("inf")
    return abs(float(found[0]))
