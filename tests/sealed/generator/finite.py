"""A model on rigid gauges at angles of any size, compiled; the arrangement is the rig's own.

Plane of the struts: x ahead, y along d (across or down); gamma turns x into y, so that yaw is gamma
and pitch is -gamma. The reference point lies half the spacing off the pivot on the struts' line.
"""

import math

from tests.sealed.generator.compiled import compiled
from tests.sealed.generator.loads import carriage_speed, kelvin
from tests.sealed.generator.mechanics import above, drive_rates, kept_at
from tests.sealed.generator.parameters import FloatArray, P
from tests.sealed.generator.places import H, W, Y


@compiled
def line(p: FloatArray, w: FloatArray) -> None:
    """Write angle, slope and curvature of the struts' line over the shaft's angle."""
    double = 2.0 * p[P.LEVER]
    rise = (w[W.WAY_FORE] - w[W.WAY_AFT]) / double
    slope = (w[W.WAY_FORE + 1] - w[W.WAY_AFT + 1]) / double
    curve = (w[W.WAY_FORE + 2] - w[W.WAY_AFT + 2]) / double
    if p[P.SLIDES_ON_RIG] > 0.0:
        rise += math.sin(p[P.STRUTS_OFFSET])
        cosine = math.sqrt(1.0 - rise * rise)
        w[W.LINE] = math.asin(rise)
        w[W.LINE + 1] = slope / cosine
        w[W.LINE + 2] = (curve + rise * slope * slope / cosine**2) / cosine
    else:
        rise += math.tan(p[P.STRUTS_OFFSET])
        stretched = 1.0 + rise * rise
        w[W.LINE] = math.atan(rise)
        w[W.LINE + 1] = slope / stretched
        w[W.LINE + 2] = (curve - 2.0 * rise * slope * slope / stretched) / stretched


@compiled
def pivot(p: FloatArray) -> int:
    """Return the strut that does not slide: 0 aft, 1 fore."""
    return 1 if p[P.FORE_PIVOT] > 0.0 else 0


@compiled
def pivot_way(p: FloatArray) -> int:
    """Return the place of the displacement of the strut that does not slide."""
    return W.WAY_AFT + 3 * pivot(p)


@compiled
def ahead_of_pivot(p: FloatArray) -> float:
    """Return how far the reference point lies ahead of the pivot."""
    return float(-p[P.LEVER] if p[P.FORE_PIVOT] > 0.0 else p[P.LEVER])


@compiled
def along(p: FloatArray, speed: float, g: float, w: FloatArray) -> float:
    """Return the reference point's velocity along the rig."""
    return float(speed * math.cos(p[P.RIG_TURNED]) - ahead_of_pivot(p) * math.sin(w[W.LINE]) * g)


@compiled
def across(p: FloatArray, speed: float, g: float, rate: float, w: FloatArray) -> float:
    """Return the reference point's velocity across the rig."""
    own = w[pivot_way(p) + 1] * rate + ahead_of_pivot(p) * math.cos(w[W.LINE]) * g
    return float(own - speed * math.sin(p[P.RIG_TURNED]))


@compiled
def finite_place(p: FloatArray, y: FloatArray, w: FloatArray) -> None:
    """Write the model's place and velocities into ``y``.

    ``V0`` is what makes the velocity through the water at small angles, V0 + incidence U Q1, the
    one across the model's axis at these.
    """
    line(p, w)
    rate, speed = y[Y.CRANK_SPEED], p[P.SPEED] * (1.0 + p[P.CARRIAGE_ERROR])
    g, angle = w[W.LINE + 1] * rate, w[W.LINE] + p[P.MODEL_TURNED]
    offset = p[P.LEVER] * math.tan(p[P.STRUTS_OFFSET])
    if p[P.SLIDES_ON_RIG] > 0.0:
        offset = p[P.LEVER] * math.sin(p[P.STRUTS_OFFSET])
    mean = offset if p[P.FORE_PIVOT] > 0.0 else -offset
    sine, cosine = math.sin(angle), math.cos(angle)
    y[Y.Q0] = w[pivot_way(p)] + mean + ahead_of_pivot(p) * math.sin(w[W.LINE])
    y[Y.Q1] = -p[P.INCIDENCE] * angle
    v = across(p, speed, g, rate, w) * cosine - along(p, speed, g, w) * sine
    y[Y.V0] = v - p[P.INCIDENCE] * speed * y[Y.Q1]
    y[Y.V1] = -p[P.INCIDENCE] * g


