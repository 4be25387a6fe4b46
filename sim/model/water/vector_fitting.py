"""Rational functions by relaxed vector fitting: linear least squares that move the poles.

Fitted is the complex added mass M(s) = Z(s)/s = A + B/(i w) at s = i w, as

    M(s) = A_inf + sum_n R_n / (s - p_n)        sum_n R_n = 0

for a symmetric matrix of m degrees of freedom with common poles. The memory K = s (M - A_inf) then
is 0 at s = 0, and strictly proper because the residues add up to zero: K = sum_n p_n R_n/(s - p_n).
An iteration finds s(w) M and s(w) on the same poles; the zeros of the latter are the next poles
(Gustavsen and Semlyen, IEEE Trans. Power Delivery 14(3), 1999; relaxed: Gustavsen, 21(3), 2006).
"""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.linalg import block_diag

from hardware.description.arrays import ComplexArray, FloatArray
from sim.model.water.conditions import least_squares

_ITERATIONS: Final = 12
_SETTLED: Final = 1e-3  # relative improvement of an iteration that is none
# Rate, relative to the lowest frequency, at which every state has to fade at least; and what
# relative to the highest frequency none exceeds.
_SLOWEST_FADING: Final = 0.05
_FASTEST: Final = 20.0
_APART: Final = 1e-3  # relative distance of real poles


@dataclass(frozen=True, eq=False)
class SampledTable:
    """What is to be fitted: e elements of a symmetric matrix at k frequencies.

    Attributes
    ----------
    omega
        Shape ``(k,)``, rising, above 0.
    values
        A + B/(i w), shape ``(e, k)``.
    weights
        What deviations of real parts, then of imaginary ones are multiplied with, ``(e, 2 k)``.
    infinite
        Value at infinite frequency, shape ``(e,)``; ``None`` where it is fitted along.
    steady
        Whether a damping that is the same at all frequencies is fitted along.
    """

    omega: FloatArray
    values: ComplexArray
    weights: FloatArray
    infinite: FloatArray | None
    steady: bool = False

    def weighted(self, element: int, functions: ComplexArray) -> FloatArray:
        """Return real and imaginary parts of ``(k, ...)`` one below the other, weighted."""
        parts = np.concatenate([functions.real, functions.imag])
        return np.asarray((parts.T * self.weights[element]).T, np.float64)

    @property
    def sought(self) -> ComplexArray:
        """The values, less the end value where it is known, shape ``(e, k)``."""
        return self.values if self.infinite is None else self.values - self.infinite[:, None]

    def with_ends(self, functions: ComplexArray) -> ComplexArray:
        """Return functions, and beside them those of end value and steady damping fitted along."""
        end_values = np.ones((len(functions), int(self.infinite is None)))
        falling = (1.0 / (1j * self.omega))[:, None][:, : int(self.steady)]
        return np.hstack([functions, end_values, falling])


@dataclass(frozen=True, eq=False)
class PartialFractions:
    """Poles with a non-negative imaginary part, and what is fitted to them.

    Attributes
    ----------
    poles
        Shape ``(q,)``: real ones, and one of each conjugate pair.
    residues
        Real numbers for the functions of :func:`basis`, shape ``(e, n)``.
    infinite, steady
        End values, and damping that is the same at all frequencies, each of shape ``(e,)``.
    """

    poles: ComplexArray
    residues: FloatArray
    infinite: FloatArray
    steady: FloatArray

    def ends(self, omega: FloatArray) -> ComplexArray:
        """Return what end values and steady damping make of the values, shape ``(e, k)``."""
        return np.asarray(self.infinite[:, None] + self.steady[:, None] / (1j * omega))

    def deviations(self, samples: SampledTable) -> FloatArray:
        """Return the weighted deviations from the samples, shape ``(e, 2 k)``."""
        fitted = self.residues @ basis(self.poles, samples.omega).T + self.ends(samples.omega)
        return np.array([samples.weighted(e, row) for e, row in enumerate(fitted - samples.values)])

    def misfit(self, samples: SampledTable) -> float:
        """Return the root mean square of the weighted deviations."""
        return float(np.sqrt(np.mean(self.deviations(samples) ** 2)))


