"""Force laws and exact geometry at one instant: what the compiled loops call.

Made of :mod:`sim.model.laws` and :mod:`sim.mechanism.geometry`. Loaded when the first such loop
runs, because numba is. Without numba the functions are Python.
"""

import math

from hardware.description.arrays import FloatArray
from sim.mechanism import geometry
from sim.mechanism.geometry import AT_REST, LINEAR, BodyMotion
from sim.model import laws
from sim.model.force_law import LawInput, direction, dynamic, error_function, half_change
from sim.model.friction import bristles, film
from sim.solve.compilation import callable_when_compiled, compile_loop


def _error_function(x: float) -> float:
    return math.erf(x)


callable_when_compiled(geometry.struts_line)
body_motion = compile_loop(geometry.body_motion)
body_loads = compile_loop(geometry.body_loads)
gauge_readings = compile_loop(geometry.gauge_readings)
callable_when_compiled(half_change, direction, dynamic, film, bristles)
callable_when_compiled(*(law.kernel for law in laws.LAWS))
callable_when_compiled(error_function, by=_error_function)
value_of = compile_loop(laws.law_value)


@compile_loop
def law_value(p: FloatArray, i: int, at: LawInput) -> float:
    """Return the force that one law asks for at its point.

    Parameters
    ----------
    p, i
        The laws, see :class:`sim.model.law_table.LawTable`, and the row of this one.
    """
    return float(value_of(int(p[i, 0]), (p[i, 1], p[i, 2], p[i, 3], p[i, 4]), at))


@compile_loop
def motion_at(hull: FloatArray, at: FloatArray, line: int, speed_m_s: float) -> BodyMotion:
    """Return how the model moves where a row holds h, h' and h'', two values each."""
    return body_motion(
        hull,
        at[line, 0],
        at[line, 1],
        at[line, 2],
        at[line, 3],
        at[line, 4],
        at[line, 5],
        speed_m_s,
    )


@compile_loop
def hull_readings(
    hull: FloatArray, moves: BodyMotion, more_across: float
) -> tuple[float, float, float]:
    """Return what the gauges read, aft, fore and along; as :func:`sim.model.numbers.readings`."""
    ahead, across, about = body_loads(hull, moves)
    return gauge_readings(hull, moves.cosine, moves.sine, ahead, across + more_across, about)


@compile_loop
def law_force(
    table: FloatArray,
    hull: FloatArray,
    at: FloatArray,
    line: int,
    time_s: float,
    step_s: float,
    speed_m_s: float,
    force: FloatArray,
    into: int,
) -> float:
    """Add what each strut exerts beyond the linear parts; return the force along the model.

    The same as :func:`sim.model.forces.law_forces`.

    Parameters
    ----------
    table, hull
        See :class:`sim.model.law_table.LawTable`.
    at, line
        The row that holds the model at the struts: h, h', h'' and the load of the linear parts, two
        values each.
    force, into
        Where the forces go, to the first two columns of row ``into``.
    """
    moves = motion_at(hull, at, line, speed_m_s)
    across = 0.0
    for i in range(table.shape[0]):
        a0, a1, through = table[i, 5], table[i, 6], table[i, 9] > 0.0
        x = at[line, 0] * a0 + at[line, 1] * a1
        v = moves.v if through else at[line, 2] * a0 + at[line, 3] * a1
        a = moves.v_rate if through else at[line, 4] * a0 + at[line, 5] * a1
        load = at[line, 6] * table[i, 7] + at[line, 7] * table[i, 8]
        value = law_value(table, i, LawInput(x, v, a, load, time_s, step_s, speed_m_s))
        if through:
            across += value
        else:
            force[into, 0] += value * a0
            force[into, 1] += value * a1
    aft, fore, along = hull_readings(hull, moves, across)
    aft, fore = aft - hull[AT_REST, 0], fore - hull[AT_REST, 1]
    for j in range(6):
        aft -= hull[LINEAR, j] * at[line, j]
        fore -= hull[LINEAR + 1, j] * at[line, j]
    force[into, 0] += aft
    force[into, 1] += fore
    return along - float(hull[AT_REST, 2])
