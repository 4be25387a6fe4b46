"""Small estimators of others, for a gate between two pulses: what their edges cost.

Each takes a :class:`Gate` and returns ``[A0, S1, C1, S2, C2, S3, C3]``; the mean is NaN where the
method gives none.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, partial

import numpy as np
from numpy.polynomial import Polynomial

from analysis.resolver.basis import harmonic_basis
from hardware.description.arrays import FloatArray

_ORDERS = np.arange(1.0, 4.0)


@dataclass(frozen=True)
class Gate:
    """Samples of one channel, and a gate of whole periods between two fractional sample numbers.

    ``cycles`` are the revolutions at every sample.
    """

    values: FloatArray
    cycles: FloatArray
    opening: float
    closing: float
    periods: int


def rounded(gate: Gate) -> FloatArray:
    """Average the products from the sample nearest the opening to that before the closing."""
    inside = slice(round(gate.opening), round(gate.closing))
    basis = harmonic_basis(gate.cycles[inside], _ORDERS)
    return _doubled(basis @ gate.values[inside] / basis.shape[1])


def nearest_bin(gate: Gate) -> FloatArray:
    """Transform the rounded gate and turn its bins to the phase at its first sample."""
    first, end = round(gate.opening), round(gate.closing)
    lines = 2.0 * np.fft.rfft(gate.values[first:end]) / (end - first)
    own = lines[(gate.periods * _ORDERS).astype(np.intp)]
    turned = own * np.exp(-2j * np.pi * _ORDERS * gate.cycles[first])
    found = np.empty(7)
    found[0], found[1::2], found[2::2] = lines[0].real / 2.0, -turned.imag, turned.real
    return found


def least_squares(gate: Gate, *, trend: bool = False) -> FloatArray:
    """Fit the samples inside the gate, all alike; with a straight line in time if asked."""
    inside = slice(int(np.ceil(gate.opening)), int(np.ceil(gate.closing)))
    basis = harmonic_basis(gate.cycles[inside], _ORDERS)
    if trend:
        basis = np.vstack((basis, np.linspace(-1.0, 1.0, basis.shape[1])))
    return np.asarray(np.linalg.lstsq(basis.T, gate.values[inside], rcond=None)[0][:7])


def weighted(gate: Gate, nodes: int, *, solve: bool) -> FloatArray:
    """Integrate the products by polynomials through some samples of each cell.

    Parameters
    ----------
    nodes
        2 gives the trapezoid, 4 cubic edges, 6 those that the resolver uses.
    solve
        Whether the joint normal equations are solved under these weights.
    """
    weights = edge_weights(gate.opening, gate.closing, nodes, len(gate.values))
    basis = harmonic_basis(gate.cycles, _ORDERS)
    moment = basis @ (weights * gate.values)
    if solve:
        return np.asarray(np.linalg.solve((basis * weights) @ basis.T, moment), dtype=np.float64)
    return _doubled(moment / (gate.closing - gate.opening))


def _doubled(means: FloatArray) -> FloatArray:
    means[1:] *= 2.0
    return means


def edge_weights(opening: float, closing: float, nodes: int, count: int) -> FloatArray:
    """Weights of all samples for the integral between two sample numbers well inside a record."""
    first, last = int(opening), int(closing)
    reach = nodes // 2
    weights = np.zeros(count)
    pieces = [(cell, 0.0, 1.0) for cell in range(first + 1, last)]
    pieces += [(first, opening - first, 1.0), (last, 0.0, closing - last)]
    whole = _cell(nodes, 0.0, 1.0)
    for cell, low, high in pieces:
        part = whole if high - low == 1.0 else _cell(nodes, low, high)
        weights[cell + 1 - reach : cell + 1 + reach] += part
    return weights


def _cell(nodes: int, low: float, high: float) -> FloatArray:
    """Integrals of a cell's Lagrange polynomials from ``low`` to ``high``, within [0, 1]."""
    return np.array(
        [antiderivative(high) - antiderivative(low) for antiderivative in _lagrange(nodes)]
    )


@cache
def _lagrange(nodes: int) -> tuple[Polynomial, ...]:
    places = np.arange(1.0 - nodes // 2, 1.0 + nodes // 2)
    found = []
    for place in places:
        others = places[places != place]
        found.append((Polynomial.fromroots(others) / np.prod(place - others)).integ())
    return tuple(found)


RIVALS: dict[str, Callable[[Gate], FloatArray]] = {
    "gate rounded to a sample": rounded,
    "nearest FFT bin": nearest_bin,
    "trapezoid, interpolated edges": partial(weighted, nodes=2, solve=False),
    "cubic edges": partial(weighted, nodes=4, solve=False),
    "six-point edges": partial(weighted, nodes=6, solve=False),
    "least squares in the gate": least_squares,
    "least squares with a trend column": partial(least_squares, trend=True),
    "trapezoid and Gram solve": partial(weighted, nodes=2, solve=True),
    "cubic edges and Gram solve": partial(weighted, nodes=4, solve=True),
}
