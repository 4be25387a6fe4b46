"""Covariance of the parameters of fitted damped oscillations."""

import numpy as np

from analysis.inertia.elementary_functions import inner
from analysis.inertia.projection import ProjectionProblem, derivative, inverse_gram
from analysis.inertia.residuals import ResidualDiagnostics
from hardware.description.arrays import FloatArray


def covariance(
    problem: ProjectionProblem,
    omega: FloatArray,
    decay: FloatArray,
    matrix: FloatArray,
    linear: FloatArray,
    residual: FloatArray,
    diagnostics: ResidualDiagnostics,
) -> FloatArray:
    """Return the covariance of (T, lambda, A, phi) of each mode in turn and then the base.

    The residual's colour is in it; rows of decay rates that were not fitted are zero.

    Parameters
    ----------
    omega, decay
        Where the fit ended, shape ``(modes,)``.
    matrix, linear, residual
        The model's linear columns there, their parameters, and what is left over.
    """
    count, extra = omega.size, problem.base.shape[1]
    free = ProjectionProblem(problem.time_s, problem.values, problem.base, damped=True)
    slope = derivative(free, matrix, linear)
    jacobian = np.empty((residual.size, 4 * count + extra), order="F")
    for k in range(count):
        jacobian[:, 4 * k], jacobian[:, 4 * k + 1] = slope[:, k], slope[:, count + k]
        jacobian[:, 4 * k + 2 : 4 * k + 4] = matrix[:, 2 * k : 2 * k + 2]
    jacobian[:, 4 * count :] = problem.base
    widen = np.sqrt(
        [*np.repeat(diagnostics.mode_inflation, 4), *[diagnostics.offset_inflation] * extra]
    )
    used = np.ones(widen.size, dtype=bool)
    if not problem.damped:
        used[1 : 4 * count : 4] = False
    freedom = max(residual.size - int(used.sum()), 1)
    small = inverse_gram(jacobian if used.all() else jacobian[:, used]) * (
        inner(residual, residual) / freedom
    )
    raw = np.zeros((used.size, used.size))
    raw[np.ix_(used, used)] = small * np.outer(widen[used], widen[used])
    turn = _to_modes(omega, decay, linear, problem.time_s[0], extra)
    return np.asarray(turn @ raw @ turn.T)


def _to_modes(
    omega: FloatArray, decay: FloatArray, linear: FloatArray, first_s: float, extra: int
) -> FloatArray:
    """Derivative of (T, lambda, A, phi, base) by (omega, lambda, a, b, base)."""
    count = omega.size
    turn = np.eye(4 * count + extra)
    for k in range(count):
        pair = complex(linear[2 * k], -linear[2 * k + 1])
        growth = np.exp((-decay[k] + 1j * omega[k]) * first_s)
        start = pair * growth
        size = max(abs(start), 1e-300)
        # logarithmic derivatives of the complex amplitude at the first sample
        by = np.array([1j * first_s, -first_s, growth / start, -1j * growth / start])
        block = turn[4 * k : 4 * k + 4, 4 * k : 4 * k + 4]
        block[...] = 0.0
        block[0, 0] = -2.0 * np.pi / omega[k] ** 2
        block[1, 1] = 1.0
        block[2] = size * by.real
        block[3] = by.imag
    return turn
