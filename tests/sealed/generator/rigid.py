"""A model on rigid gauges at small angles, compiled: it goes where the struts go."""

import math

from tests.sealed.generator.compiled import WIDE, compiled
from tests.sealed.generator.mechanics import above, drive_rates, kept_at, side
from tests.sealed.generator.parameters import FloatArray, P
from tests.sealed.generator.places import H, W, Y


@compiled
def rigid_place(p: FloatArray, y: FloatArray, w: FloatArray) -> None:
    """Write the model's place by the struts' into ``y`` and ``w``: slopes and curvatures too."""
    for i in range(3):
        w[W.MEAN + i] = 0.5 * (w[W.WAY_AFT + i] + w[W.WAY_FORE + i])
        w[W.TURN + i] = side(p, 0) * (w[W.WAY_AFT + i] - w[W.WAY_FORE + i]) / (2.0 * p[P.LEVER])
    w[W.COSINE] = 1.0
    if p[P.ARC] > 0.0:
        u, slope, curve = w[W.TURN], w[W.TURN + 1], w[W.TURN + 2]
        cosine = math.sqrt(1.0 - u * u)
        w[W.TURN] = math.asin(u)
        w[W.TURN + 1] = slope / cosine
        w[W.TURN + 2] = (curve + u * slope * slope / cosine**2) / cosine
        w[W.COSINE] = cosine
        if WIDE and p[P.ARC] > 1.5:
            stretched = 1.0 + u * u
            w[W.TURN] = math.atan(u)
            w[W.TURN + 1] = slope / stretched
            w[W.TURN + 2] = (curve - 2.0 * u * slope * slope / stretched) / stretched
            w[W.COSINE] = stretched
    y[Y.Q0], y[Y.V0] = w[W.MEAN], w[W.MEAN + 1] * y[Y.CRANK_SPEED]
    y[Y.Q1], y[Y.V1] = w[W.TURN], w[W.TURN + 1] * y[Y.CRANK_SPEED]


@compiled
def rigid_rates(
    p: FloatArray, y: FloatArray, held: FloatArray, w: FloatArray, dy: FloatArray
) -> None:
    """Write the rates of a shaft that carries the model's inertia; forces by Newton's law."""
    speed = y[Y.CRANK_SPEED]
    slope0, slope1 = w[W.MEAN + 1], w[W.TURN + 1]
    load0 = w[W.WATER_0] + (w[W.M00] * w[W.MEAN + 2] + w[W.M01] * w[W.TURN + 2]) * speed**2
    load1 = w[W.WATER_1] + (w[W.M10] * w[W.MEAN + 2] + w[W.M11] * w[W.TURN + 2]) * speed**2
    heavy0 = w[W.M00] * slope0 + w[W.M01] * slope1
    heavy1 = w[W.M10] * slope0 + w[W.M11] * slope1
    load = slope0 * load0 + slope1 * load1
    for strut in range(2):
        slope = w[W.WAY_AFT + 3 * strut + 1]
        w[W.KEPT_AFT + strut] = kept_at(p, y, held, strut)
        load += slope * w[W.KEPT_AFT + strut] + above(p, y, held, slope, strut)
    drive_rates(p, y, held, load, slope0 * heavy0 + slope1 * heavy1, dy)
    load0 += heavy0 * dy[Y.CRANK_SPEED]
    load1 += heavy1 * dy[Y.CRANK_SPEED]
    for strut in range(2):
        moment = side(p, strut) * load1 / (2.0 * p[P.LEVER] * w[W.COSINE])
        held[H.FORCE_AFT + strut] = 0.5 * load0 + moment + w[W.KEPT_AFT + strut]
    dy[Y.V0] = w[W.MEAN + 2] * speed**2 + slope0 * dy[Y.CRANK_SPEED]
