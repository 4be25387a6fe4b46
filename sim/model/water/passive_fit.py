"""Rational functions whose damping is nowhere negative.

With the poles fixed the damping is linear in the residues, so that the best passive residues are a
convex problem. It is solved by cuts: wherever the damping of a fit is negative, in whatever
combination of the degrees of freedom, it is asked not to be, until it is not. Gauss-Newton
steps then move the poles under the same conditions.
"""

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from hardware.description.arrays import ComplexArray, FloatArray, IntArray
from sim.model.water.conditions import least_squares
from sim.model.water.vector_fitting import (
    PartialFractions,
    SampledTable,
    admissible,
    basis,
    input_column,
    moved_poles,
    pole_slopes,
    sum_free,
)

_ROUNDS: Final = 12
_STEPS: Final = 12
_SETTLED: Final = 0.01  # relative gain of a step that is none
_STIFFEST: Final = 1e4
_POINTS: Final = 400  # frequencies at which the damping is looked at, beside those of the poles
_FAR: Final = 1e3  # how far these reach beyond the table and the poles, as a factor
_MARGIN: Final = 2e-6  # least damping, relative to the peak, in the shape of the poles' own


@dataclass(frozen=True, eq=False)
class _Cuts:
    """Where, and along what, the damping is asked to be the least.

    Attributes
    ----------
    omega
        Shape ``(c,)``.
    factors
        What the elements count along that direction, shape ``(c, e)``.
    """

    omega: FloatArray
    factors: FloatArray

    def joined(self, omega: FloatArray, factors: FloatArray) -> "_Cuts":
        """Return these and more."""
        return _Cuts(np.concatenate([self.omega, omega]), np.concatenate([self.factors, factors]))


def passive_fit(samples: SampledTable, poles: ComplexArray) -> PartialFractions:
    """Return the best fit without negative damping that has these poles, or moved ones.

    Parameters
    ----------
    samples
        Of 1 element, or of 3: the symmetric matrix of two degrees of freedom as 11, 12, 22, in
        units in which both are of the same size.
    """
    elements = len(samples.values)
    none = _Cuts(np.zeros(0), np.zeros((0, elements)))
    return _refined(samples, *_passive(samples, poles, none))


def _refined(samples: SampledTable, found: PartialFractions, cuts: _Cuts) -> PartialFractions:
    """Return the fit after Gauss-Newton steps of poles and residues under the conditions."""
    least, stiffness = found.misfit(samples), 1e-2
    for _ in range(_STEPS):
        _, motion = _solved(samples, found.poles, cuts, found, stiffness)
        poles = admissible(samples, moved_poles(found.poles, motion))
        tried, more = _passive(samples, poles, cuts)
        misfit = tried.misfit(samples)
        if not misfit < least:
            stiffness *= 10.0
            if stiffness > _STIFFEST:
                break
            continue
        gain, found, cuts = 1.0 - misfit / least, tried, more
        least, stiffness = misfit, stiffness / 5.0
        if gain < _SETTLED:
            break
    return found


def _passive(
    samples: SampledTable, poles: ComplexArray, cuts: _Cuts
) -> tuple[PartialFractions, _Cuts]:
    """Return the best passive residues of given poles, and the cuts that it took."""
    for _ in range(_ROUNDS):
        watch = _watched(samples, poles, cuts.omega)
        found, _ = _solved(samples, poles, cuts)
        lowest, directions = watch.lowest(found.residues)
        bad = _minima(lowest)
        if not bad.size:
            return found, cuts
        cuts = cuts.joined(watch.omega[bad], _factors(directions[bad]))
    missing = max(0.0, 1.0 - float(lowest.min()))
    return replace(found, residues=found.residues + missing * watch.least), cuts


