"""Rational functions whose damping is nowhere negative.

With the poles fixed the damping is linear in the residues, so that the best passive residues are a
convex problem. It is solved by cuts: wherever the damping of a fit is negative, in whatever
combination of the degrees of freedom, it is asked not to be, until it is not. Gauss-Newton
steps then move the poles under the same conditions.
"""

from dataclasses import replace
from typing import Final

import numpy as np

from hardware.description.arrays import ComplexArray, FloatArray, IntArray
from sim.model.water.vector_fitting import (
    Cuts,
    PartialFractions,
    SampledTable,
    admissible,
    basis,
    fitted_residues,
    moved_poles,
)

_ROUNDS: Final = 12
_STEPS: Final = 12
_WORST: Final = 10  # cuts of a round: of rounding there would be any number
_SETTLED: Final = 0.01  # relative gain of a step that is none
_STIFFEST: Final = 1e4
_POINTS: Final = 400  # frequencies at which the damping is looked at, beside those of the poles
_FAR: Final = 1e3  # how far these reach beyond the table and the poles, as a factor
_MARGIN: Final = 2e-6  # least damping, relative to the peak, in the shape of the poles' own


def passive_fit(samples: SampledTable, poles: ComplexArray) -> PartialFractions:
    """Return the best fit without negative damping that has these poles, or moved ones.

    Parameters
    ----------
    samples
        Of 1 element, or of 3: the symmetric matrix of two degrees of freedom as 11, 12, 22, in
        units in which both are of the same size.
    """
    none = (np.zeros(0), np.zeros((0, len(samples.values))))
    fit, cuts = _passive(samples, poles, *none)
    least, stiffness = fit.misfit(samples), 1e-2
    size = np.sqrt(2.0 * samples.values.size)
    for _ in range(_STEPS):
        cost = np.sqrt(stiffness) * size * least
        _, motion = fitted_residues(samples, fit.poles, cuts, fit.residues, cost)
        moved = admissible(samples, moved_poles(fit.poles, motion))
        tried, more = _passive(samples, moved, cuts.omega, cuts.factors)
        misfit = tried.misfit(samples)
        if not misfit < least:
            stiffness *= 10.0
            if stiffness > _STIFFEST:
                break
            continue
        gain, fit, cuts = 1.0 - misfit / least, tried, more
        least, stiffness = misfit, stiffness / 5.0
        if gain < _SETTLED:
            break
    return fit


def _passive(
    samples: SampledTable, poles: ComplexArray, omega: FloatArray, factors: FloatArray
) -> tuple[PartialFractions, Cuts]:
    """Return the best passive residues of given poles, and the cuts that it took.

    Parameters
    ----------
    omega, factors
        Of cuts to begin with.
    """
    floor = _least_residues(samples, poles)
    identity = np.array([1.0] if factors.shape[1] == 1 else [1.0, 0.0, 1.0])  # all directions alike
    for _ in range(_ROUNDS):
        cuts = Cuts(omega, factors, 1.5 * (factors @ identity) * (_damping(poles, omega) @ floor))
        fit, _ = fitted_residues(samples, poles, cuts)
        watched = _watched_frequencies(samples, poles, omega)
        rows = _damping(poles, watched)
        lowest, directions = _lowest(rows @ fit.residues.T / (rows @ floor)[:, None])
        bad = _minima(lowest)
        if not bad.size:
            return fit, cuts
        omega = np.concatenate([omega, watched[bad]])
        factors = np.concatenate([factors, _factors(directions[bad])])
    missing = max(0.0, 1.0 - float(lowest.min()))
    return replace(fit, residues=fit.residues + missing * np.outer(identity, floor)), cuts


def _damping(poles: ComplexArray, omega: FloatArray) -> FloatArray:
    """Return the damping of each function, Re(s M) = -w Im M, shape ``(k, n)``."""
    return -omega[:, None] * basis(poles, omega).imag


def _lowest(damping: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the lowest eigenvalue of damping ``(k, e)``, and its direction ``(k, m)``."""
    if damping.shape[1] == 1:
        return damping[:, 0], np.ones((len(damping), 1))
    values, vectors = np.linalg.eigh(damping[:, [[0, 1], [1, 2]]])
    return values[:, 0], vectors[:, :, 0]


def _factors(directions: FloatArray) -> FloatArray:
    """Return what the elements of a symmetric matrix count along directions ``(c, m)``."""
    if directions.shape[1] == 1:
        return directions**2
    first, second = directions.T
    return np.stack([first**2, 2.0 * first * second, second**2], axis=1)


def _watched_frequencies(
    samples: SampledTable, poles: ComplexArray, cuts: FloatArray
) -> FloatArray:
    """Return where the damping is looked at: closely about the cuts, at which it touches zero."""
    spread = np.geomspace(
        min(samples.omega[0], np.abs(poles).min()) / _FAR,
        max(samples.omega[-1], np.abs(poles).max()) * _FAR,
        _POINTS,
    )
    near = (poles.imag + np.abs(poles.real) * np.linspace(-3.0, 3.0, 13)[:, None]).ravel()
    close = (cuts * np.linspace(0.97, 1.03, 25)[:, None]).ravel()
    return np.unique(np.concatenate([spread, samples.omega, near[near > 0.0], close]))


def _least_residues(samples: SampledTable, poles: ComplexArray) -> FloatArray:
    """Return the residues of the least damping, shape ``(n,)``: of s/((s - p)(s - q)).

    Summed over conjugate poles p, q; two real ones where there are none. Its damping is positive at
    every frequency, and goes to zero as any does.
    """
    pairs = poles[poles.imag != 0.0]
    shape = np.zeros(poles.size + pairs.size)
    # 1/((s - p)(s - p*)) is the pair's odd function over -2 Im p; its peak damping 1/(2 |Re p|)
    shape[poles.size :] = pairs.real / pairs.imag
    if not pairs.size:
        first, second = poles.real[:2]
        shape[:2] = abs(first + second) / (first - second) * np.array([1.0, -1.0])
    peak = np.abs(samples.values.imag * samples.omega).max()
    return _MARGIN * float(peak) * shape


def _minima(lowest: FloatArray) -> IntArray:
    """Return where the lowest is below the least and not above its neighbours, the worst first."""
    padded = np.pad(lowest, 1, constant_values=np.inf)
    lower = np.flatnonzero((lowest <= padded[:-2]) & (lowest <= padded[2:]) & (lowest < 1.0))
    return lower[np.argsort(lowest[lower])][:_WORST]
