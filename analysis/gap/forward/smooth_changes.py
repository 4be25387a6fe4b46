"""What coefficients may do with frequency and speed, as columns of the difference.

A table of added mass and damping, or one number of each, is what a good model believes; the water
departs from it smoothly.
"""

import math
from collections.abc import Iterator, Mapping
from typing import Final

import numpy as np

from analysis.gap.forward.tolerances import Tolerances
from analysis.gap.observe.components import Stack
from hardware.description.arrays import FloatArray

_LEAST: Final = 1e-3  # of a smooth change's variance, below which it needs no further column


def smooth_changes(
    stack: Stack, levels: Mapping[str, FloatArray], tolerances: Tolerances
) -> Iterator[FloatArray]:
    """Yield the columns, in sigma per prior deviation.

    Parameters
    ----------
    levels
        What a prior deviation of each coefficient changes, in sigma, by name: ``"a11"``.
    """
    ways = {
        "a": _directions(stack, tolerances.added_mass_per_octave, tolerances.added_mass_per_speed),
        "b": _directions(stack, tolerances.damping_per_octave, tolerances.damping_per_speed),
    }
    relatives = {"a": tolerances.added_mass_relative, "b": tolerances.damping_relative}
    for name, level in levels.items():
        kind, diagonal = name[0], name[1] == name[2]
        for change in ways[kind]:
            relative = relatives[kind] if diagonal else tolerances.coupling_relative
            yield level / relative * change


def _directions(stack: Stack, per_octave: float, per_speed: float) -> list[FloatArray]:
    """Return the ways in which a coefficient changes over the runs, each ``(observations,)``.

    Over frequency a Gaussian process with a length of an octave and a slope that is continuous
    (Matern, 3/2), by its eigenvectors: damping by waves has a peak about an octave wide. Over speed
    in proportion to it. A carriage that stands is off by its whole speed, either way: flow past the
    model is another flow.
    """
    octaves = np.log2([run.set_point.frequency_hz for run in stack.runs])
    apart = math.sqrt(3.0) * np.abs(octaves[:, None] - octaves)
    values, vectors = np.linalg.eigh((1.0 + apart) * np.exp(-apart))
    pairs = zip(values, vectors.T, strict=True)
    shapes = [math.sqrt(value) * vector for value, vector in pairs if value > _LEAST * values[-1]]
    speeds = np.array([run.set_point.carriage_speed_m_s for run in stack.runs])
    moving = speeds > 0.0
    middle = speeds[moving].mean() if moving.any() else 1.0
    faster = np.where(moving, speeds / middle - 1.0, 0.0)
    standing = np.where(moving, 0.0, float(moving.any()))
    rows = [per_octave * shape for shape in shapes] + [
        per_speed * change for change in (faster, standing)
    ]
    return [row[stack.run] for row in rows if row.any()]
