"""Rational functions by relaxed vector fitting: linear least squares that move the poles.

Fitted is the complex added mass M(s) = Z(s)/s = A + B/(i w) at s = i w, as

    M(s) = A_inf + sum_n R_n / (s - p_n)        sum_n R_n = 0

for a symmetric matrix of m degrees of freedom with common poles. The memory K = s (M - A_inf) then
is 0 at s = 0, and strictly proper because the residues add up to zero: K = sum_n p_n R_n/(s - p_n).
An iteration finds s(w) M and s(w) on the same poles; the zeros of the latter are the next poles
(Gustavsen and Semlyen, IEEE Trans. Power Delivery 14(3), 1999; relaxed: Gustavsen, 21(3), 2006).
"""

from dataclasses import dataclass
from typing import Final

import numpy as np

from hardware.description.arrays import ComplexArray, FloatArray

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
    weight_real, weight_imag
        What a deviation of its real part, of its imaginary part is multiplied with, ``(e, k)``.
    infinite
        Value at infinite frequency, shape ``(e,)``; ``None`` where it is fitted along.
    """

    omega: FloatArray
    values: ComplexArray
    weight_real: FloatArray
    weight_imag: FloatArray
    infinite: FloatArray | None

    def weighted(self, element: int, functions: ComplexArray) -> FloatArray:
        """Return real and imaginary parts of ``(k, ...)`` one below the other, weighted."""
        shape = (-1, *(1,) * (functions.ndim - 1))
        real = functions.real * self.weight_real[element].reshape(shape)
        imag = functions.imag * self.weight_imag[element].reshape(shape)
        return np.concatenate([real, imag])


@dataclass(frozen=True, eq=False)
class PartialFractions:
    """Poles with a non-negative imaginary part, and what is fitted to them.

    Attributes
    ----------
    poles
        Shape ``(q,)``: real ones, and one of each conjugate pair.
    residues
        Real numbers for the functions of :func:`basis`, shape ``(e, n)``.
    infinite
        Shape ``(e,)``.
    """

    poles: ComplexArray
    residues: FloatArray
    infinite: FloatArray

    def deviations(self, samples: SampledTable) -> FloatArray:
        """Return the weighted deviations from the samples, shape ``(e, 2 k)``."""
        fitted = self.residues @ basis(self.poles, samples.omega).T + self.infinite[:, None]
        off = fitted - samples.values
        return np.array([samples.weighted(e, row) for e, row in enumerate(off)])

    def misfit(self, samples: SampledTable) -> float:
        """Return the root mean square of the weighted deviations."""
        return float(np.sqrt(np.mean(self.deviations(samples) ** 2)))


def basis(poles: ComplexArray, omega: FloatArray) -> ComplexArray:
    """Return 1/(s - p) of real poles; 1/(s - p) + 1/(s - p*), i/(s - p) - i/(s - p*) of pairs.

    At s = i w, shape ``(k, n)``.
    """
    columns: list[ComplexArray] = []
    s = np.asarray(1j * omega, np.complex128)
    for pole in poles:
        one = 1.0 / (s - pole)
        if pole.imag == 0.0:
            columns.append(one)
            continue
        other = 1.0 / (s - pole.conjugate())
        columns += [one + other, 1j * one - 1j * other]
    return np.stack(columns, axis=-1)


def state_matrix(poles: ComplexArray) -> FloatArray:
    """Return the real matrix, blocks of 1 and 2, whose outputs are the functions of basis."""
    size = len(input_column(poles))
    state, first = np.zeros((size, size)), 0
    for pole in poles:
        own = slice(first, first + 1 + (pole.imag != 0.0))
        re, im = pole.real, pole.imag
        state[own, own] = [[re]] if im == 0.0 else [[re, im], [-im, re]]
        first = own.stop
    return state


def input_column(poles: ComplexArray) -> FloatArray:
    """Return the input of the blocks, shape ``(n,)``; also what residues count in their sum."""
    parts = [np.array([1.0]) if p.imag == 0.0 else np.array([2.0, 0.0]) for p in poles]
    return np.concatenate(parts)


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
        found = fitted_residues(samples, poles)
        misfit = found.misfit(samples)
        if misfit < least:
            best, settled = poles, misfit > (1.0 - _SETTLED) * least
            least = misfit
            if settled:
                break
        poles = admissible(samples, _relocated(samples, found))
    return best


def fitted_residues(samples: SampledTable, poles: ComplexArray) -> PartialFractions:
    """Return the best residues of given poles."""
    free, known = sum_free(poles), samples.infinite
    functions = _with_infinite(samples, basis(poles, samples.omega) @ free)
    found = []
    for e, values in enumerate(samples.values):
        target = values if known is None else values - known[e]
        system = samples.weighted(e, functions)
        found.append(np.linalg.lstsq(system, samples.weighted(e, target), rcond=None)[0])
    numbers = np.array(found)
    residues = numbers[:, : free.shape[1]] @ free.T
    return PartialFractions(poles, residues, numbers[:, -1] if known is None else known)


def _with_infinite(samples: SampledTable, functions: ComplexArray) -> ComplexArray:
    """Return the functions, and a constant beside them where the end value is fitted along."""
    if samples.infinite is not None:
        return functions
    return np.column_stack([functions, np.ones(len(functions))])


def pole_slopes(poles: ComplexArray, residues: FloatArray, omega: FloatArray) -> ComplexArray:
    """Return the derivative of one element to each pole, or to both parts of a pair's."""
    columns: list[ComplexArray] = []
    s, first = np.asarray(1j * omega, np.complex128), 0
    for pole in poles:
        one = 1.0 / (s - pole) ** 2
        if pole.imag == 0.0:
            columns.append(residues[first] * one)
            first += 1
            continue
        own = complex(residues[first], residues[first + 1])
        other = 1.0 / (s - pole.conjugate()) ** 2
        left, right = own * one, own.conjugate() * other
        columns += [left + right, 1j * (left - right)]
        first += 2
    return np.stack(columns, axis=-1)


