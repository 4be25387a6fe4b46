"""Non-linear forces on the model: exact geometry, and force laws."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from hardware.description.arrays import ComplexArray, FloatArray
from sim.mechanism import geometry
from sim.model.force_law import LawInput
from sim.model.law_point import Acting, Point
from sim.model.numbers import (
    corners_only,
    geometry_only,
    has_corners,
    moving,
    readings,
    without_corners,
)
from sim.model.system import HullSystem
from sim.solve.corners import nodes_between
from sim.solve.period import Period


class ModelMotion(NamedTuple):
    """The model at the struts: h, h', h'' and the load of the linear parts, ``(samples, 2)``."""

    position: FloatArray
    velocity: FloatArray
    acceleration: FloatArray
    load: FloatArray


class Instants(NamedTuple):
    """Times, and the carriage speed at them."""

    time_s: FloatArray
    step_s: float
    speed_m_s: FloatArray


def law_forces(
    laws: tuple[Acting, ...],
    numbers: FloatArray,
    system: HullSystem,
    motion: ModelMotion,
    instants: Instants,
) -> FloatArray:
    """Return what the struts exert beyond the linear parts: aft, fore, along, ``(samples, 3)``.

    Along the model there is no linear part, so that is the whole force, but for the laws': friction
    and springs act across. A law of the model's motion through the water acts across the model at
    its reference point, at its exact velocity.

    Parameters
    ----------
    numbers
        Of the hull: the system's, or a part of them (:mod:`sim.model.numbers`).
    """
    moves = np.concatenate(motion[:3], axis=1)
    at = moving(numbers, moves, instants.speed_m_s)
    total, across = np.zeros((len(moves), 3)), np.zeros(len(moves))
    for acting in laws:
        along, share = direction(acting.point, system.to_motion)
        velocity, acceleration = motion.velocity @ along, motion.acceleration @ along
        through = acting.point is Point.THROUGH_WATER
        if through:
            velocity, acceleration = at.v, at.v_rate
        force = acting.law.force(
            LawInput(
                motion.position @ along, velocity, acceleration, motion.load @ share, *instants
            )
        )
        if through:
            across += force
        else:
            total[:, :2] += force[:, np.newaxis] * along
    total += readings(numbers, at, across) - numbers[geometry.AT_REST, :3]
    total[:, :2] -= moves @ numbers[geometry.LINEAR : geometry.LINEAR + 2, :6].T
    return total


def direction(point: Point, to_motion: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return what of the struts' motion a point has, and what of their loads: shape ``(2,)``."""
    if point in (Point.AFT, Point.FORE):
        unit = np.eye(2)[0 if point is Point.AFT else 1]
        return unit, unit
    row = 1 if point is Point.ROTATION else 0
    return to_motion[row], np.linalg.inv(to_motion).T[row]


def law_harmonics(
    laws: tuple[Acting, ...],
    system: HullSystem,
    waves: ComplexArray,
    period: Period,
    speed_m_s: float,
) -> ComplexArray:
    """Return the harmonics of :func:`law_forces` over a period, shape ``(orders + 1, 3)``.

    What jumps or bends is integrated between its corners, all else at the period's points.

    Parameters
    ----------
    waves
        Harmonics of h, h', h'' and the load of the linear parts at the struts,
        ``(orders + 1, 8)``.
    """
    laws = tuple(acting for acting in laws if acting.law.periodic)
    smooth = tuple(acting for acting in laws if not acting.law.corners)
    values = period.values(waves)
    at_points = ModelMotion(*np.split(values, 4, axis=1))
    instants = Instants(period.time_s, period.step_s, np.full(period.points, speed_m_s))
    numbers = system.numbers
    harmonics = period.harmonics(
        law_forces(smooth, without_corners(numbers), system, at_points, instants)
    )
    at = moving(numbers, values[:, :6], instants.speed_m_s)
    through = period.harmonics(np.stack([at.v, at.r, at.v_rate], axis=1))
    for group, part, signals, corners in _cornered(laws, system, np.hstack([waves, through])):
        phase, weight = nodes_between(signals, corners, period.points)
        turned = np.exp(1j * np.outer(phase, np.arange(len(waves))))
        motion = ModelMotion(*np.split((turned @ waves).real, 4, axis=1))
        instants = Instants(phase / period.omega_rad_s, 0.0, np.full(phase.size, speed_m_s))
        force = law_forces(group, part, system, motion, instants)
        added = 2.0 * (turned.conj() * weight[:, np.newaxis]).T @ force
        added[0] = added[0].real / 2.0
        harmonics += added
    return harmonics


def _cornered(
    laws: tuple[Acting, ...], system: HullSystem, waves: ComplexArray
) -> Iterator[tuple[tuple[Acting, ...], FloatArray, ComplexArray, FloatArray]]:
    """Yield each force with corners: laws and numbers that have it alone, what it depends on.

    Of that the harmonics, a row each, and the corners.

    Parameters
    ----------
    waves
        With those of the velocities v and r and the acceleration v' as the last three columns.
    """
    for acting in laws:
        if acting.law.corners:
            signals = arguments_of(acting, system) @ waves.T
            corners = np.array(acting.law.corners, dtype=float)
            yield (acting,), geometry_only(system.numbers), signals, corners
    if has_corners(system.numbers):
        corners = np.array([[0.0, 0.0], [1.0, 0.0]])
        yield (), corners_only(system.numbers), waves[:, 8:10].T, corners


def arguments_of(acting: Acting, system: HullSystem) -> FloatArray:
    """Return what a law depends on, shape ``(4, 11)``.

    Rows are position, velocity, acceleration and load (:class:`sim.model.force_law.Argument`);
    columns h, h', h'' and the linear load at both struts, then v, r and v' through the water.
    """
    along, share = direction(acting.point, system.to_motion)
    arguments = np.zeros((4, 11))
    arguments[0, :2], arguments[3, 6:8] = along, share
    if acting.point is Point.THROUGH_WATER:
        arguments[1, 8] = arguments[2, 10] = 1.0
    else:
        arguments[1, 2:4] = arguments[2, 4:6] = along
    return arguments
