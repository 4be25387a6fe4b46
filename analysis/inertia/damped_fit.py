"""Fit one or several damped oscillations with offset to a record: equations 5 and 15.

    y(t) = y_0 [+ trend t] + sum_j A_j exp(-lambda_j t) cos(2 pi t/T_j + phi_j)

Starting values are found from the spectrum; those that a user gives compete with them, so that a
poor start cannot make a poor fit.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from analysis.inertia.covariance import covariance
from analysis.inertia.projection import (
    NEAR_START,
    ProjectionProblem,
    Solution,
    columns,
    iterate,
    project,
)
from analysis.inertia.residuals import ResidualDiagnostics, diagnose
from analysis.inertia.starting_points import starting_points, thinned
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity

_ROUGH_ITERATIONS = 10  # enough to tell the starts apart
_MATTERS = 0.01  # residual over the first amplitude
_SURE = 4.0  # standard uncertainties of a decay rate that are no growth
_ROUNDING_1_S = 1e-9


@dataclass(frozen=True)
class DampedMode:
    """One damped oscillation ``A exp(-lambda t) cos(2 pi t/T + phi)``, t from the fit's start.

    Attributes
    ----------
    period_s
        The damped period, as observed.
    decay_1_s
        Rate ``lambda``; the time constant is its inverse.
    amplitude
        Not negative, in the record's unit.
    phase_rad
        From -pi to pi.
    """

    period_s: float
    decay_1_s: float
    amplitude: float
    phase_rad: float

    @property
    def damping_ratio(self) -> float:
        """Damping over critical damping."""
        omega = 2.0 * math.pi / self.period_s
        return self.decay_1_s / math.hypot(self.decay_1_s, omega)


@dataclass(frozen=True)
class DampedFit:
    """A fit with its covariance.

    Attributes
    ----------
    modes
        Longest period first.
    offset
        ``y_0`` at the middle of the record; 0 where none was fitted.
    trend
        Change of the base from the middle to the end of the record; 0 where none was fitted.
    covariance
        Of (T, lambda, A, phi) of each mode in turn and then the base's columns, shape ``(P, P)``;
        the colour of the residual is in it.
    residual, time_s
        What is left, shape ``(samples,)``, and when.
    start_s
        Where amplitudes and phases are counted from: the first sample's time.
    """

    modes: tuple[DampedMode, ...]
    offset: float
    trend: float
    covariance: FloatArray
    diagnostics: ResidualDiagnostics
    converged: bool
    iterations: int
    start_s: float
    time_s: FloatArray
    residual: FloatArray
    flags: tuple[Flag, ...] = ()

    def period_uncertainty_s(self, mode: int = 0) -> float:
        """Standard uncertainty of a period from this fit alone: never a budget's only line."""
        return float(np.sqrt(self.covariance[4 * mode, 4 * mode]))

    def values(self, time_s: FloatArray) -> FloatArray:
        """Return the fitted oscillations with offset (without a trend) at some times."""
        t = np.asarray(time_s) - self.start_s
        total = np.full(t.shape, self.offset)
        for mode in self.modes:
            angle = 2.0 * np.pi * t / mode.period_s + mode.phase_rad
            total = total + mode.amplitude * np.exp(-mode.decay_1_s * t) * np.cos(angle)
        return total


def fit_damped(
    time_s: FloatArray,
    values: FloatArray,
    *,
    modes: int = 1,
    offset: bool = True,
    trend: bool = False,
    damped: bool = True,
    start_periods_s: Sequence[float] | None = None,
    where: str = "record",
) -> DampedFit:
    """Fit damped oscillations.

    Parameters
    ----------
    time_s, values
        Shape ``(samples,)``; NaN where a sample is missing.
    modes
        How many oscillations.
    offset, trend, damped
        Whether a constant, a line (with the constant only) and decay rates are fitted.
    start_periods_s
        A user's guess, one per mode; it may be far off.

    Raises
    ------
    DataError
        For fewer samples than twice the parameters, or less than one and a half cycles.
    """
    problem, start_s = _problem(time_s, values, offset, trend, damped, modes, where)
    coarse = thinned(problem)
    starts = starting_points(coarse, modes, start_periods_s)
    rough = [iterate(coarse, omega, decay, _ROUGH_ITERATIONS) for omega, decay in starts]
    best = min(rough, key=lambda solution: solution.cost)
    solution = iterate(coarse, best.omega_rad_s, best.decay_1_s)
    if coarse is not problem:
        start = solution.omega_rad_s, solution.decay_1_s
        solution = iterate(problem, *start, damping=NEAR_START)
    return _finish(problem, solution, start_s, where)