def _solved(
    samples: SampledTable,
    poles: ComplexArray,
    cuts: _Cuts,
    around: PartialFractions | None = None,
    stiffness: float = 0.0,
) -> tuple[PartialFractions, FloatArray]:
    """Return the best residues under the cuts, and what the poles move by.

    Parameters
    ----------
    around
        Residues about which the poles may move; ``None`` where they stay.
    stiffness
        What a motion of a pole by its own size costs, relative to the misfit of ``around``.
    """
    free, elements = sum_free(poles), len(samples.values)
    known = samples.infinite
    size = free.shape[1] + (known is None)
    moving = 0 if around is None else len(free)
    system, target = [], []
    conditions = np.zeros((len(cuts.omega), elements * size + moving))
    functions, at = basis(poles, samples.omega) @ free, basis(poles, cuts.omega) @ free
    for e, values in enumerate(samples.values):
        own = np.zeros((len(samples.omega), conditions.shape[1]), complex)
        first = slice(e * size, e * size + free.shape[1])
        own[:, first] = functions
        conditions[:, first] = -cuts.omega[:, None] * at.imag * cuts.factors[:, e, None]
        if known is None:
            own[:, (e + 1) * size - 1] = 1.0
        if around is not None:
            slopes = pole_slopes(poles, around.residues[e], samples.omega)
            own[:, elements * size :] = slopes
            there = pole_slopes(poles, around.residues[e], cuts.omega).imag
            conditions[:, elements * size :] -= (
                cuts.omega[:, None] * there * cuts.factors[:, e, None]
            )
        system.append(samples.weighted(e, own))
        target.append(samples.weighted(e, values if known is None else values - known[e]))
    if around is not None:
        cost = np.zeros((moving, conditions.shape[1]))
        total = np.sqrt(samples.values.size * 2.0) * around.misfit(samples)
        each = np.repeat(np.abs(poles), np.where(poles.imag == 0.0, 1, 2))
        cost[:, elements * size :] = np.diag(np.sqrt(stiffness) * total / each)
        system.append(cost)
        target.append(np.zeros(moving))
    least = _least(samples, poles, cuts.omega) * cuts.factors[:, [0, -1]].sum(axis=1)
    if elements == 1:
        least = least / 2.0
    x = least_squares(np.vstack(system), np.concatenate(target), conditions, least)
    parts = x[: elements * size].reshape(elements, size)
    residues = parts[:, : free.shape[1]] @ free.T
    infinite = parts[:, -1] if known is None else known
    return PartialFractions(poles, residues, infinite), x[elements * size :]


@dataclass(frozen=True, eq=False)
class _Watched:
    """Damping over frequency in units of the least that is asked for.

    Attributes
    ----------
    omega
        Shape ``(g,)``.
    rows
        Damping at each frequency of each function, in that unit, shape ``(g, n)``.
    least
        Residues of what is asked for at least, shape ``(e, n)``.
    """

    omega: FloatArray
    rows: FloatArray
    least: FloatArray

    def lowest(self, residues: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the lowest eigenvalue of the damping, ``(g,)``, and its direction ``(g, m)``."""
        damping = self.rows @ residues.T
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


def _watched(samples: SampledTable, poles: ComplexArray, cuts: FloatArray) -> _Watched:
    """Return where the damping is looked at: closely about the cuts, at which it touches zero."""
    spread = np.geomspace(
        min(samples.omega[0], np.abs(poles).min()) / _FAR,
        max(samples.omega[-1], np.abs(poles).max()) * _FAR,
        _POINTS,
    )
    near = (poles.imag + np.abs(poles.real) * np.linspace(-3.0, 3.0, 13)[:, None]).ravel()
    close = (cuts * np.linspace(0.97, 1.03, 25)[:, None]).ravel()
    omega = np.unique(np.concatenate([spread, samples.omega, near[near > 0.0], close]))
    rows = -omega[:, None] * basis(poles, omega).imag  # B = Re(s M) = -w Im M
    least = _least_residues(samples, poles)
    own = [1.0] if len(samples.values) == 1 else [1.0, 0.0, 1.0]
    return _Watched(omega, rows / (rows @ least)[:, None], np.outer(own, least))


def _least(samples: SampledTable, poles: ComplexArray, omega: FloatArray) -> FloatArray:
    """Return the damping that a cut asks for: a little more than the least."""
    rows = -omega[:, None] * basis(poles, omega).imag
    least: FloatArray = 1.5 * (rows @ _least_residues(samples, poles))
    return least


def _least_residues(samples: SampledTable, poles: ComplexArray) -> FloatArray:
    """Return the residues of the least damping, shape ``(n,)``: of the sum of s/((s - p)(s - q)).

    The sum is over pairs p, q: two conjugate poles, or two real ones that follow each other. Its
    damping is positive at every frequency, and goes to zero as any does.
    """
    real, pairs = poles[poles.imag == 0.0].real, poles[poles.imag > 0.0]
    shape = np.zeros(len(input_column(poles)))
    for i in range(1, real.size):
        strength = abs(real[i - 1] + real[i]) / (real[i - 1] - real[i])
        shape[i - 1] += strength
        shape[i] -= strength
    # 1/((s - p)(s - p*)) is the pair's odd function over -2 Im p; its peak damping 1/(2 |Re p|)
    shape[real.size + 1 :: 2] -= np.abs(pairs.real) / pairs.imag
    peak = np.abs(samples.values.imag * samples.omega).max()
    return _MARGIN * float(peak) * shape


def _minima(lowest: FloatArray) -> IntArray:
    """Return where the lowest is below the least and not above its neighbours."""
    padded = np.pad(lowest, 1, constant_values=np.inf)
    lower = (lowest <= padded[:-2]) & (lowest <= padded[2:]) & (lowest < 1.0)
    return np.flatnonzero(lower)
