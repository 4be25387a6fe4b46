"""Force laws and exact geometry at one instant: what the compiled loops call.

The same as :mod:`sim.model.laws` and :mod:`sim.mechanism.geometry`. Loaded when the first such loop
runs, because numba is. Without numba the functions are Python.
"""

import math

from hardware.description.arrays import FloatArray
from sim.mechanism import geometry
from sim.mechanism.geometry import AT_REST, LINEAR, BodyMotion
from sim.model.laws import CREEP_M_S
from sim.solve.compilation import compile_loop

_FIRST_WITH_REFERENCE = 4
_FIRST_THAT_JUMPS = 7
_ROOT_PI = math.sqrt(math.pi)

body_motion = compile_loop(geometry.body_motion)
body_loads = compile_loop(geometry.body_loads)
gauge_readings = compile_loop(geometry.gauge_readings)


@compile_loop
def _polynomial(kind: int, p: FloatArray, i: int, x: float, v: float) -> float:
    """Viscous, quadratic, cubic, spring."""
    if kind == 0:
        return float(p[i, 1] * v)
    if kind == 1:
        through = v + p[i, 2]
        return float(p[i, 1] * through * abs(through))
    if kind == 2:
        return float(p[i, 1] * v**3)
    return float(p[i, 4] + x * (p[i, 1] + x * (p[i, 2] + x * p[i, 3])))


@compile_loop
def _curved(kind: int, p: FloatArray, i: int, x: float, time_s: float, speed_m_s: float) -> float:
    """Proximity, exponential, tone."""
    if kind == 6:
        fade = 1.0 if math.isnan(p[i, 4]) else math.exp(-time_s / p[i, 4])
        return float(p[i, 1] * fade * math.sin(2.0 * math.pi * p[i, 2] * time_s + p[i, 3]))
    reference = p[i, 4] if kind == 4 else p[i, 3]
    dynamic = 1.0 if math.isnan(reference) else (speed_m_s / reference) ** 2
    if kind == 4:
        return float(p[i, 1] * dynamic * ((p[i, 2] / (p[i, 2] - x)) ** p[i, 3] - 1.0))
    return float(p[i, 1] * dynamic * math.expm1(p[i, 2] * x))


@compile_loop
def _jumping(
    kind: int, p: FloatArray, i: int, x: float, v: float, half: float, load: float
) -> float:
    """Coulomb, Stribeck, load friction, rubbing spring: means over the sample."""
    if kind == 8:
        velocity, width = v / p[i, 2], half / p[i, 2]
        risen = math.erf(abs(velocity + width)) - math.erf(abs(velocity - width))
        return float(p[i, 1] * (_ROOT_PI / 4.0) * risen / width)
    sign = min(max(v / half, -1.0), 1.0)
    if kind == 7:
        return float(p[i, 1] * sign + p[i, 2])
    if kind == 9:
        return float(p[i, 1] * abs(p[i, 3] * load + p[i, 2]) * sign)
    return float(p[i, 1] * abs(x) * sign)


@compile_loop
def law_value(
    p: FloatArray,
    i: int,
    at: tuple[float, float, float],
    half: float,
    time_s: float,
    speed_m_s: float,
) -> float:
    """Return the force that one law asks for at its point.

    Parameters
    ----------
    p, i
        The laws, see :class:`sim.model.law_table.LawTable`, and the row of this one.
    at
        Position, velocity and load at the law's point.
    half
        See :attr:`sim.model.force_law.LawInput.half_change`.
    """
    kind = int(p[i, 0])
    x, v, load = at
    if kind < _FIRST_WITH_REFERENCE:
        return _polynomial(kind, p, i, x, v)
    if kind < _FIRST_THAT_JUMPS:
        return _curved(kind, p, i, x, time_s, speed_m_s)
    return _jumping(kind, p, i, x, v, half, load)


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
    laws: FloatArray,
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
    laws, hull
        See :class:`sim.model.law_table.LawTable`.
    at, line
        The row that holds the model at the struts: h, h', h'' and the load of the linear parts, two
        values each.
    force, into
        Where the forces go, to the first two columns of row ``into``.
    """
    moves = motion_at(hull, at, line, speed_m_s)
    across = 0.0
    for i in range(laws.shape[0]):
        a0, a1, through = laws[i, 5], laws[i, 6], laws[i, 9] > 0.0
        x = at[line, 0] * a0 + at[line, 1] * a1
        v = moves.v if through else at[line, 2] * a0 + at[line, 3] * a1
        a = moves.v_rate if through else at[line, 4] * a0 + at[line, 5] * a1
        load = at[line, 6] * laws[i, 7] + at[line, 7] * laws[i, 8]
        half = math.sqrt((a * (step_s / 2.0)) ** 2 + CREEP_M_S**2)
        value = law_value(laws, i, (x, v, load), half, time_s, speed_m_s)
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