def _problem(
    time_s: FloatArray,
    values: FloatArray,
    offset: bool,
    trend: bool,
    damped: bool,
    modes: int,
    where: str,
) -> tuple[ProjectionProblem, float]:
    good = np.isfinite(values)
    t, y = np.asarray(time_s)[good], np.asarray(values, dtype=np.float64)[good]
    unknown = 4 * modes + offset + trend
    if y.size < 2 * unknown:
        raise DataError(
            f"{where}: {y.size} samples for {unknown} unknowns; at least {2 * unknown} are needed: "
            "record longer or faster"
        )
    if not np.ptp(y) > 0.0:
        raise DataError(
            f"{where}: the signal is constant ({y[0]:g}); nothing swings on this channel"
        )
    middle = 0.5 * (t[0] + t[-1])
    centred = t - middle
    base = [np.ones(t.size)] if offset else []
    base += [centred / centred[-1]] if offset and trend else []
    columns_ = np.column_stack(base) if base else np.empty((t.size, 0))
    return ProjectionProblem(centred, y, columns_, damped), float(t[0])


def _finish(
    problem: ProjectionProblem, solution: Solution, start_s: float, where: str
) -> DampedFit:
    cycles = solution.omega_rad_s * problem.span_s / (2.0 * np.pi)
    if cycles.min() < 1.5:
        raise DataError(
            f"{where}: {cycles.min():.2g} cycle(s) in {problem.span_s:.3g} s; at least 1.5 are "
            "needed to tell a period: too few swings, record longer"
        )
    order = np.argsort(solution.omega_rad_s)
    omega, decay = solution.omega_rad_s[order], solution.decay_1_s[order]
    matrix = columns(problem, omega, decay)
    linear, residual, _ = project(problem, matrix)
    diagnostics = diagnose(residual, problem.time_s, omega / (2.0 * np.pi))
    modes = tuple(
        _mode(float(w), float(rate), linear[2 * k : 2 * k + 2], problem.time_s[0])
        for k, (w, rate) in enumerate(zip(omega, decay, strict=True))
    )
    base = linear[2 * omega.size :]
    spread = covariance(problem, omega, decay, matrix, linear, residual, diagnostics)
    growth = np.array([-mode.decay_1_s for mode in modes])
    of_noise = _SURE * np.sqrt(np.diag(spread)[1 : 4 * omega.size : 4]) + _ROUNDING_1_S
    return DampedFit(
        modes=modes,
        offset=float(base[0]) if base.size else 0.0,
        trend=float(base[1]) if base.size > 1 else 0.0,
        covariance=spread,
        diagnostics=diagnostics,
        converged=solution.converged,
        iterations=solution.iterations,
        start_s=start_s,
        time_s=problem.time_s - problem.time_s[0] + start_s,
        residual=residual,
        flags=_flags(solution, diagnostics, modes, where, grows=bool((growth > of_noise).any())),
    )


def _mode(omega: float, decay: float, pair: FloatArray, first_s: float) -> DampedMode:
    """Turn amplitudes at mid-record into amplitude and phase at the first sample."""
    start = complex(pair[0], -pair[1]) * np.exp((-decay + 1j * omega) * first_s)
    return DampedMode(2.0 * math.pi / omega, decay, float(abs(start)), float(np.angle(start)))


def _flags(
    solution: Solution,
    diagnostics: ResidualDiagnostics,
    modes: tuple[DampedMode, ...],
    where: str,
    *,
    grows: bool,
) -> tuple[Flag, ...]:
    flags = []
    if not solution.converged:
        message = (
            f"{where}: the fit had not settled after {solution.iterations} iterations; its numbers "
            "are not to be used: look at the record"
        )
        flags.append(Flag("not_converged", Severity.VOID, message))
    if diagnostics.structured:
        residual_share = diagnostics.rms / max(mode.amplitude for mode in modes)
        message = (
            f"{where}: the residual is {diagnostics.structure:.3g} times as strong near the "
            f"oscillation as beside it, and {100.0 * residual_share:.2g} % of the first amplitude: "
            "period or decay change with amplitude, or another mode is there; extrapolate to zero "
            "amplitude, fit one mode more, or ask `pmm gap pendulum` which friction or drag it is"
        )
        severity = Severity.WARNING if residual_share > _MATTERS else Severity.NOTE
        flags.append(Flag("structured_residual", severity, message))
    if grows:
        message = f"{where}: an oscillation grows; the record is not a free decay from here on"
        flags.append(Flag("growing", Severity.WARNING, message))
    return tuple(flags)
