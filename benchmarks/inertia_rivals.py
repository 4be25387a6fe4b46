"""The period fit beside its peers, for success from poor starts and for accuracy.

``curve_fit``: five parameters of one damped cosine with offset, iterated together from the same
start. A start is the truth times a factor from 0.1 to 10, evenly in its logarithm, for the period,
and as far off for amplitude and decay; the phase is anything.

``BicycleParameters``: the period fit of its ``period`` module, the same curve by ``leastsq``; once
from that start in place of its own guess, and once as it is used, from its own guess of a record in
volts. The figure that it draws of each fit is left out.
"""

import time
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any, TypeAlias
from unittest.mock import MagicMock, patch

import numpy as np
from numpy.random import Generator

from analysis.inertia.damped_fit import fit_damped
from hardware.description.arrays import FloatArray

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


Fit: TypeAlias = Callable[[FloatArray, FloatArray, FloatArray], float]
"""Takes times, values and a poor start; returns a period, infinite where it found none."""


def compare_rivals(starts: int = 1000, *, seed: int = 0, truth: Truth | None = None) -> list[Rival]:
    """Fit the same records from the same poor starts with every method; ours is the first."""
    truth = truth or Truth()
    generator = np.random.default_rng(seed)
    methods = {"projection": _own_period, "curve_fit": _curve_fit_period, **_bicycle()}
    outcomes: dict[str, list[tuple[float, float]]] = {name: [] for name in methods}
    for _ in range(starts):
        t, y = truth.record(generator)
        start = _poor_start(truth, generator)
        for name, fit in methods.items():
            began = time.perf_counter()
            period = fit(t, y, start)
            took = time.perf_counter() - began
            outcomes[name].append((period / truth.period_s - 1.0, took))
    return [_rival(name, np.array(rows)) for name, rows in outcomes.items()]


def _own_period(t: FloatArray, y: FloatArray, start: FloatArray) -> float:
    return fit_damped(t, y, start_periods_s=(float(start[0]),)).modes[0].period_s


def _bicycle() -> dict[str, Fit]:
    """Return the rival's fits, where it is installed (extra ``bench``)."""
    try:
        from bicycleparameters import period as module
    except ImportError:
        return {}
    return {
        "BicycleParameters": partial(_bicycle_period, module, None),
        "BicycleParameters, its own guess": partial(_bicycle_period, module, module.make_guess),
    }


def _bicycle_period(
    module: Any, guess: Any, t: FloatArray, y: FloatArray, start: FloatArray
) -> float:
    """Fit as the rival does, from its own guess, or from the poor start in place of it."""
    period, decay, amplitude, phase, offset = start
    omega = 2.0 * np.pi / period
    sine, cosine = -amplitude * np.sin(phase), amplitude * np.cos(phase)
    undamped = np.hypot(omega, decay)
    poor = np.array([offset, sine, cosine, decay / undamped, undamped])
    # its guess leaves out what is within 0.1: it expects volts
    values = y if guess is None else 20.0 * y
    chosen = guess or (lambda data, rate: poor)  # noqa: ARG005
    with (
        warnings.catch_warnings(),
        np.errstate(all="ignore"),
        patch.object(module, "plt", MagicMock()),
        patch.object(module, "plot_osfit"),
        patch.object(module, "make_guess", chosen),
    ):
        module.plt.subplots.return_value = (MagicMock(), MagicMock())
        warnings.simplefilter("ignore")
        try:
            found = module.get_period(values, t, "")
        except (ArithmeticError, ValueError, np.linalg.LinAlgError):
            return float("inf")
    return abs(float(found.nominal_value))


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
