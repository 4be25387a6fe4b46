"""Loops over the samples of a channel, compiled: hysteresis, filters, reading between samples."""

import numpy as np

from tests.sealed.generator.compiled import compiled
from tests.sealed.generator.parameters import FloatArray

ELEMENTS = 24


@compiled
def loop_of(force: FloatArray, strength: float) -> FloatArray:
    """Return what hysteresis adds to a reading: a sum of play operators (Prandtl, Ishlinskii).

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


@compiled
def bouc_wen_of(force: FloatArray, strength: float) -> FloatArray:
    """Return what a Bouc-Wen loop adds to a reading, as wide as the sum of plays at its middle."""
    top = np.max(np.abs(force)) + 1e-12
    added, z = np.zeros(len(force)), 0.0
    for n in range(1, len(force)):
        step = (force[n] - force[n - 1]) / (0.3 * top)
        z += step if z * step < 0.0 else step * (1.0 - z * z)
        z = min(max(z, -1.0), 1.0)
        added[n] = -0.5 * strength * top * top * z
    return added


@compiled
def recursive(signal: FloatArray, decay: float, late: float, early: float) -> FloatArray:
    """Return y of ``y_n = decay y_(n-1) + late u_n + early u_(n-1)``, settled at the first u."""
    out = np.empty(len(signal))
    out[0] = signal[0] * (late + early) / (1.0 - decay)
    for n in range(1, len(signal)):
        out[n] = decay * out[n - 1] + late * signal[n] + early * signal[n - 1]
    return out


@compiled
def between(rows: FloatArray, places: FloatArray) -> FloatArray:
    """Return rows ``(channels, samples)`` at places in samples, by the quintic through six."""
    out = np.empty((rows.shape[0], len(places)))
    weights = np.empty(6)
    for i in range(len(places)):
        first = min(max(int(np.floor(places[i])) - 2, 0), rows.shape[1] - 6)
        u = places[i] - first
        for k in range(6):
            weights[k] = 1.0
            for other in range(6):
                if other != k:
                    weights[k] *= (u - other) / (k - other)
        for row in range(rows.shape[0]):
            out[row, i] = 0.0
            for k in range(6):
                out[row, i] += weights[k] * rows[row, first + k]
    return out
