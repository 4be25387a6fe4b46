"""Hysteresis of a gauge as a sum of play operators (Prandtl and Ishlinskii), compiled."""

import numpy as np

from tests.sealed.generator.compiled import compiled
from tests.sealed.generator.parameters import FloatArray

ELEMENTS = 24


@compiled
def loop_of(force: FloatArray, strength: float) -> FloatArray:
    """Return what hysteresis adds to a reading, for the force's whole history.

    The density of the elements is even up to the largest force, so that the loop's width grows
    with the square of the force, as Rayleigh's does; ``strength`` is his beta, 1/N.
    """
    top = np.max(np.abs(force)) + 1e-12
    width = top / ELEMENTS
    state, added = np.zeros(ELEMENTS), np.zeros(len(force))
    for n in range(len(force)):
        for i in range(ELEMENTS):
            reach = (i + 0.5) * width
            state[i] = min(max(state[i], force[n] - reach), force[n] + reach)
            added[n] += 2.0 * strength * width * (state[i] - force[n])
    return added
