"""The rates of everything that is integrated, compiled: three ways for a model to be held."""

from tests.sealed.generator.compiled import WIDE, compiled
from tests.sealed.generator.finite import finite_place, finite_rates
from tests.sealed.generator.loads import carriage_speed
from tests.sealed.generator.mechanics import (
    above,
    crank,
    drive_rates,
    frame_rates,
    gauge_force,
    kept_at,
    side,
    slosh_rates,
    wake_rates,
    water_takes,
)
from tests.sealed.generator.parameters import FloatArray, P
from tests.sealed.generator.places import H, W, Y
from tests.sealed.generator.rigid import rigid_place, rigid_rates


@compiled
def loose_rates(
    p: FloatArray, t: float, y: FloatArray, held: FloatArray, w: FloatArray, dy: FloatArray
) -> None:
    """Write the rates of a model on gauges (and a frame) that give way."""
    push0, push1, pull, load = -w[W.WATER_0], -w[W.WATER_1], 0.0, 0.0
    for strut in range(2):
        at = W.WAY_AFT + 3 * strut
        slope = w[at + 1]
        force = gauge_force(p, y, held, strut, w[at], slope * y[Y.CRANK_SPEED])
        free = force - kept_at(p, y, held, strut)
        held[H.FORCE_AFT + strut] = force
        load += slope * force + above(p, y, held, slope, strut)
        pull += force
        push0 += free
        push1 += side(p, strut) * p[P.LEVER] * free
    drive_rates(p, y, held, load, 0.0, dy)
    frame_rates(p, t, y, pull, dy)
    det = w[W.M00] * w[W.M11] - w[W.M01] * w[W.M10]
    dy[Y.Q0] = y[Y.V0]
    dy[Y.Q1] = y[Y.V1]
    dy[Y.V0] = (w[W.M11] * push0 - w[W.M01] * push1) / det
    dy[Y.V1] = (w[W.M00] * push1 - w[W.M10] * push0) / det


@compiled
def put(p: FloatArray, y: FloatArray, w: FloatArray) -> None:
    """Write the struts' places into ``w``; on rigid gauges the model's go with them."""
    for strut in range(2):
        crank(p, strut, y[Y.CRANK], w)
    if p[P.GAUGE_STIFFNESS] == 0.0:
        if WIDE and p[P.EXACT] > 0.0:
            finite_place(p, y, w)
        else:
            rigid_place(p, y, w)


@compiled
def rates(
    p: FloatArray, t: float, y: FloatArray, held: FloatArray, w: FloatArray, dy: FloatArray
) -> None:
    """Write the rates of all states; the gauges' forces are left in ``held``."""
    dy[:] = 0.0
    loose = p[P.GAUGE_STIFFNESS] > 0.0
    put(p, y, w)
    water_takes(p, t, y, held, w)
    if p[P.SLOSH_MASS] > 0.0:
        w[W.WATER_0] -= p[P.SLOSH_MASS] * slosh_rates(p, y, dy)
    if loose:
        loose_rates(p, t, y, held, w, dy)
    elif WIDE and p[P.EXACT] > 0.0:
        finite_rates(p, t, y, held, w, dy)
    else:
        rigid_rates(p, y, held, w, dy)
    dy[Y.SLOSH_SPEED] -= dy[Y.V0]
    if p[P.WAKE] != 0.0:
        wake_rates(p, y, carriage_speed(p, t), dy)
    if not loose:
        dy[Y.V0] = 0.0
