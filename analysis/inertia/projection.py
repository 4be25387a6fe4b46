"""Variable projection: damped sinusoids whose linear amplitudes are eliminated.

For any periods and decays the best amplitudes, phases and base (offset, trend) follow from one
linear solve. Only the angular frequencies and the decay rates are iterated, by Levenberg's and
Marquardt's method with Kaufman's derivative of the projected residual.
"""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from analysis.inertia.elementary_functions import inner
from hardware.description.arrays import ComplexArray, FloatArray, IntArray

MOST_ITERATIONS = 60
DAMPED_START, NEAR_START = 1e-3, 1e-9  # of the method's own damping: from far off, from close by
CONVERGED = 1e-13  # relative change of the sum of squares, with a step below 1e-9 of a bin


@dataclass(frozen=True)
class ProjectionProblem:
    """A record, and the columns that are fitted to it.

    Attributes
    ----------
    time_s
        Shape ``(samples,)``, counted from the middle of the record.
    values
        Shape ``(samples,)``, without missing samples.
    base
        Columns that are always there (offset, trend), shape ``(samples, B)``; B may be 0.
    damped
        Whether the decay rates are free; they are zero otherwise.
    """

    time_s: FloatArray
    values: FloatArray
    base: FloatArray
    damped: bool = True

    @property
    def span_s(self) -> float:
        """Time from the first to the last sample."""
        return float(self.time_s[-1] - self.time_s[0])

    @cached_property
    def places(self) -> "IntArray | None":
        """Each sample's place on the even grid that all lie on; None where there is no such grid.

        Gaps may be in it. A billionth of an interval is allowed: that turns no phase.
        """
        t = self.time_s
        step = float(np.diff(t).min())
        places = np.rint((t - t[0]) / step).astype(np.int64)
        if places[-1] > 4 * t.size:
            return None
        deviation_s = places * (self.span_s / float(places[-1])) + t[0] - t
        return places if max(deviation_s.max(), -deviation_s.min()) < 1e-9 * step else None


@dataclass(frozen=True)
class Solution:
    """Result of the iteration.

    Attributes
    ----------
    omega_rad_s, decay_1_s
        Shape ``(modes,)``.
    linear
        Amplitudes of cosine and sine of each mode at mid-record, then the base's, shape
        ``(2 modes + B,)``.
    cost
        Sum of squared residuals.
    """

    omega_rad_s: FloatArray
    decay_1_s: FloatArray
    linear: FloatArray
    cost: float
    converged: bool
    iterations: int


def columns(problem: ProjectionProblem, omega: FloatArray, decay: FloatArray) -> FloatArray:
    """Return the model's linear columns, shape ``(samples, 2 modes + B)``."""
    count = omega.size
    matrix = np.empty((problem.time_s.size, 2 * count + problem.base.shape[1]), order="F")
    for k, (w, rate) in enumerate(zip(omega, decay, strict=True)):
        wave = _wave(problem, complex(-rate, w))
        matrix[:, 2 * k], matrix[:, 2 * k + 1] = wave.real, wave.imag
    matrix[:, 2 * count :] = problem.base
    return matrix


