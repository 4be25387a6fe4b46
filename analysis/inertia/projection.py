"""Variable projection: damped sinusoids whose linear amplitudes are eliminated.

For any periods and decays the best amplitudes, phases and base (offset, trend) follow from one
linear solve. Only the angular frequencies and the decay rates are iterated, by Levenberg's and
Marquardt's method with Kaufman's derivative of the projected residual.
"""

from dataclasses import dataclass

import numpy as np

from analysis.inertia.numeric import FloatArray

MOST_ITERATIONS = 60
CONVERGED = 1e-13  # relative change of the sum of squares, with a step below 1e-9 of a bin


@dataclass(frozen=True)
class Problem:
    """What is fitted to what.

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


@dataclass(frozen=True)
class Solution:
    """Where the iteration ended.

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


def columns(problem: Problem, omega: FloatArray, decay: FloatArray) -> FloatArray:
    """Return the model's linear columns, shape ``(samples, 2 modes + B)``."""
    count = omega.size
    matrix = np.empty((problem.time_s.size, 2 * count + problem.base.shape[1]), order="F")
    for k, (w, rate) in enumerate(zip(omega, decay, strict=True)):
        wave = np.exp((-rate + 1j * w) * problem.time_s)
        matrix[:, 2 * k], matrix[:, 2 * k + 1] = wave.real, wave.imag
    matrix[:, 2 * count :] = problem.base
    return matrix


def project(problem: Problem, matrix: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the linear parameters, the residual, and the inverse of the columns' Gram matrix."""
    scale = np.sqrt(np.einsum("ij,ij->j", matrix, matrix))
    scale[scale == 0.0] = 1.0
    gram = (matrix.T @ matrix) / np.outer(scale, scale)
    inverse = np.linalg.pinv(gram, hermitian=True) / np.outer(scale, scale)
    linear = inverse @ (matrix.T @ problem.values)
    return linear, problem.values - matrix @ linear, inverse


def derivative(problem: Problem, matrix: FloatArray, linear: FloatArray) -> FloatArray:
    """Return the model's slope in each frequency, then in each decay rate."""
    count = (matrix.shape[1] - problem.base.shape[1]) // 2
    by_omega, by_decay = [], []
    for k in range(count):
        cosine, sine = matrix[:, 2 * k], matrix[:, 2 * k + 1]
        a, b = linear[2 * k], linear[2 * k + 1]
        by_omega.append(problem.time_s * (b * cosine - a * sine))
        by_decay.append(-problem.time_s * (a * cosine + b * sine))
    return np.column_stack(by_omega + (by_decay if problem.damped else []))


def iterate(
    problem: Problem,
    omega: FloatArray,
    decay: FloatArray,
    most_iterations: int = MOST_ITERATIONS,
) -> Solution:
    """Improve periods and decays until the sum of squares stands still.

    Frequencies stay above a quarter cycle per record and decay rates within 40 per record, so that
    no column vanishes or overflows.
    """
    count, damping = omega.size, 1e-3
    place = np.concatenate([omega, decay])
    matrix = columns(problem, place[:count], place[count:])
    linear, residual, inverse = project(problem, matrix)
    cost, converged, turn = float(residual @ residual), False, 0
    while turn < most_iterations and not converged and damping < 1e12:
        turn += 1
        slope = derivative(problem, matrix, linear)
        slope -= matrix @ (inverse @ (matrix.T @ slope))
        step = _step(slope, residual, damping)
        trial = _bounded(place, step, count, problem.span_s)
        trial_matrix = columns(problem, trial[:count], trial[count:])
        trial_linear, trial_residual, trial_inverse = project(problem, trial_matrix)
        trial_cost = float(trial_residual @ trial_residual)
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