def basis(
    poles: ComplexArray, omega: FloatArray, strength: ComplexArray | float = 1.0, power: int = 1
) -> ComplexArray:
    """Return 1/(s - p), of pairs 1/(s - p) + 1/(s - p*), then i/(s - p) - i/(s - p*) of pairs.

    At s = i w, shape ``(k, n)``.

    Parameters
    ----------
    strength, power
        In place of 1, of p* its conjugate; and of s - p. With the residues and a power of 2 these
        are the slopes to the poles' real parts, then to their imaginary ones.
    """
    s = np.asarray(1j * omega, np.complex128)[:, None]
    term, twin = strength / (s - poles) ** power, np.conj(strength) / (s - poles.conj()) ** power
    paired = poles.imag != 0.0
    return np.hstack([np.where(paired, term + twin, term), 1j * (term - twin)[:, paired]])


def pole_slopes(poles: ComplexArray, residues: FloatArray, omega: FloatArray) -> ComplexArray:
    """Return the derivatives of one element in the order of :func:`moved_poles`."""
    strength = residues[: poles.size].astype(np.complex128)
    strength[poles.imag != 0.0] += 1j * residues[poles.size :]
    return basis(poles, omega, strength, 2)


def moved_poles(poles: ComplexArray, motion: FloatArray) -> ComplexArray:
    """Return the poles after a motion of their real parts, then of the pairs' imaginary ones."""
    imag = poles.imag.copy()
    imag[imag != 0.0] += motion[poles.size :]
    return poles.real + motion[: poles.size] + 1j * np.abs(imag)


def state_matrix(poles: ComplexArray) -> FloatArray:
    """Return the real matrix whose outputs are the functions of :func:`basis`."""
    pairs = np.flatnonzero(poles.imag)
    second = poles.size + np.arange(pairs.size)
    state = np.diag(np.concatenate([poles.real, poles.real[pairs]]))
    state[pairs, second], state[second, pairs] = poles.imag[pairs], -poles.imag[pairs]
    return state


def input_column(poles: ComplexArray) -> FloatArray:
    """Return the input of that matrix, shape ``(n,)``; also what residues count in their sum."""
    paired = poles.imag != 0.0
    return np.concatenate([1.0 + paired, np.zeros(np.count_nonzero(paired))])


