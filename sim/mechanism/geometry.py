"""The exact geometry of struts, model and gauges at one instant, and the loads that follow from it.

In the plane of motion, ahead and across (to starboard, or down), turning from ahead to across; a
pitch, bow up, turns the other way, and :func:`sim.model.numbers.numbers_of` has turned its signs.
The struts' line stands at the angle ``a`` in the rig, whose tangent or sine is the difference of
the struts' displacements over their spacing; the model's reference point lies half the spacing off
the pivot.

Each function is arithmetic on one instant or on arrays of them.
:func:`sim.solve.compilation.compile_loop` makes compiled ones of the same three for the loops that
go from sample to sample (:mod:`sim.model.compiled_laws`); so none of them calls another.

The numbers of a hull are an array with a row for each kind, named below.
"""

from typing import Any, Final, NamedTuple, TypeAlias

import numpy as np

from hardware.description.arrays import FloatArray

# Rows, each with what stands in its columns.
GEOMETRY: Final = 0  # those of the columns below
BODY: Final = 1  # mass, centre of gravity ahead and across, moment of inertia
HANGING: Final = 2  # weight less buoyancy: force, and moments of what lies ahead and across
ADDED: Final = 3  # four elements of the matrix, as the next two
DAMPING: Final = 4
RESTORING: Final = 5
SURGE: Final = 6  # x_u, x_uu, x_vv, x_vr, x_rr
CUBIC: Final = 7  # of the force, in the next row of the moment
QUADRATIC: Final = 9
AT_REST: Final = 11  # what the gauges read at rest where the drift is set: tared
LINEAR: Final = 12  # of the aft strut, in the next row of the fore one: per h, h' and h''
ROWS: Final = 14

# Columns of the row GEOMETRY.
HALF_SPACING: Final = 0
PIVOT: Final = 1  # 1 for the aft strut, -1 for the fore one
ON_MODEL: Final = 2  # 1 where an attachment slides along the model, 0 where a strut slides
ON_LINE: Final = 3  # 1 where the gauges turn with the struts' line
OFFSET: Final = 4  # tangent or sine of the angle at which offset struts set the line
RIG_COSINE: Final = 5  # of the angle by which the rig is turned on the carriage
RIG_SINE: Final = 6
STRUTS_COSINE: Final = 7  # of the angle by which the model is turned on its struts
STRUTS_SINE: Final = 8
TURN: Final = 9  # rate at which carriage and rig go round a circle, from ahead to across
COLUMNS: Final = 10


Value: TypeAlias = Any
"""A number at one instant, or an array over instants."""


class BodyMotion(NamedTuple):
    """How the model moves.

    Attributes
    ----------
    cosine, sine
        Of the angle of the struts' line in the rig.
    place
        Of the reference point, across the tank.
    tank_cosine, tank_sine
        Of the model's angle in the tank.
    u, v, r
        Velocities through the water in body axes: ahead, across and turning.
    v_rate, r_rate
        Their time derivatives, the carriage's speed steady.
    ahead, across
        Acceleration of the reference point against the tank, in body axes.

    On a circle the tank's axes are those of the rig's way, and turn with it.
    """

    cosine: Value
    sine: Value
    place: Value
    tank_cosine: Value
    tank_sine: Value
    u: Value
    v: Value
    r: Value
    v_rate: Value
    r_rate: Value
    ahead: Value
    across: Value


def struts_line(
    hull: FloatArray, slope: Value, rate: Value, bend: Value
) -> tuple[Value, Value, Value, Value]:
    """Return cosine and sine of the angle of the struts' line, its rate, and that one's rate.

    ``rate`` and ``bend`` are the derivatives of the slope: of the tangent where the gauges stay
    with the model, else of the sine.
    """
    if hull[GEOMETRY, ON_MODEL] > 0.0:
        square = 1.0 + slope * slope
        cosine = 1.0 / np.sqrt(square)
        sine = slope * cosine
        r = rate / square
        r_rate = (bend - 2.0 * slope * rate * r) / square
    else:
        cosine = np.sqrt(1.0 - slope * slope)
        sine = slope + 0.0
        r = rate / cosine
        r_rate = (bend + slope * r * r) / cosine
    return cosine, sine, r, r_rate


