"""How struts hold the model, at angles of any size, compiled: on rigid gauges or on ones that give.

On rigid gauges the model goes where the struts go and the shaft carries its inertia; else it moves
on its own. The loads on the struts are linear in the model's accelerations.
"""

import math

from tests.sealed.generator.attitude import ahead_of_pivot, pivot
from tests.sealed.generator.compiled import compiled
from tests.sealed.generator.mechanics import above, drive_rates, frame_rates, gauge_force, kept_at
from tests.sealed.generator.parameters import FloatArray, P
from tests.sealed.generator.places import H, W, Y


@compiled
def shared(
    p: FloatArray,
    x: float,
    push: float,
    moment: float,
    held: FloatArray,
    w: FloatArray,
) -> float:
    """Share the model's loads among the struts; write what gauges read and return the torque."""
    lever, sine, cosine = p[P.LEVER], w[W.SINE], w[W.COSINE]
    way = -1.0 if p[P.FORE_PIVOT] > 0.0 else 1.0
    pulled, pushed = x, push
    if p[P.MODEL_TURNED] != 0.0:
        c, s = math.cos(p[P.MODEL_TURNED]), math.sin(p[P.MODEL_TURNED])
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
    return float(torque)


@compiled
def hangs(p: FloatArray) -> float:
    """Return the weight that the struts carry."""
    return float(p[P.MASS] * p[P.GRAVITY] if p[P.WATER] == 0.0 else 0.0)


@compiled
def besides(p: FloatArray, y: FloatArray, held: FloatArray, w: FloatArray) -> float:
    """Write what the gauges read beside the model's loads, and return the torque of it.

    That is what parts below them keep; the weight at rest is tared.
    """
    torque = 0.0
    for strut in range(2):
        slope, kept = w[W.WAY_AFT + 3 * strut + 1], kept_at(p, held, strut, w)
        share = 0.5 - (0.5 - strut) * p[P.CG_X] / p[P.LEVER]
        w[W.BESIDE_AFT + strut] = kept + hangs(p) * share
        torque += slope * kept + above(p, y, held, slope, strut)
    return torque


@compiled
def loads(p: FloatArray, across: float, turning: float, held: FloatArray, w: FloatArray) -> float:
    """Write what the gauges read of a model that accelerates; return the torque of it.

    ``across`` is that of the reference point across the rig, ``turning`` that of the struts' line.
    """
    sign, g, arm = p[P.INCIDENCE], w[W.SPIN], ahead_of_pivot(p)
    ahead = -arm * (w[W.COSINE] * g * g + w[W.SINE] * turning)
    sine, cosine = w[W.OWN_SINE], w[W.OWN_COSINE]
    own_x, own_y = ahead * cosine + across * sine, across * cosine - ahead * sine
    low = p[P.CG_Z] if p[P.GRAVITY] > 0.0 else 0.0
    x = p[P.MASS] * (own_x - p[P.CG_X] * g * g - low * turning)
    x -= p[P.WATER] * p[P.SURGE_UU] * w[W.AHEAD] * abs(w[W.AHEAD])
    # The matrix has the added mass too; of its rate of v the water has what turning brings.
    push = w[W.WATER_0] + w[W.M00] * own_y - sign * w[W.M01] * turning
    push -= p[P.MASS] * low * g * g
    moment = w[W.WATER_1] + w[W.M10] * own_y - sign * w[W.M11] * turning
    moment += sign * p[P.MASS] * low * own_x
    heavy = hangs(p)
    x -= heavy * sine
    push -= heavy * cosine
    moment += heavy * p[P.CG_X] * cosine
    return shared(p, x, push, moment, held, w)


@compiled
def carried_loads(
    p: FloatArray, alpha: float, y: FloatArray, held: FloatArray, w: FloatArray
) -> float:
    """Write what the gauges read of a model on rigid ones; return the torque of it."""
    rate, arm, way = y[Y.CRANK_SPEED], ahead_of_pivot(p), W.WAY_AFT + 3 * pivot(p)
    turning = w[W.LINE + 2] * rate * rate + w[W.LINE + 1] * alpha
    across = w[way + 2] * rate * rate + w[way + 1] * alpha
    across += arm * (w[W.COSINE] * turning - w[W.SINE] * w[W.SPIN] ** 2)
    w[W.ACROSS] = across
    return loads(p, across, turning, held, w)


@compiled
def rigid_rates(
    p: FloatArray, y: FloatArray, held: FloatArray, w: FloatArray, dy: FloatArray
) -> None:
    """Write the rates of a shaft that carries the model, and the model's acceleration across."""
    load = carried_loads(p, 0.0, y, held, w)
    carried = carried_loads(p, 1.0, y, held, w) - load
    drive_rates(p, y, held, load + besides(p, y, held, w), carried, dy)
    carried_loads(p, dy[Y.CRANK_SPEED], y, held, w)
    for strut in range(2):
        held[H.FORCE_AFT + strut] += w[W.BESIDE_AFT + strut]
    dy[Y.V0] = w[W.ACROSS]


@compiled
def loose_rates(
    p: FloatArray, t: float, y: FloatArray, held: FloatArray, w: FloatArray, dy: FloatArray
) -> None:
    """Write the rates of a model on gauges (and a frame) that give way.

    It accelerates so that the gauges' springs pull as its loads ask.
    """
    torque = besides(p, y, held, w)
    loads(p, 0.0, 0.0, held, w)
    aft, fore = held[H.FORCE_AFT], held[H.FORCE_FORE]
    loads(p, 1.0, 0.0, held, w)
    aft_0, fore_0 = held[H.FORCE_AFT] - aft, held[H.FORCE_FORE] - fore
    loads(p, 0.0, 1.0, held, w)
    aft_1, fore_1 = held[H.FORCE_AFT] - aft, held[H.FORCE_FORE] - fore
    on_aft, on_fore = gauge_force(p, y, held, 0, w), gauge_force(p, y, held, 1, w)
    aft, fore = on_aft - w[W.BESIDE_AFT] - aft, on_fore - w[W.BESIDE_FORE] - fore
    det = aft_0 * fore_1 - aft_1 * fore_0
    across, turning = (fore_1 * aft - aft_1 * fore) / det, (aft_0 * fore - fore_0 * aft) / det
    torque += loads(p, across, turning, held, w)
    held[H.FORCE_AFT], held[H.FORCE_FORE] = on_aft, on_fore
    drive_rates(p, y, held, torque, 0.0, dy)
    frame_rates(p, t, y, on_aft + on_fore, dy)
    dy[Y.Q0], dy[Y.V0] = y[Y.V0], across
    dy[Y.Q1], dy[Y.V1] = y[Y.V1], -p[P.INCIDENCE] * turning