def starting_poles(samples: SampledTable, count: int) -> ComplexArray:
    """Return pairs spread over the frequencies, and a real pole where the number is odd."""
    low, high = samples.omega[0], samples.omega[-1]
    spread = np.geomspace(low, high, count // 2 + 2)[1:-1]
    pairs = spread * (-0.5 + 1j)
    middle = np.array([-np.sqrt(low * high) + 0j])
    return np.concatenate([middle, pairs]) if count % 2 else pairs


def fitted_poles(samples: SampledTable, count: int) -> ComplexArray:
    """Return the poles of the best iteration, all of which fade."""
    poles = admissible(samples, starting_poles(samples, count))
    best, least = poles, np.inf
    for _ in range(_ITERATIONS):
        fit, _ = fitted_residues(samples, poles)
        misfit = fit.misfit(samples)
        if misfit < least:
            best, settled = poles, misfit > (1.0 - _SETTLED) * least
            least = misfit
            if settled:
                break
        poles = admissible(samples, _relocated(samples, fit))
    return best


@dataclass(frozen=True, eq=False)
class Cuts:
    """Where, and along what, the damping is asked to be the least.

    Attributes
    ----------
    omega, least
        Shape ``(c,)``.
    factors
        What the elements count along that direction, shape ``(c, e)``.
    """

    omega: FloatArray
    factors: FloatArray
    least: FloatArray

    def damping(self, element: int, functions: ComplexArray) -> FloatArray:
        """Return the damping of an element's functions along the directions, ``(c, any)``."""
        return -(self.omega * self.factors[:, element])[:, None] * functions.imag


def fitted_residues(
    samples: SampledTable,
    poles: ComplexArray,
    cuts: Cuts | None = None,
    around: FloatArray | None = None,
    cost: float = 0.0,
) -> tuple[PartialFractions, FloatArray]:
    """Return the best residues of given poles, and what the poles move by.

    Parameters
    ----------
    around
        Residues about which the poles may move, shape ``(e, n)``; ``None`` where they stay.
    cost
        Of a motion of a pole by its own size.
    """
    elements, free = range(len(samples.values)), sum_free(poles)
    cuts = cuts or Cuts(np.zeros(0), np.zeros((0, len(elements))), np.zeros(0))
    columns = samples.with_ends(basis(poles, samples.omega) @ free)
    # The memory's damping alone.
    damping_columns = np.zeros((cuts.omega.size, columns.shape[1]), np.complex128)
    damping_columns[:, : free.shape[1]] = basis(poles, cuts.omega) @ free
    system = block_diag(*[samples.weighted(e, columns) for e in elements])
    target = np.concatenate([samples.weighted(e, samples.sought[e]) for e in elements])
    conditions = np.hstack([cuts.damping(e, damping_columns) for e in elements])
    if around is not None:
        sizes = np.abs(np.append(poles, poles[poles.imag != 0.0]))
        system = block_diag(system, np.diag(cost / sizes))
        system[: target.size, -sizes.size :] = np.vstack(
            [samples.weighted(e, pole_slopes(poles, around[e], samples.omega)) for e in elements]
        )
        slopes = [cuts.damping(e, pole_slopes(poles, around[e], cuts.omega)) for e in elements]
        conditions = np.hstack([conditions, np.sum(slopes, axis=0)])
        target = np.append(target, np.zeros(sizes.size))
    solution = least_squares(system, target, conditions, cuts.least)
    numbers, motion = np.split(solution, [columns.shape[1] * len(elements)])
    numbers = numbers.reshape(len(elements), -1)
    own_residues, end, steady = np.split(
        numbers, free.shape[1] + np.array([0, int(samples.infinite is None)]), axis=1
    )
    infinite = end[:, 0] if samples.infinite is None else samples.infinite
    return PartialFractions(poles, own_residues @ free.T, infinite, steady.sum(axis=1)), motion


def sum_free(poles: ComplexArray) -> FloatArray:
    """Return an orthonormal basis ``(n, n - 1)`` of residues that add up to zero."""
    counted = input_column(poles)[:, None]
    return np.linalg.qr(counted, mode="complete")[0][:, 1:]


def admissible(samples: SampledTable, poles: ComplexArray) -> ComplexArray:
    """Return the poles reflected to the left, none slower, faster or narrower than is shown.

    A pair narrower than the distance of the table's frequencies would ring between them.
    """
    omega = samples.omega
    size = np.clip(np.abs(poles), None, _FASTEST * omega[-1])
    poles = poles * size / np.where(size > 0.0, np.abs(poles), 1.0)
    gaps = np.gradient(omega) if omega.size > 1 else omega
    paired = poles.imag != 0.0
    narrowest = np.where(paired, np.interp(poles.imag, omega, gaps) / 2.0, 0.0)
    rate = np.maximum(np.abs(poles.real), np.maximum(narrowest, _SLOWEST_FADING * omega[0]))
    real = np.sort(rate[~paired])
    for i in range(1, real.size):  # coinciding real poles have no residues of their own
        real[i] = max(real[i], real[i - 1] * (1.0 + _APART))
    return np.concatenate([-real + 0j, (-rate + 1j * poles.imag)[paired]])


def _relocated(samples: SampledTable, fit: PartialFractions) -> ComplexArray:
    """Return the zeros of the scaling function: one step of relaxed vector fitting."""
    functions = basis(fit.poles, samples.omega)
    columns = samples.with_ends(functions @ sum_free(fit.poles))
    scaling = np.column_stack([functions, np.ones(len(functions))])
    rows = samples.values - fit.ends(samples.omega)
    left = block_diag(*[samples.weighted(e, columns) for e in range(len(rows))])
    right = [samples.weighted(e, -row[:, None] * scaling) for e, row in enumerate(rows)]
    size = math.sqrt(sum(float(np.sum(samples.weighted(e, r) ** 2)) for e, r in enumerate(rows)))
    # Not the scaling's end value but its mean is one: the relaxed form, so that it is not zero.
    relaxed = np.append(np.zeros(left.shape[1]), size * scaling.real.mean(axis=0))
    system = np.vstack([np.hstack([left, np.vstack(right)]), relaxed])
    *moved, end = least_squares(system, np.append(np.zeros(len(left)), size))[left.shape[1] :]
    return _zeros(fit.poles, np.array(moved) / (end if abs(end) > 1e-8 else 1e-8))


def _zeros(poles: ComplexArray, residues: FloatArray) -> ComplexArray:
    """Return the zeros of 1 + sum of residues: eigenvalues of A - b c, those not below the axis."""
    zeros = np.linalg.eigvals(state_matrix(poles) - np.outer(input_column(poles), residues))
    return zeros[zeros.imag >= 0.0].astype(np.complex128)