def body_motion(
    hull: FloatArray,
    aft: Value,
    fore: Value,
    aft_rate: Value,
    fore_rate: Value,
    aft_acceleration: Value,
    fore_acceleration: Value,
    speed_m_s: Value,
) -> BodyMotion:
    """Return the model's motion that the struts' displacements and their derivatives make.

    The rig goes straight at the speed, or round a circle with the midpoint of its struts on it:
    then point p in the rig's axes, which turn at W, has the velocity U + p' + W x p and the
    acceleration p'' + W x (U + 2 p' + W x p).
    """
    half, pivot = hull[GEOMETRY, HALF_SPACING], hull[GEOMETRY, PIVOT]
    rig_cosine, rig_sine = hull[GEOMETRY, RIG_COSINE], hull[GEOMETRY, RIG_SINE]
    slope = (fore - aft) / (2.0 * half) + hull[GEOMETRY, OFFSET]
    rate = (fore_rate - aft_rate) / (2.0 * half)
    bend = (fore_acceleration - aft_acceleration) / (2.0 * half)
    cosine, sine, r, r_rate = struts_line(hull, slope, rate, bend)
    reach = pivot * half
    ahead, aside = reach * cosine, reach * sine
    held, held_rate, held_acceleration = aft, aft_rate, aft_acceleration
    if pivot < 0.0:
        held, held_rate, held_acceleration = fore, fore_rate, fore_acceleration
    place = (ahead - reach) * rig_sine + (
        held - reach * hull[GEOMETRY, OFFSET] + aside
    ) * rig_cosine
    x_rate = speed_m_s * rig_cosine - aside * r
    n_rate = held_rate + ahead * r - speed_m_s * rig_sine
    x_acceleration = -aside * r_rate - ahead * r * r
    n_acceleration = held_acceleration + ahead * r_rate - aside * r * r
    turn = hull[GEOMETRY, TURN]
    if turn != 0.0:
        x, n = ahead - reach, held - reach * hull[GEOMETRY, OFFSET] + aside
        x_acceleration = x_acceleration - turn * (2.0 * n_rate + speed_m_s * rig_sine + turn * x)
        n_acceleration = n_acceleration + turn * (2.0 * x_rate - speed_m_s * rig_cosine - turn * n)
        x_rate = x_rate - turn * n
        n_rate = n_rate + turn * x
        r = r + turn
    body_cosine = cosine * hull[GEOMETRY, STRUTS_COSINE] - sine * hull[GEOMETRY, STRUTS_SINE]
    body_sine = sine * hull[GEOMETRY, STRUTS_COSINE] + cosine * hull[GEOMETRY, STRUTS_SINE]
    u = x_rate * body_cosine + n_rate * body_sine
    v = n_rate * body_cosine - x_rate * body_sine
    along = x_acceleration * body_cosine + n_acceleration * body_sine
    across = n_acceleration * body_cosine - x_acceleration * body_sine
    tank_sine = body_sine * rig_cosine + body_cosine * rig_sine
    tank_cosine = body_cosine * rig_cosine - body_sine * rig_sine
    return BodyMotion(
        cosine, sine, place, tank_cosine, tank_sine, u, v, r, across - r * u, r_rate, along, across
    )


def body_loads(hull: FloatArray, at: BodyMotion) -> tuple[Value, Value, Value]:
    """Return what the struts have to exert: ahead, across, and about the reference point.

    In body axes, with the centre of gravity (x, y), the weight less the buoyancy W, its moments
    W_x and W_y, and the water's X and (rows of) A, B, C, cubic and quadratic terms:

        m (u' - v r - x r^2 - y r') - W sin(angle) - X(u, v, r)
        m (v' + u r + x r' - y r^2) - W cos(angle) + A (v', r') + B (v, r) + C (place, angle) + ...
        I r' + m x (v' + u r) - m y (u' - v r) - W_x cos(angle) + W_y sin(angle) + A ... + ...
    """
    mass, x, y = hull[BODY, 0], hull[BODY, 1], hull[BODY, 2]
    u, v, r, v_rate, r_rate = at.u, at.v, at.r, at.v_rate, at.r_rate
    ahead = mass * (at.ahead - x * r * r - y * r_rate)
    across = mass * (at.across + x * r_rate - y * r * r)
    about = hull[BODY, 3] * r_rate + mass * (x * at.across - y * at.ahead)
    ahead = ahead - hull[HANGING, 0] * at.tank_sine
    across = across - hull[HANGING, 0] * at.tank_cosine
    about = about - hull[HANGING, 1] * at.tank_cosine + hull[HANGING, 2] * at.tank_sine
    ahead = ahead - (hull[SURGE, 0] + hull[SURGE, 1] * np.abs(u)) * u
    ahead = ahead - (hull[SURGE, 2] * v + hull[SURGE, 3] * r) * v - hull[SURGE, 4] * r * r
    angle = 0.0 * r
    if hull[RESTORING, 1] != 0.0 or hull[RESTORING, 3] != 0.0:
        angle = np.arctan2(at.tank_sine, at.tank_cosine)
    powers = (v * v * v, v * v * r, v * r * r, r * r * r)
    sizes = (v * np.abs(v), v * np.abs(r), r * np.abs(v), r * np.abs(r))
    for i in range(2):
        first, second = 2 * i, 2 * i + 1
        load = hull[ADDED, first] * v_rate + hull[ADDED, second] * r_rate
        load = load + hull[DAMPING, first] * v + hull[DAMPING, second] * r
        load = load + hull[RESTORING, first] * at.place + hull[RESTORING, second] * angle
        for j in range(4):
            load = load + hull[CUBIC + i, j] * powers[j] + hull[QUADRATIC + i, j] * sizes[j]
        if i == 0:
            across = across + load
        else:
            about = about + load
    return ahead, across, about


def gauge_readings(
    hull: FloatArray,
    cosine: Value,
    sine: Value,
    ahead: Value,
    across: Value,
    about: Value,
) -> tuple[Value, Value, Value]:
    """Return what the gauges read, aft, fore and along, of the struts' load on the model.

    The strut that slides pushes at right angles to the line of the struts where it slides on the
    model, else across the rig; the pivot carries the rest.

    Parameters
    ----------
    cosine, sine
        Of the angle of the struts' line in the rig.
    ahead, across, about
        The load in body axes, about the reference point.
    """
    half, pivot = hull[GEOMETRY, HALF_SPACING], hull[GEOMETRY, PIVOT]
    on_line = ahead * hull[GEOMETRY, STRUTS_COSINE] - across * hull[GEOMETRY, STRUTS_SINE]
    over = ahead * hull[GEOMETRY, STRUTS_SINE] + across * hull[GEOMETRY, STRUTS_COSINE]
    slide = (pivot * about / half + over) / 2.0
    if hull[GEOMETRY, ON_MODEL] > 0.0:
        slide = slide * cosine
        along = on_line
        slide_on_rig = slide * cosine
    else:
        slide_on_rig = slide / cosine
        along = on_line - slide_on_rig * sine
    held = over - slide
    if hull[GEOMETRY, ON_LINE] <= 0.0:
        slide = slide_on_rig
        held, along = held * cosine + along * sine, along * cosine - held * sine
    if pivot > 0.0:
        return held, slide, along
    return slide, held, along
