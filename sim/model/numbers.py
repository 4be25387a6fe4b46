"""The numbers of a hull that :mod:`sim.mechanism.geometry` reckons with, and their consequences."""

import math

import numpy as np

from hardware.description.arrangement import DriftBy, Gauges, Joint, Pivot
from hardware.description.arrays import FloatArray
from hardware.description.oscillator import Plane
from hardware.description.units import STANDARD_GRAVITY_M_S2
from sim.mechanism import geometry
from sim.mechanism.geometry import BodyMotion, body_loads, body_motion, gauge_readings
from sim.model.parameters import ModelParameters

_STILL = (np.float64(0.0),) * 7  # displacements, rates, accelerations and speed
_BENDING = slice(geometry.QUADRATIC, geometry.QUADRATIC + 2)


def numbers_of(hull: ModelParameters, added_mass: FloatArray, linear: FloatArray) -> FloatArray:
    """Return the numbers of a hull, shape ``(ROWS, COLUMNS)`` of :mod:`sim.mechanism.geometry`.

    Parameters
    ----------
    added_mass
        With what the radiation adds at infinite frequency, ``(2, 2)``.
    linear
        What the linear system has for the struts' forces already, per (h, h', h''): ``(2, 6)``.
    """
    numbers = np.zeros((geometry.ROWS, geometry.COLUMNS))
    numbers[geometry.GEOMETRY, : geometry.TURN] = _geometry(hull)
    _fill_body(numbers, hull)
    _fill_water(numbers, hull, added_mass)
    still = body_motion(numbers, *_STILL)  # at rest, before anything turns
    loads = body_loads(numbers, still)
    numbers[geometry.AT_REST, :3] = gauge_readings(numbers, still.cosine, still.sine, *loads)
    numbers[geometry.LINEAR : geometry.LINEAR + 2, :6] = linear
    numbers[geometry.GEOMETRY, geometry.TURN] = turns_with(hull.plane) * hull.turn_rate_rad_s
    return numbers


def moving(numbers: FloatArray, motion: FloatArray, speed_m_s: FloatArray) -> BodyMotion:
    """Return how the model moves where the struts' h, h' and h'' are ``motion``, six columns."""
    y, v, a = np.ascontiguousarray(motion.T).reshape(3, 2, -1)
    return body_motion(numbers, y[0], y[1], v[0], v[1], a[0], a[1], speed_m_s)


def readings(
    numbers: FloatArray, at: BodyMotion, more_across: FloatArray | float = 0.0
) -> FloatArray:
    """Return what the gauges read, aft, fore and along, shape ``(samples, 3)``.

    Parameters
    ----------
    more_across
        Force that the struts have to exert besides, across the model at its reference point.
    """
    ahead, across, about = body_loads(numbers, at)
    readings = gauge_readings(numbers, at.cosine, at.sine, ahead, across + more_across, about)
    return np.stack(readings, axis=1)