def moved_poles(poles: ComplexArray, motion: FloatArray) -> ComplexArray:
    """Return the poles after a motion in the order of :func:`pole_slopes`."""
    count = int(np.count_nonzero(poles.imag == 0.0))
    real, pairs = motion[:count], motion[count:].reshape(-1, 2)
    moved = poles + np.concatenate([real, pairs @ np.array([1.0, 1j])])
    upper = np.where(poles.imag == 0.0, moved, moved.real + 1j * np.abs(moved.imag))
    return np.asarray(upper, np.complex128)


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


def _relocated(samples: SampledTable, found: PartialFractions) -> ComplexArray:
    """Return the zeros of the scaling function: one step of relaxed vector fitting."""
    functions = basis(found.poles, samples.omega)
    own = _with_infinite(samples, functions @ sum_free(found.poles))
    scaling = np.column_stack([functions, np.ones(len(functions))])
    lower, size = [], 0.0
    for e, row in enumerate(samples.values - found.infinite[:, None]):
        left, right = samples.weighted(e, own), samples.weighted(e, -row[:, None] * scaling)
        q = np.linalg.qr(left)[0]
        lower.append(right - q @ (q.T @ right))
        size += float(np.sum(samples.weighted(e, row) ** 2))
    # Not the scaling's end value but its sum is one: the relaxed form, so that it is not zero.
    k = len(samples.omega)
    relaxed = np.sqrt(size) / k * scaling.real.sum(axis=0)
    system = np.vstack([*lower, relaxed])
    norm = np.linalg.norm(system, axis=0)
    norm = np.where(norm > 0.0, norm, 1.0)
    target = np.append(np.zeros(len(system) - 1), np.sqrt(size))
    scale = np.linalg.lstsq(system / norm, target, rcond=None)[0] / norm
    *moved, end = scale
    end = end if abs(end) > 1e-8 else 1e-8
    return _zeros(found.poles, np.array(moved) / end)


def _zeros(poles: ComplexArray, residues: FloatArray) -> ComplexArray:
    """Return the zeros of 1 + sum of residues: eigenvalues of A - b c, those not below the axis."""
    zeros = np.linalg.eigvals(state_matrix(poles) - np.outer(input_column(poles), residues))
    return zeros[zeros.imag >= 0.0].astype(np.complex128)