def _wave(problem: ProjectionProblem, exponent: complex) -> ComplexArray:
    """Return ``exp(exponent t)``: on a grid, as products of a coarse one's and a fine one's."""
    places = problem.places
    if places is None:
        return np.asarray(np.exp(exponent * problem.time_s))
    size = int(places[-1]) + 1
    step_s = problem.span_s / max(size - 1, 1)
    fine = math.isqrt(size) + 1
    within = np.exp(exponent * step_s * np.arange(fine))
    blocks = step_s * fine * np.arange(-(-size // fine)) + problem.time_s[0]
    wave = np.multiply.outer(np.exp(exponent * blocks), within).ravel()
    return np.asarray(wave[:size] if size == places.size else wave[places])


def project(
    problem: ProjectionProblem, matrix: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the linear parameters, the residual, and the inverse of the columns' Gram matrix."""
    inverse = inverse_gram(matrix)
    linear = inverse @ (matrix.T @ problem.values)
    return linear, problem.values - matrix @ linear, inverse


def inverse_gram(matrix: FloatArray) -> FloatArray:
    """Return the (pseudo-)inverse of ``matrix^T matrix``, whatever the columns' sizes are."""
    gram = matrix.T @ matrix
    scale = np.sqrt(np.diag(gram))
    scale[scale == 0.0] = 1.0
    values, vectors = np.linalg.eigh(gram / np.outer(scale, scale))
    usable = values > 1e-15 * values[-1]
    turned = vectors[:, usable] / scale[:, np.newaxis]
    return np.asarray((turned / values[usable]) @ turned.T)


def derivative(problem: ProjectionProblem, matrix: FloatArray, linear: FloatArray) -> FloatArray:
    """Return the model's slope in each frequency, then in each decay rate."""
    count = (matrix.shape[1] - problem.base.shape[1]) // 2
    slope = np.empty((matrix.shape[0], 2 * count if problem.damped else count), order="F")
    for k in range(count):
        cosine, sine = matrix[:, 2 * k], matrix[:, 2 * k + 1]
        a, b = linear[2 * k], linear[2 * k + 1]
        slope[:, k] = problem.time_s * (b * cosine - a * sine)
        if problem.damped:
            slope[:, count + k] = problem.time_s * (-a * cosine - b * sine)
    return slope


def iterate(
    problem: ProjectionProblem,
    omega: FloatArray,
    decay: FloatArray,
    most_iterations: int = MOST_ITERATIONS,
    *,
    damping: float = DAMPED_START,
) -> Solution:
    """Improve periods and decays until the sum of squares stands still.

    Frequencies stay above a quarter cycle per record and decay rates within 40 per record, so that
    no column vanishes or overflows.
    """
    count = omega.size
    place = np.concatenate([omega, decay])
    matrix = columns(problem, place[:count], place[count:])
    linear, residual, inverse = project(problem, matrix)
    cost, converged, turn = inner(residual, residual), False, 0
    while turn < most_iterations and not converged and damping < 1e12:
        turn += 1
        slope = derivative(problem, matrix, linear)
        for column in slope.T:  # one by one: see inner
            column -= matrix @ (inverse @ (matrix.T @ column))
        step = _step(slope, residual, damping)
        trial = _bounded(place, step, count, problem.span_s)
        trial_matrix = columns(problem, trial[:count], trial[count:])
        trial_linear, trial_residual, trial_inverse = project(problem, trial_matrix)
        trial_cost = inner(trial_residual, trial_residual)
        small = np.abs(trial - place).max() * problem.span_s < 1e-9
        converged = bool(small or abs(cost - trial_cost) <= CONVERGED * cost)
        if trial_cost <= cost:
            place, matrix, linear = trial, trial_matrix, trial_linear
            residual, inverse, cost = trial_residual, trial_inverse, trial_cost
            damping = max(damping / 10.0, 1e-12)
        else:
            damping *= 8.0
    return Solution(place[:count], place[count:], linear, cost, converged, turn)


def _step(slope: FloatArray, residual: FloatArray, damping: float) -> FloatArray:
    gram = slope.T @ slope
    strength = np.diag(gram).copy()
    strength[strength == 0.0] = 1.0
    return np.asarray(np.linalg.solve(gram + damping * np.diag(strength), slope.T @ residual))


def _bounded(place: FloatArray, step: FloatArray, count: int, span_s: float) -> FloatArray:
    trial = place.copy()
    trial[: step.size] += step
    omega = np.maximum(np.abs(trial[:count]), 0.5 * np.pi / span_s)
    decay = np.clip(trial[count:], -5.0 / span_s, 40.0 / span_s)
    return np.concatenate([omega, decay])
