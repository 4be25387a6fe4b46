"""The force laws at one instant: what the compiled loops call; the same as :mod:`sim.laws`.

Loaded when the first such loop runs, because numba is. Without numba the functions are Python.
"""

import math

from sim.compiled import compile_loop
from sim.laws import CREEP_M_S
from sim.signals import FloatArray

_FIRST_WITH_REFERENCE = 4
_FIRST_THAT_JUMPS = 7
_ARC_SINE = 11
_ROOT_PI = math.sqrt(math.pi)


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
def _arc_sine(p: FloatArray, i: int, x: float, v: float, a: float, load: float) -> float:
    """Struts on parallel lines."""
    cosine = math.sqrt(1.0 - x**2)
    growing = a / cosine + x * v**2 / cosine**3
    beyond = p[i, 1] * (growing - a) + p[i, 2] * (v / cosine - v) + p[i, 3] * (math.asin(x) - x)
    return float((load + beyond) / cosine - load)


@compile_loop
def law_value(
    p: FloatArray,
    i: int,
    at: tuple[float, float, float, float],
    half: float,
    time_s: float,
    speed_m_s: float,
) -> float:
    """Return the force that one law asks for at its point.

    Parameters
    ----------
    p, i
        The laws, see :class:`sim.law_table.LawTable`, and the row of this one.
    at
        Position, velocity, acceleration and load at the law's point.
    half
        See :attr:`sim.force_law.Motion.half_change`.
    """
    kind = int(p[i, 0])
    x, v, a, load = at
    if kind < _FIRST_WITH_REFERENCE:
        return _polynomial(kind, p, i, x, v)
    if kind < _FIRST_THAT_JUMPS:
        return _curved(kind, p, i, x, time_s, speed_m_s)
    if kind == _ARC_SINE:
        return _arc_sine(p, i, x, v, a, load)
    return _jumping(kind, p, i, x, v, half, load)


@compile_loop
def cross_flow_load(k: FloatArray, row: int, v: float, r: float) -> float:
    """Return force (row 0) or moment (row 1) of both velocities through the water, coupled."""
    cubic = k[row, 0] * v**3 + k[row, 1] * v * v * r + k[row, 2] * v * r * r + k[row, 3] * r**3
    quadratic = k[row + 2, 0] * v * abs(v) + k[row + 2, 1] * v * abs(r)
    return float(cubic + quadratic + k[row + 2, 2] * r * abs(v) + k[row + 2, 3] * r * abs(r))


@compile_loop
def _cross_flow(k: FloatArray, at: FloatArray, line: int, force: FloatArray, into: int) -> None:
    h0, h1, v0, v1 = at[line, 0], at[line, 1], at[line, 2], at[line, 3]
    v = k[4, 0] * v0 + k[4, 1] * v1 + k[4, 2] * h0 + k[4, 3] * h1
    r = k[5, 0] * v0 + k[5, 1] * v1 + k[5, 2] * h0 + k[5, 3] * h1
    for row in range(2):
        load = cross_flow_load(k, row, v, r)
        force[into, 0] += k[4 + row, 0] * load
        force[into, 1] += k[4 + row, 1] * load


@compile_loop
def law_force(
    laws: FloatArray,
    cross_flow: FloatArray,
    at: FloatArray,
    line: int,
    time_s: float,
    step_s: float,
    speed_m_s: float,
    force: FloatArray,
    into: int,
) -> None:
    """Add the force of each strut that the laws ask for.

    Parameters
    ----------
    laws, cross_flow
        See :class:`sim.law_table.LawTable`.
    at, line
        The row that holds the model at the struts: h, h', h'' and the load of the linear parts, two
        values each.
    force, into
        Where the forces go, to the first two columns of row ``into``.
    """
    for i in range(laws.shape[0]):
        a0, a1, turn0, turn1 = laws[i, 5], laws[i, 6], laws[i, 9], laws[i, 10]
        x = at[line, 0] * a0 + at[line, 1] * a1
        v = at[line, 2] * a0 + at[line, 3] * a1 + at[line, 0] * turn0 + at[line, 1] * turn1
        a = at[line, 4] * a0 + at[line, 5] * a1 + at[line, 2] * turn0 + at[line, 3] * turn1
        load = at[line, 6] * laws[i, 7] + at[line, 7] * laws[i, 8]
        half = math.sqrt((a * (step_s / 2.0)) ** 2 + CREEP_M_S**2)
        value = law_value(laws, i, (x, v, a, load), half, time_s, speed_m_s)
        force[into, 0] += value * a0
        force[into, 1] += value * a1
    if cross_flow.shape[0]:
        _cross_flow(cross_flow, at, line, force, into)