def surging_readings(
    numbers: FloatArray, motion: FloatArray, speed_m_s: FloatArray, gain_m_s2: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return what the gauges read of the carriage's acceleration alone: aft, fore and along."""
    at = moving(numbers, motion, speed_m_s)
    ahead, across = gain_m_s2 * at.tank_cosine, -gain_m_s2 * at.tank_sine
    surging = at._replace(
        ahead=at.ahead + ahead, across=at.across + across, v_rate=at.v_rate + across
    )
    with_it, without = body_loads(numbers, surging), body_loads(numbers, at)
    loads = (load - rest_load for load, rest_load in zip(with_it, without, strict=True))
    return gauge_readings(numbers, at.cosine, at.sine, *loads)


def without_corners(numbers: FloatArray) -> FloatArray:
    """Return the numbers of the same hull without the loads that bend where a velocity turns."""
    smooth = numbers.copy()
    smooth[_BENDING] = 0.0
    return smooth


def corners_only(numbers: FloatArray) -> FloatArray:
    """Return the numbers of a hull that has these loads alone."""
    bent = geometry_only(numbers)
    bent[_BENDING] = numbers[_BENDING]
    return bent


def geometry_only(numbers: FloatArray) -> FloatArray:
    """Return the numbers of a hull that asks for nothing."""
    rigid = np.zeros_like(numbers)
    rigid[geometry.GEOMETRY] = numbers[geometry.GEOMETRY]
    return rigid


def has_corners(numbers: FloatArray) -> bool:
    """Tell whether any load bends where a velocity turns."""
    return bool(numbers[_BENDING].any())


def turns_with(plane: Plane) -> float:
    """Return +1 where the rotation turns ahead into across; pitch, bow up, turns the other way."""
    return -1.0 if plane is Plane.VERTICAL else 1.0


def _geometry(hull: ModelParameters) -> tuple[float, ...]:
    arrangement, angle = hull.arrangement, turns_with(hull.plane) * hull.drift_rad
    rig, offset, struts = (angle if arrangement.drift_by is by else 0.0 for by in DriftBy)
    on_model = arrangement.joint is Joint.SLIDES_ON_MODEL
    return (
        hull.half_spacing_m,
        1.0 if arrangement.pivot is Pivot.AFT else -1.0,
        float(on_model),
        float(arrangement.gauges is Gauges.MODEL),
        math.tan(offset) if on_model else math.sin(offset),
        math.cos(rig),
        math.sin(rig),
        math.cos(struts),
        math.sin(struts),
    )


def _fill_body(numbers: FloatArray, hull: ModelParameters) -> None:
    body, vertical = hull.body, hull.plane is Plane.VERTICAL
    below = body.cg_z_m if vertical else 0.0
    numbers[geometry.BODY, :4] = body.mass_kg, body.cg_x_m, below, body.inertia_kg_m2
    numbers[geometry.HANGING, :3] = weight_less_buoyancy(hull)


def weight_less_buoyancy(hull: ModelParameters) -> FloatArray:
    """Return weight less buoyancy, in N, and its moments ahead and below, in N m.

    The last is the stiffness against pitch. In the horizontal plane nothing pulls.
    """
    if hull.plane is Plane.HORIZONTAL:
        return np.zeros(3)
    body = hull.body
    weight = body.mass_kg * np.array([1.0, body.cg_x_m, body.cg_z_m])
    return STANDARD_GRAVITY_M_S2 * (weight - _displaced_mass(hull))


def _displaced_mass(hull: ModelParameters) -> FloatArray:
    """Return what the water bears: mass, and its moments ahead and below."""
    body = hull.body
    if not hull.afloat:
        return np.zeros(3)
    if body.displaced_kg is None:
        return body.mass_kg * np.array([1.0, body.cg_x_m, 0.0])
    return body.displaced_kg * np.array([1.0, body.buoyancy_x_m, body.buoyancy_z_m])


def _fill_water(numbers: FloatArray, hull: ModelParameters, added_mass: FloatArray) -> None:
    side = turns_with(hull.plane)
    turned = np.array([[1.0, side], [side, 1.0]])
    matrices = (added_mass, hull.water.damping, hull.water.restoring)
    for row, matrix in enumerate(matrices, geometry.ADDED):
        numbers[row, :4] = (turned * np.array(matrix)).ravel()
    if hull.surge is not None:
        surge = hull.surge
        numbers[geometry.SURGE, :5] = (
            surge.x_u,
            surge.x_uu,
            surge.x_vv,
            side * surge.x_vr,
            surge.x_rr,
        )
    if hull.cross_flow is not None:
        _fill_cross_flow(numbers, hull, side)


def _fill_cross_flow(numbers: FloatArray, hull: ModelParameters, side: float) -> None:
    terms = hull.cross_flow
    kinds = (
        (geometry.CUBIC, None if terms is None else terms.cubic, (1.0, side, 1.0, side)),
        (geometry.QUADRATIC, None if terms is None else terms.quadratic, (1.0, 1.0, side, side)),
    )
    for row, rows, signs in kinds:
        if rows is not None:
            moment = np.array([[1.0], [side]])
            numbers[row : row + 2, :4] = moment * np.array(signs) * np.array(rows)
