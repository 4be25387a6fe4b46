"""The rates of everything that is integrated, compiled."""

from tests.sealed.generator.attitude import follow, lie, through
from tests.sealed.generator.compiled import compiled
from tests.sealed.generator.holding import loose_rates, rigid_rates
from tests.sealed.generator.loads import carriage_speed
from tests.sealed.generator.mechanics import crank, slosh_rates, wake_rates, water_takes
from tests.sealed.generator.parameters import FloatArray, P
from tests.sealed.generator.places import W, Y


@compiled
def put(p: FloatArray, y: FloatArray, w: FloatArray) -> None:
    """Write the struts' places into ``w``; on rigid gauges the model's go with them."""
    for strut in range(2):
        crank(p, strut, y[Y.CRANK], w)
    if p[P.GAUGE_STIFFNESS] == 0.0:
        follow(p, y, w)
    else:
        lie(p, y, w)


@compiled
def rates(
    p: FloatArray, t: float, y: FloatArray, held: FloatArray, w: FloatArray, dy: FloatArray
) -> None:
    """Write the rates of all states; the gauges' forces are left in ``held``."""
    dy[:] = 0.0
    put(p, y, w)
    speed = carriage_speed(p, t) * (1.0 + 1.5 * p[P.BLOCKAGE])
    through(p, speed, y, w)
    water_takes(p, t, speed, y, held, w)
    if p[P.SLOSH_MASS] > 0.0:
        w[W.WATER_0] -= p[P.SLOSH_MASS] * slosh_rates(p, y, dy)
    if p[P.GAUGE_STIFFNESS] > 0.0:
        loose_rates(p, t, y, held, w, dy)
    else:
        rigid_rates(p, y, held, w, dy)
    dy[Y.SLOSH_SPEED] -= dy[Y.V0]
    if p[P.WAKE] != 0.0:
        wake_rates(p, y, carriage_speed(p, t), dy)
    if p[P.GAUGE_STIFFNESS] == 0.0:
        dy[Y.V0] = 0.0