@compiled
def shared(
    p: FloatArray,
    x: float,
    push: float,
    moment: float,
    tared: float,
    gamma: float,
    rate: float,
    y: FloatArray,
    held: FloatArray,
    w: FloatArray,
) -> float:
    """Share the model's loads among the struts; write what gauges read and return the torque."""
    lever, sine, cosine = p[P.LEVER], math.sin(gamma), math.cos(gamma)
    c, s = math.cos(p[P.MODEL_TURNED]), math.sin(p[P.MODEL_TURNED])
    way = -1.0 if p[P.FORE_PIVOT] > 0.0 else 1.0
    pulled, pushed = x * c - push * s, x * s + push * c
    turned = -p[P.INCIDENCE] * moment
    on_rig, on_frame = p[P.SLIDES_ON_RIG] > 0.0, p[P.RIG_GAUGES] > 0.0
    spread = 2.0 * lever if on_rig else 2.0 * lever / cosine
    slides = (pushed * lever + way * turned) / spread
    stays = pushed - slides
    # Along the rig's normal: what the shaft works against.
    held_n = slides / cosine if on_rig else slides * cosine
    stays_n = stays * cosine + (pulled - (held_n * sine if on_rig else 0.0)) * sine
    one = pivot(p)
    torque = stays_n * w[W.WAY_AFT + 3 * one + 1] + held_n * w[W.WAY_FORE - 3 * one + 1]
    held[H.FORCE_AFT + one] = stays_n if on_frame else stays
    held[H.FORCE_FORE - one] = held_n if on_frame else slides
    for strut in range(2):
        slope = w[W.WAY_AFT + 3 * strut + 1]
        kept = kept_at(p, y, held, strut)
        share = 0.5 - (0.5 - strut) * p[P.CG_X] / lever
        held[H.FORCE_AFT + strut] += kept + tared * share
        torque += slope * kept + above(p, y, held, slope, strut)
    return torque


@compiled
def finite_load(
    p: FloatArray, speed: float, alpha: float, y: FloatArray, held: FloatArray, w: FloatArray
) -> float:
    """Write the gauges' forces at a shaft's acceleration; return the torque that the struts take.

    ``speed`` is that of the carriage against the water, as the water's loads in ``w`` have it.
    """
    sign, rate, arm = p[P.INCIDENCE], y[Y.CRANK_SPEED], ahead_of_pivot(p)
    gamma = w[W.LINE]
    g, turning = w[W.LINE + 1] * rate, w[W.LINE + 2] * rate * rate + w[W.LINE + 1] * alpha
    at = pivot_way(p)
    ax = -arm * (math.cos(gamma) * g * g + math.sin(gamma) * turning)
    ay = w[at + 2] * rate * rate + w[at + 1] * alpha
    ay += arm * (math.cos(gamma) * turning - math.sin(gamma) * g * g)
    sine, cosine = math.sin(gamma + p[P.MODEL_TURNED]), math.cos(gamma + p[P.MODEL_TURNED])
    vx, vy = along(p, speed, g, w), across(p, speed, g, rate, w)
    u = vx * cosine + vy * sine
    own_x, own_y = ax * cosine + ay * sine, ay * cosine - ax * sine
    # Inertia; the matrix has the added mass too, on the acceleration of v and on -sign U r.
    low = p[P.CG_Z] if p[P.GRAVITY] > 0.0 else 0.0
    wet = p[P.WATER] * (1.0 + p[P.DENSITY_KELVIN] * kelvin(p)) * (1.0 + p[P.BLOCKAGE])
    x = p[P.MASS] * (own_x - p[P.CG_X] * g * g - low * turning)
    x -= p[P.WATER] * p[P.SURGE_UU] * u * abs(u)
    push = w[W.WATER_0] + w[W.M00] * own_y - sign * w[W.M01] * turning
    push += wet * p[P.ADDED_00] * (speed - u) * g - p[P.MASS] * low * g * g
    moment = w[W.WATER_1] + w[W.M10] * own_y - sign * w[W.M11] * turning
    moment += wet * p[P.ADDED_10] * (speed - u) * g + sign * p[P.MASS] * low * own_x
    # Weight: the water's loads have its moment at small angles, less the mean one.
    heavy = p[P.MASS] * p[P.GRAVITY]
    moment += heavy * p[P.CG_Z] * (math.sin(y[Y.Q1]) - y[Y.Q1])
    tared = 0.0
    if p[P.WATER] == 0.0 and heavy > 0.0:
        x -= heavy * sine
        push -= heavy * cosine
        moment += heavy * p[P.CG_X] * cosine
        tared = heavy
    return shared(p, x, push, moment, tared, gamma, rate, y, held, w)


@compiled
def finite_rates(
    p: FloatArray, t: float, y: FloatArray, held: FloatArray, w: FloatArray, dy: FloatArray
) -> None:
    """Write the rates of a shaft that carries the model; loads are linear in its acceleration."""
    speed = carriage_speed(p, t) * (1.0 + 1.5 * p[P.BLOCKAGE])
    load = finite_load(p, speed, 0.0, y, held, w)
    carried = finite_load(p, speed, 1.0, y, held, w) - load
    drive_rates(p, y, held, load, carried, dy)
    finite_load(p, speed, dy[Y.CRANK_SPEED], y, held, w)
    dy[Y.V0] = w[pivot_way(p) + 2] * y[Y.CRANK_SPEED] ** 2
