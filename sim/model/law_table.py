"""Force laws as a table of numbers: what a compiled loop reads in place of Python objects."""

import math
from typing import NamedTuple, cast

import numpy as np

from hardware.description.arrays import FloatArray
from sim.model.force_law import ForceLaw, NumberedLaw
from sim.model.forces import arguments_of, direction
from sim.model.law_point import Acting, Point
from sim.model.laws import LAWS
from sim.model.numbers import has_corners
from sim.model.system import HullSystem


class LawTable(NamedTuple):
    """Laws, one a row, and the numbers of the hull.

    Attributes
    ----------
    laws
        Shape ``(laws, 10)``: number of the law in :data:`sim.model.laws.LAWS`; its parameters; in
        strut coordinates, two numbers each, the direction of its motion and what gives its load;
        1 for a law of the motion through the water, else 0.
    hull
        See :mod:`sim.mechanism.geometry`.
    arguments
        What each law depends on, and after them what bends in the hull's loads (the velocities v
        and r, and nothing): :func:`sim.model.forces.arguments_of`, shape ``(items, 4, 11)``.
    corners
        A row each: the item, its argument, and the level at which the force jumps or bends; in
        order of the items.
    """

    laws: FloatArray
    hull: FloatArray
    arguments: FloatArray
    corners: FloatArray


def has_number(law: ForceLaw) -> bool:
    """Tell whether the compiled loops have the law; a subclass of such a law does not count."""
    return type(law) in LAWS


def table_of(laws: tuple[Acting, ...], system: HullSystem) -> LawTable:
    """Return the table of laws that all have a number, and of the hull."""
    rows = np.full((len(laws), 10), math.nan)
    arguments = [arguments_of(law, system) for law in laws]
    corners: list[tuple[int, int, float]] = []
    for item, acting in enumerate(laws):
        row = rows[item]
        law = cast("NumberedLaw", acting.law)
        row[0], row[1:5] = LAWS.index(type(law)), law.parameters
        row[5:7], row[7:9] = direction(acting.point, system.to_motion)
        row[9] = acting.point is Point.THROUGH_WATER
        corners += [(item, corner.argument, corner.level) for corner in acting.law.corners]
    if has_corners(system.numbers):
        velocities = np.zeros((4, 11))
        velocities[0, 8] = velocities[1, 9] = 1.0
        arguments.append(velocities)
        corners += [(len(laws), argument, 0.0) for argument in (0, 1)]
    return LawTable(
        rows,
        system.numbers,
        np.reshape(arguments, (-1, 4, 11)),
        np.reshape(corners, (-1, 3)).astype(float),
    )
