"""Integration weights for a gate whose edges fall between samples.

The integral of the piecewise polynomial through the samples, from one fractional sample number to
another: every sample inside counts once, and the three samples on either side of each edge carry a
correction. Sixth-order edges (a polynomial through six samples in each cell) keep harmonics 4 to 8
out of the first three to below 1e-6 at 100 samples a period, which cubic edges (four samples) do
not; ``docs/decisions/0002-period-sums.md`` has the figures.

The weights are additive: those of ``[a, b]`` and ``[b, c]`` sum to those of ``[a, c]``, so a gate
of several periods is the sum of its periods.
"""

from functools import cache

import numpy as np
from numpy.polynomial import polynomial

from hardware.description.arrays import FloatArray

REACH = 3  # samples on either side of an edge that its correction touches
_NODES = np.arange(1 - REACH, REACH + 1)  # of the cell from sample 0 to sample 1


@cache
def _correction_polynomials() -> FloatArray:
    """Coefficients of the edge's corrections in powers of its fraction, shape ``(nodes, 7)``.

    The part of the cell that the edge cuts, plus all whole cells from sample 1 on, less one for
    each sample from 1 on.
    """
    # Integrals from 0 to f of each node's Lagrange polynomial.
    rows = []
    for i, node in enumerate(_NODES):
        lagrange = np.ones(1)
        for neighbour in np.delete(_NODES, i):
            lagrange = np.convolve(
                lagrange, [-neighbour / (node - neighbour), 1.0 / (node - neighbour)]
            )
        rows.append(polynomial.polyint(lagrange))
    cut = np.array(rows)
    cell_weights = cut.sum(axis=1)
    # Sample j lies on a node of every cell that starts at or before it; cells before 1 are missing.
    reached = np.concatenate(([0.0], np.cumsum(cell_weights)[:-1]))
    corrections = -cut
    corrections[:, 0] += cell_weights + reached - (_NODES >= 1)
    return np.asarray(corrections)


def edge_corrections(fractions: FloatArray) -> FloatArray:
    """Return what an opening edge at ``fraction`` past sample 0 adds to unit weights from sample 1.

    They are corrections to samples -2, -1, 0, 1, 2, 3, shape ``(edges, 6)``. A closing edge has the
    same ones, negative.

    Parameters
    ----------
    fractions
        In [0, 1), shape ``(edges,)``: each edge lies between samples 0 and 1.
    """
    powers = np.asarray(fractions)[:, None] ** np.arange(2 * REACH + 1)
    return np.asarray(powers @ _correction_polynomials().T)


@cache
def _extrapolation(distance: int) -> FloatArray:
    """Weights that continue six samples by a polynomial, ``distance`` samples past their end."""
    nodes = np.arange(2 * REACH)
    node_rests = [np.delete(nodes, i) for i in nodes]
    return np.array(
        [
            np.prod((-distance - rest) / (node - rest))
            for node, rest in zip(nodes, node_rests, strict=True)
        ]
    )


def gate_weights(opening: float, closing: float, count: int) -> tuple[int, FloatArray]:
    """Weights of the samples for the integral from ``opening`` to ``closing``.

    The results are first, weights: the number of the first sample and the weights from there on, in
    units of the sample spacing.

    Parameters
    ----------
    opening, closing
        Fractional sample numbers, ``0 <= opening <= closing - 2``, ``closing <= count - 1``.
    count
        Number of samples there are, six or more. Near either end of a record the samples that an
        edge would need beyond it are continued by a polynomial through the last six.
    """
    first = int(opening) + 1 - REACH
    last = int(closing) + REACH
    weights = np.zeros(last - first + 1)
    weights[REACH : int(closing) - first + 1] = 1.0
    fractions = np.array([opening - int(opening), closing - int(closing)])
    at_opening, at_closing = edge_corrections(fractions)
    weights[: 2 * REACH] += at_opening
    weights[-2 * REACH :] -= at_closing
    return _fold_into_record(first, weights, count)


def _fold_into_record(first: int, weights: FloatArray, count: int) -> tuple[int, FloatArray]:
    """Hand the weights of samples outside the record to the six nearest inside."""
    # A short gate at one end reaches fewer than six inside: take in those on its other side.
    if first + len(weights) > count:
        ahead = max(0, first - (count - 2 * REACH))
        first, weights = first - ahead, np.concatenate((np.zeros(ahead), weights))
    if first < 0:
        weights = np.concatenate((weights, np.zeros(max(0, 2 * REACH - first - len(weights)))))
    missing = max(0, -first)
    for k in range(missing):
        weights[missing : missing + 2 * REACH] += weights[k] * _extrapolation(missing - k)
    excess = max(0, first + len(weights) - count)
    for k in range(excess):
        end = len(weights) - excess
        weights[end - 2 * REACH : end] += (
            weights[len(weights) - 1 - k] * _extrapolation(excess - k)[::-1]
        )
    return first + missing, weights[missing : len(weights) - excess]
