"""Force laws as a table of numbers: what a compiled loop reads in place of Python objects."""

import math
from dataclasses import astuple
from typing import Final, NamedTuple

import numpy as np

from sim.acting import Acting, Point
from sim.hull_forces import CrossFlow, direction
from sim.hull_system import HullSystem
from sim.laws import (
    ArcSine,
    Coulomb,
    Cubic,
    Exponential,
    ForceLaw,
    LoadFriction,
    Proximity,
    Quadratic,
    RubbingSpring,
    Spring,
    Stribeck,
    Tone,
    Viscous,
)
from sim.signals import FloatArray

# The order is the law's number in :mod:`sim.compiled_laws`, a test holds the two together.
LAWS: Final[tuple[type[ForceLaw], ...]] = (
    Viscous,
    Quadratic,
    Cubic,
    Spring,
    Proximity,
    Exponential,
    Tone,
    Coulomb,
    Stribeck,
    LoadFriction,
    RubbingSpring,
    ArcSine,
)


class LawTable(NamedTuple):
    """Laws, one a row, and the coupled cubic and quadratic loads.

    Attributes
    ----------
    laws
        Shape ``(laws, 11)``: number of the law in :data:`LAWS`; four parameters in order, NaN for
        one that is ``None`` or missing; in strut coordinates, two numbers each, the direction of
        its motion, what gives its load, and what a displacement adds to its velocity.
    cross_flow
        Shape ``(6, 4)``, or ``(0, 4)`` where there is none: two rows of cubic coefficients, two of
        quadratic ones, and of each velocity what the struts' velocities and displacements give it.
    arguments
        What each law depends on, and after them the coupled loads, out of h, h', h'' and the linear
        load at the struts: shape ``(items, 4, 8)``. Of a law these are position, velocity,
        acceleration and load (:class:`sim.force_law.Argument`), of the coupled loads both
        velocities, and nothing.
    corners
        A row each: the item, its argument, and the level at which the force jumps or bends; in
        order of the items.
    """

    laws: FloatArray
    cross_flow: FloatArray
    arguments: FloatArray
    corners: FloatArray


def has_number(law: ForceLaw) -> bool:
    """Tell whether a compiled loop knows the law; a subclass of one that it knows is another."""
    return type(law) in LAWS


def table_of(
    laws: tuple[Acting, ...], cross_flow: CrossFlow | None, system: HullSystem
) -> LawTable:
    """Return the table of laws that all have a number."""
    rows = np.full((len(laws), 11), math.nan)
    arguments = np.zeros((len(laws), 4, 8))
    corners: list[tuple[int, int, float]] = []
    for item, acting in enumerate(laws):
        row, own = rows[item], arguments[item]
        values = astuple(acting.law)  # type: ignore[arg-type]  # every numbered law is a dataclass
        row[0] = LAWS.index(type(acting.law))
        row[1 : 1 + len(values)] = [math.nan if one is None else one for one in values]
        row[5:7], row[7:9] = direction(acting.point, system.to_motion)
        row[9:11] = system.incidence[0] if acting.point is Point.THROUGH_WATER else 0.0
        own[0, :2] = own[1, 2:4] = own[2, 4:6] = row[5:7]
        own[1, :2] = own[2, 2:4] = row[9:11]
        own[3, 6:] = row[7:9]
        corners += [(item, one.argument, one.level) for one in acting.law.corners]
    if cross_flow is not None:
        coupled = np.zeros((1, 4, 8))
        coupled[0, :2, :4] = np.hstack([system.incidence, system.to_motion])
        arguments = np.concatenate([arguments, coupled])
        corners += [(len(laws), argument, 0.0) for argument in (0, 1)]
    return LawTable(
        rows, _coefficients(cross_flow, system), arguments, np.reshape(corners, (-1, 3))
    )


def _coefficients(cross_flow: CrossFlow | None, system: HullSystem) -> FloatArray:
    if cross_flow is None:
        return np.zeros((0, 4))
    kinds = (cross_flow.cubic, cross_flow.quadratic)
    given = [np.zeros((2, 4)) if rows is None else np.array(rows) for rows in kinds]
    return np.vstack([*given, np.hstack([system.to_motion, system.incidence])])
