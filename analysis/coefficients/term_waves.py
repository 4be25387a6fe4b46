"""Terms over a cycle: products of factors, and how they follow each motion.

The factors are the velocities through the water along (u), across (v) and turning (r), and the
rates of these, at each instant of the averaged cycle, the rudder's angle (d), and of a
model that heels its angle (phi), the rate of it (p) and that rate's own.
"""

from collections.abc import Sequence

import numpy as np

from analysis.coefficients.terms import Term
from hardware.description.arrays import FloatArray

MOVES = ("u", "v", "r", "udot", "vdot", "rdot", "d", "phi", "p", "pdot")
UPRIGHT = 7  # moves of a model that does not heel


def waves_of(terms: Sequence[Term], moves: FloatArray) -> FloatArray:
    """Return each term's product of factors over a cycle.

    The result has the shape ``(..., terms, instants)``.

    Parameters
    ----------
    moves
        :data:`MOVES`, shape ``(..., 10, instants)``; without those of heel 7.
    """
    waves = np.empty((*moves.shape[:-2], len(terms), moves.shape[-1]))
    for k, term in enumerate(terms):
        wave = _product([_factor(factor, moves) for factor in term.product], moves)
        if term.speed_power:
            wave = wave * _squared_speed(moves) ** (term.speed_power / 2)
        waves[..., k, :] = wave / term.divisor
    return waves


def slopes_of(terms: Sequence[Term], moves: FloatArray) -> FloatArray:
    """Return how each term follows each motion, shape ``(..., terms, 7 or 10, instants)``."""
    slopes = np.zeros((*moves.shape[:-2], len(terms), *moves.shape[-2:]))
    for k, term in enumerate(terms):
        factors = [_factor(factor, moves) for factor in term.product]
        for n, name in enumerate(term.product):
            rest = _product(factors[:n] + factors[n + 1 :], moves)
            place = MOVES.index(name.strip("|"))
            sign = np.sign(moves[..., place, :]) if "|" in name else 1.0
            slopes[..., k, place, :] += sign * rest / term.divisor
        if term.speed_power:
            speed = _squared_speed(moves)
            slopes[..., k, :, :] *= speed[..., None, :] ** (term.speed_power / 2)
            wave = waves_of([term], moves)[..., 0, :]
            for place in (MOVES.index("u"), MOVES.index("v")):
                slopes[..., k, place, :] += term.speed_power * wave * moves[..., place, :] / speed
    return slopes


def _squared_speed(moves: FloatArray) -> FloatArray:
    """Return V^2 through the water."""
    ahead, across = (moves[..., MOVES.index(name), :] for name in ("u", "v"))
    return np.asarray(ahead**2 + across**2)


def _factor(name: str, moves: FloatArray) -> FloatArray:
    wave = moves[..., MOVES.index(name.strip("|")), :]
    return np.abs(wave) if "|" in name else wave


def _product(factors: Sequence[FloatArray], moves: FloatArray) -> FloatArray:
    product = np.ones_like(moves[..., 0, :])
    for factor in factors:
        product = product * factor
    return product
