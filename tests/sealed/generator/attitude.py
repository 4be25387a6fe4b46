"""Where the model is and how it moves, at angles of any size, compiled.

Plane of the struts: x ahead, y along d (across or down); gamma turns x into y, so that yaw is gamma
and pitch is -gamma. The reference point lies half the spacing off the pivot on the struts' line.
"""

import math

from tests.sealed.generator.compiled import compiled
from tests.sealed.generator.parameters import FloatArray, P
from tests.sealed.generator.places import W, Y


@compiled
def pivot(p: FloatArray) -> int:
    """Return the strut that does not slide: 0 aft, 1 fore."""
    return 1 if p[P.FORE_PIVOT] > 0.0 else 0


@compiled
def ahead_of_pivot(p: FloatArray) -> float:
    """Return how far the reference point lies ahead of the pivot."""
    return float(-p[P.LEVER] if p[P.FORE_PIVOT] > 0.0 else p[P.LEVER])


@compiled
def middle(p: FloatArray, strut: int) -> float:
    """Return where a strut's displacements are counted from, across the rig."""
    if p[P.SLIDES_ON_RIG] > 0.0:
        offset = p[P.LEVER] * math.sin(p[P.STRUTS_OFFSET])
    else:
        offset = p[P.LEVER] * math.tan(p[P.STRUTS_OFFSET])
    return float(offset if strut == 1 else -offset)


@compiled
def line(p: FloatArray, w: FloatArray) -> None:
    """Write angle, slope and curvature of the struts' line over the shaft's angle."""
    double = 2.0 * p[P.LEVER]
    rise = (w[W.WAY_FORE] - w[W.WAY_AFT] + middle(p, 1) - middle(p, 0)) / double
    slope = (w[W.WAY_FORE + 1] - w[W.WAY_AFT + 1]) / double
    curve = (w[W.WAY_FORE + 2] - w[W.WAY_AFT + 2]) / double
    if p[P.SLIDES_ON_RIG] > 0.0:
        cosine = math.sqrt(1.0 - rise * rise)
        w[W.LINE] = math.asin(rise)
        w[W.LINE + 1] = slope / cosine
        w[W.LINE + 2] = (curve + rise * slope * slope / cosine**2) / cosine
    else:
        stretched = 1.0 + rise * rise
        w[W.LINE] = math.atan(rise)
        w[W.LINE + 1] = slope / stretched
        w[W.LINE + 2] = (curve - 2.0 * rise * slope * slope / stretched) / stretched


@compiled
def turned(p: FloatArray, angle: float, w: FloatArray) -> None:
    """Write sine and cosine of the line's angle and of the model's."""
    w[W.SINE], w[W.COSINE] = math.sin(angle), math.cos(angle)
    w[W.OWN_SINE], w[W.OWN_COSINE] = w[W.SINE], w[W.COSINE]
    if p[P.MODEL_TURNED] != 0.0:
        own = angle + p[P.MODEL_TURNED]
        w[W.OWN_SINE], w[W.OWN_COSINE] = math.sin(own), math.cos(own)


@compiled
def follow(p: FloatArray, y: FloatArray, w: FloatArray) -> None:
    """Write the place of a model that goes where the struts go."""
    line(p, w)
    turned(p, w[W.LINE], w)
    rate, arm, one = y[Y.CRANK_SPEED], ahead_of_pivot(p), pivot(p)
    way = W.WAY_AFT + 3 * one
    w[W.SPIN] = w[W.LINE + 1] * rate
    y[Y.Q0] = w[way] + middle(p, one) + arm * w[W.SINE]
    y[Y.V0] = w[way + 1] * rate + arm * w[W.COSINE] * w[W.SPIN]
    y[Y.Q1] = -p[P.INCIDENCE] * (w[W.LINE] + p[P.MODEL_TURNED])
    y[Y.V1] = -p[P.INCIDENCE] * w[W.SPIN]
    for strut in range(2):
        w[W.AT_AFT + strut] = w[W.WAY_AFT + 3 * strut]
        w[W.RATE_AFT + strut] = w[W.WAY_AFT + 3 * strut + 1] * rate


@compiled
def lie(p: FloatArray, y: FloatArray, w: FloatArray) -> None:
    """Write where the struts would be at the place of a model on gauges that give way."""
    turned(p, -p[P.INCIDENCE] * y[Y.Q1] - p[P.MODEL_TURNED], w)
    w[W.SPIN] = -p[P.INCIDENCE] * y[Y.V1]
    arm, one = ahead_of_pivot(p), pivot(p)
    way, speed = y[Y.Q0] - arm * w[W.SINE], y[Y.V0] - arm * w[W.COSINE] * w[W.SPIN]
    w[W.AT_AFT + one], w[W.RATE_AFT + one] = way - middle(p, one), speed
    if p[P.SLIDES_ON_RIG] > 0.0:
        way += 2.0 * arm * w[W.SINE]
        speed += 2.0 * arm * w[W.COSINE] * w[W.SPIN]
    else:
        way += 2.0 * arm * w[W.SINE] / w[W.COSINE]
        speed += 2.0 * arm * w[W.SPIN] / w[W.COSINE] ** 2
    other = 1 - one
    w[W.AT_AFT + other], w[W.RATE_AFT + other] = way - middle(p, other), speed


@compiled
def through(p: FloatArray, speed: float, y: FloatArray, w: FloatArray) -> None:
    """Write the reference point's velocity through water that the carriage passes at a speed."""
    ahead = speed * math.cos(p[P.RIG_TURNED]) - ahead_of_pivot(p) * w[W.SINE] * w[W.SPIN]
    across = y[Y.V0] - speed * math.sin(p[P.RIG_TURNED])
    w[W.AHEAD] = ahead * w[W.OWN_COSINE] + across * w[W.OWN_SINE]
    w[W.THROUGH] = across * w[W.OWN_COSINE] - ahead * w[W.OWN_SINE]
