"""Integrals over a period of what jumps or bends there: piece by piece, from corner to corner.

A law such as ``sgn(v)`` is smooth between the instants where its argument passes a level. The mean
of such a law times a harmonic is therefore the sum over these pieces, each by Gauss and Legendre's
rule, whose error falls faster than any power of the number of nodes. Values at points that know
nothing of the corners would be off by the size of the jump over the number of points.

Signals are harmonics, ``x(phase) = sum_n real_n cos(n phase) - imaginary_n sin(n phase)``.
"""

import math
from functools import lru_cache
from typing import Final

import numpy as np

from hardware.description.arrays import ComplexArray, FloatArray
from sim.solve.compilation import compile_loop

# Nodes of a piece beyond the orders that are kept. A piece is half a period at most, and a little:
# with half as many the highest order is off by 1e-5 of the force, with twice as many by 1e-13.
_MORE: Final = 20
_LONGEST: Final = 1.05 * math.pi
_ITERATIONS: Final = 60  # of a root; eight are usual
_CLOSE: Final = 1e-14  # rad: a root that is known so well


@lru_cache(maxsize=16)
def gauss(orders: int) -> FloatArray:
    """Return places, 0 to 1, and weights, whose sum is 1, of the nodes of a piece: ``(2, nodes)``.

    Parameters
    ----------
    orders
        Highest harmonic that is kept.
    """
    places, weights = np.polynomial.legendre.leggauss(orders + _MORE)
    nodes: FloatArray = np.stack([(places + 1.0) / 2.0, weights / 2.0])
    nodes.setflags(write=False)
    return nodes


@compile_loop
def multiples(phase: float, way: FloatArray) -> None:
    """Fill in cosine and sine of 0, 1, 2 ... times a phase, ``(orders + 1, 2)``."""
    cosine, sine = math.cos(phase), math.sin(phase)
    way[0, 0], way[0, 1] = 1.0, 0.0
    for n in range(1, way.shape[0]):
        way[n, 0] = way[n - 1, 0] * cosine - way[n - 1, 1] * sine
        way[n, 1] = way[n - 1, 0] * sine + way[n - 1, 1] * cosine


@compile_loop
def value_at(real: FloatArray, imaginary: FloatArray, row: int, way: FloatArray) -> float:
    """Return the value of one of several signals at the phase that :func:`multiples` got."""
    total = 0.0
    for n in range(way.shape[0]):
        total += real[row, n] * way[n, 0] - imaginary[row, n] * way[n, 1]
    return total


@compile_loop
def _root(
    real: FloatArray,
    imaginary: FloatArray,
    row: int,
    level: float,
    low: tuple[float, float],
    high: tuple[float, float],
) -> float:
    """Return the phase at which a signal passes a level between two phases (Illinois).

    ``low`` and ``high`` are a phase and the signal above the level there, of opposite signs.
    """
    (a, at_a), (b, at_b) = low, high
    way = np.empty((real.shape[1], 2))
    for _ in range(_ITERATIONS):
        middle = b - at_b * (b - a) / (at_b - at_a)
        multiples(middle, way)
        value = value_at(real, imaginary, row, way) - level
        if (value >= 0.0) == (at_b >= 0.0):
            at_a /= 2.0
        else:
            a, at_a = b, at_b
        moved = abs(middle - b)
        b, at_b = middle, value
        if moved < _CLOSE or value == 0.0:
            break
    return b


@compile_loop
def _sort(phases: FloatArray, count: int) -> None:
    """Put the first few in order; those of one signal are so already."""
    for k in range(1, count):
        phase, place = phases[k], k
        while place and phases[place - 1] > phase:
            phases[place] = phases[place - 1]
            place -= 1
        phases[place] = phase


@compile_loop
def find_corners(
    real: FloatArray,
    imaginary: FloatArray,
    corners: FloatArray,
    cosine: FloatArray,
    sine: FloatArray,
    phases: FloatArray,
) -> int:
    """Fill in the phases, 0 to 2 pi in order, at which signals pass levels; return how many.

    Parameters
    ----------
    real, imaginary
        Harmonics, a row each signal.
    corners
        A row each: the signal's row, and the level that it passes.
    cosine, sine
        Of each harmonic at evenly spaced points over the period, ``(points, orders + 1)``. Two
        corners of a signal between neighbouring points are not seen.
    phases
        Room for one phase a point and row of ``corners``.
    """
    points, count = cosine.shape[0], 0
    step = 2.0 * math.pi / points
    values = np.empty(points)
    for corner in range(corners.shape[0]):
        row, level = int(corners[corner, 0]), corners[corner, 1]
        for k in range(points):
            values[k] = -level
            for n in range(real.shape[1]):
                values[k] += real[row, n] * cosine[k, n] - imaginary[row, n] * sine[k, n]
        for k in range(points):
            after = values[(k + 1) % points]
            if (values[k] >= 0.0) != (after >= 0.0):
                low, high = (k * step, values[k]), ((k + 1) * step, after)
                phases[count] = _root(real, imaginary, row, level, low, high)
                count += 1
    _sort(phases, count)
    return count


@compile_loop
def pieces_between(corners: FloatArray, pieces: FloatArray) -> int:
    """Fill in the pieces of a period between corners; return how many there are.

    Parameters
    ----------
    corners
        Phases in order, rad; there may be none.
    pieces
        Room for two more rows than corners: where each begins, rad, and its length. None is longer
        than half a period and a little.
    """
    count, number = 0, corners.size
    for i in range(max(number, 1)):
        begin = corners[i] if number else 0.0
        end = corners[i + 1] if i + 1 < number else begin + 2.0 * math.pi
        if i and i + 1 == number:
            end = corners[0] + 2.0 * math.pi
        parts = int((end - begin) / _LONGEST) + 1
        for part in range(parts):
            pieces[count, 0] = begin + part * (end - begin) / parts
            pieces[count, 1] = (end - begin) / parts
            count += 1
    return count


def nodes_between(
    harmonics: ComplexArray, corners: FloatArray, points: int
) -> tuple[FloatArray, FloatArray]:
    """Return phases, rad, and weights, whose sum is 1, of the integral over a period.

    Parameters
    ----------
    harmonics, corners, points
        As in :func:`find_corners`: harmonics of a row each signal, and the number of points.
    """
    angle = 2.0 * np.pi * np.outer(np.arange(points), np.arange(harmonics.shape[1])) / points
    real, imaginary = harmonics.real.copy(), harmonics.imag.copy()
    room = np.empty(points * len(corners))
    count = find_corners(real, imaginary, corners, np.cos(angle), np.sin(angle), room)
    pieces = np.empty((count + 2, 2))
    pieces = pieces[: pieces_between(room[:count], pieces)]
    places, weights = gauss(harmonics.shape[1] - 1)
    phase = pieces[:, :1] + pieces[:, 1:] * places
    weight = pieces[:, 1:] / (2.0 * np.pi) * weights
    return phase.ravel(), weight.ravel()
