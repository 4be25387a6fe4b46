"""What coefficients may do with frequency and speed, as columns of the difference.

A table of added mass and damping, or one number of each, is what a good model believes; the water
departs from it smoothly.
"""

import math
from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np

from analysis.gap.components import Stack
from analysis.gap.free import Free
from analysis.gap.priors import Priors
from hardware.description.arrays import FloatArray

PER_OCTAVE_AND_SPEED: Final = {"a": (0.05, 0.03), "b": (0.05, 0.10)}
"""Relative standard deviations of a coefficient's change: panel tables of ship models, and tests at
several Froude numbers."""

_LEAST: Final = 1e-3  # of a smooth change's variance, below which it needs no further column


def smooth_changes(
    stack: Stack, free: Sequence[Free], levels: Sequence[FloatArray], priors: Priors
) -> Iterator[FloatArray]:
    """Yield the columns, in sigma per prior deviation.

    Parameters
    ----------
    levels
        What a prior deviation of each of ``free`` changes, in sigma.
    """
    ways = {kind: _ways(stack, *PER_OCTAVE_AND_SPEED[kind]) for kind in "ab"}
    own = {"a": priors.added_mass_relative, "b": priors.damping_relative}
    for one, level in zip(free, levels, strict=True):
        if one.is_sought:
            kind, row, column = one.name
            relative = own[kind] if row == column else priors.coupling_relative
            for change in ways[kind]:
                yield level / relative * change


def _ways(stack: Stack, per_octave: float, per_speed: float) -> list[FloatArray]:
    """Return the ways in which a coefficient changes over the runs, each ``(observations,)``.

    Over frequency a Gaussian process with a length of an octave, by its eigenvectors; over speed in
    proportion to it, and nothing where the carriage stands.
    """
    octaves = np.log2([run.set_point.frequency_hz for run in stack.runs])
    values, vectors = np.linalg.eigh(np.exp(-0.5 * (octaves[:, None] - octaves) ** 2))
    pairs = zip(values, vectors.T, strict=True)
    shapes = [math.sqrt(value) * one for value, one in pairs if value > _LEAST * values[-1]]
    speeds = np.array([run.set_point.carriage_speed_m_s for run in stack.runs])
    moving = speeds > 0.0
    faster = np.where(moving, speeds / (speeds[moving].mean() if moving.any() else 1.0) - 1.0, 0.0)
    rows = [per_octave * one for one in shapes] + [per_speed * faster]
    return [one[stack.run] for one in rows if one.any()]
