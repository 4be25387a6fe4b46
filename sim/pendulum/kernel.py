"""The inner loop of a freely swinging body, written so that numba can compile it.

Import it inside the function that needs it: it loads numba where that is installed. State ``x`` is
``(q_1 .. q_n, v_1 .. v_n)``. The linear part and dry friction, constant between two reversals, are
advanced by their exact flow; what is left of the acceleration goes through the classical
Runge-Kutta method in the frame that moves with that flow (Lawson's method, fourth order). A
reversal is found by halving the step until it is ``2^-LEVELS`` of it.

``model`` is ``(kind, p, minv, K, loads, nonlinear, rubbing)``; ``tables`` is
``(index, A, B, E, G)`` with a set of matrices for each set of coordinates that friction holds:
:mod:`sim.pendulum.propagators`.
"""

from typing import Any

import numpy as np

from hardware.description.arrays import FloatArray, IntArray
from sim.pendulum.two_lines import combine, suspended, times
from sim.solve.array_loops import copy, solve
from sim.solve.compilation import compile_loop

PENDULUM, SUSPENSION = 1, 2
COULOMB = 5  # column of ``loads``


@compile_loop
def resist(q: FloatArray, v: FloatArray, applied: FloatArray, loads: FloatArray) -> FloatArray:
    """Return the applied load less everything that depends on one coordinate alone.

    Columns of ``loads``: linear, quadratic, cubic, power and its exponent, Coulomb (not used here),
    then the restoring terms of ``|q| q``, ``q^3`` and ``q^5``.
    """
    force = np.empty(q.size)
    for i in range(q.size):
        speed, turn = abs(v[i]), abs(q[i])
        rub = loads[i, 0] + speed * (loads[i, 1] + speed * loads[i, 2])
        stiff = turn * (loads[i, 6] + turn * (loads[i, 7] + turn * turn * loads[i, 8]))
        force[i] = applied[i] - rub * v[i] - stiff * q[i]
        if loads[i, 3] > 0.0:
            force[i] -= loads[i, 3] * speed ** loads[i, 4] * np.sign(v[i])
    return force


@compile_loop
def accelerate(model: Any, t: float, q: FloatArray, v: FloatArray, load: FloatArray) -> FloatArray:
    """Return the accelerations under an applied load, all forces of the body's own included."""
    kind, p, minv, K, loads, _, _ = model
    force = resist(q, v, load, loads)
    if kind == SUSPENSION:
        return suspended(p, t, q, v, force)
    if kind == PENDULUM:
        force[0] += p[0] * np.cos(q[0]) - K[0, 0] * np.sin(q[0])
    else:
        force[0] += p[0]
        if p[1] > 0.0:  # a periodic force: its frequency, then cosine and sine of four orders
            for n in range(1, 5):
                force[0] += p[2 * n] * np.cos(n * p[1] * t) + p[2 * n + 1] * np.sin(n * p[1] * t)
        force = combine(1.0, force, -1.0, times(K, q))
    return times(minv, force)


@compile_loop
def rubbing(sign: FloatArray, loads: FloatArray) -> FloatArray:
    """Return the loads of dry friction where coordinates slide."""
    load = np.empty(sign.size)
    for i in range(sign.size):
        load[i] = -sign[i] * loads[i, COULOMB]
    return load


@compile_loop
def held_coordinates(sign: FloatArray, loads: FloatArray) -> IntArray:
    """Return the numbers of the coordinates that dry friction holds at rest."""
    stuck, count = np.empty(sign.size, dtype=np.int64), 0
    for i in range(sign.size):
        if loads[i, COULOMB] > 0.0 and sign[i] == 0.0:
            stuck[count] = i
            count += 1
    return stuck[:count]


@compile_loop
def motion(model: Any, t: float, x: FloatArray, sign: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return accelerations, and what friction has to hold where a coordinate is stuck (sign 0)."""
    n = sign.size
    q, v = x[:n], x[n:]
    load, held = rubbing(sign, model[4]), np.zeros(n)
    a = accelerate(model, t, q, v, load)
    if not model[6]:
        return a, held
    stuck = held_coordinates(sign, model[4])
    square, right = np.empty((stuck.size, stuck.size)), np.empty(stuck.size)
    columns = np.empty((stuck.size, n))
    for j in range(stuck.size):
        load[stuck[j]] += 1.0
        copy(combine(1.0, accelerate(model, t, q, v, load), -1.0, a), columns[j])
        load[stuck[j]] -= 1.0
        right[j] = a[stuck[j]]
        for i in range(stuck.size):
            square[i, j] = columns[j, stuck[i]]
    needed = solve(square, right)
    for j in range(stuck.size):
        held[stuck[j]] = needed[j]
        a = combine(1.0, a, -needed[j], columns[j])
    for j in range(stuck.size):
        a[stuck[j]] = 0.0
    return a, held


@compile_loop
def pattern(sign: FloatArray, loads: FloatArray) -> int:
    """Number the set of coordinates that friction holds: bit i for coordinate i."""
    number = 0
    for i in held_coordinates(sign, loads):
        number += 1 << i
    return number


@compile_loop
def remainder(
    model: Any, A: FloatArray, B: FloatArray, t: float, x: FloatArray, sign: FloatArray
) -> FloatArray:
    """Return the rate of the state less its linear part, shape ``(2 n,)``."""
    n = sign.size
    rate = np.zeros(2 * n)
    a, _ = motion(model, t, x, sign)
    flow = combine(1.0, times(A[n:], x), 1.0, times(B[n:], rubbing(sign, model[4])))
    copy(combine(1.0, a, -1.0, flow), rate[n:])
    return rate


@compile_loop
def advance(
    model: Any, tables: Any, t: float, step: float, level: int, x: FloatArray, sign: FloatArray
) -> FloatArray:
    """Return the state after ``step / 2^level``, no reversal within it."""
    index, A, B, E, G = tables
    k = index[pattern(sign, model[4])] if model[6] else 0
    rub = rubbing(sign, model[4])
    if not model[5]:
        return combine(1.0, times(E[k, level], x), 1.0, times(G[k, level], rub))
    h = step / 2.0**level
    half, push = E[k, level + 1], times(G[k, level + 1], rub)
    r1 = remainder(model, A[k], B[k], t, x, sign)
    middle = combine(1.0, times(half, x), 1.0, push)
    r1_half = times(half, r1)
    at = combine(1.0, middle, h / 2.0, r1_half)
    r2 = remainder(model, A[k], B[k], t + h / 2.0, at, sign)
    at = combine(1.0, middle, h / 2.0, r2)
    r3 = remainder(model, A[k], B[k], t + h / 2.0, at, sign)
    late = combine(1.0, times(half, combine(1.0, middle, h, r3)), 1.0, push)
    r4 = remainder(model, A[k], B[k], t + h, late, sign)
    rates = combine(1.0, r1_half, 2.0, combine(1.0, r2, 1.0, r3))
    moved = combine(1.0, times(half, combine(1.0, middle, h / 6.0, rates)), 1.0, push)
    return combine(1.0, moved, h / 6.0, r4)


@compile_loop
def settle(model: Any, t: float, x: FloatArray, sign: FloatArray) -> None:
    """Set each friction's sign: along the velocity, or held at rest where it can hold."""
    n = sign.size
    loads = model[4]
    for i in range(n):
        sign[i] = np.sign(x[n + i]) if loads[i, COULOMB] > 0.0 else 0.0
    for _ in range(n):
        held = motion(model, t, x, sign)[1]
        for i in range(n):
            if abs(held[i]) > loads[i, COULOMB]:
                sign[i] = np.sign(held[i])


@compile_loop
def has_turned(model: Any, t: float, x: FloatArray, sign: FloatArray) -> bool:
    """Tell whether a sliding coordinate has reversed, or a held one broken loose."""
    n = sign.size
    for i in range(n):
        if x[n + i] * sign[i] < 0.0:
            return True
    if pattern(sign, model[4]) > 0:
        held = motion(model, t, x, sign)[1]
        for i in range(n):
            if abs(held[i]) > model[4][i, COULOMB]:
                return True
    return False


@compile_loop
def interval(
    model: Any, tables: Any, t: float, step: float, x: FloatArray, sign: FloatArray
) -> FloatArray:
    """Return the state after ``step``; ``sign`` is brought up to date in place."""
    n = sign.size
    deepest = tables[3].shape[1] - 2
    parts = 1 << deepest
    steps, level = 0, 0
    while steps < parts:
        while (parts >> level) > parts - steps:
            level += 1
        now = t + step * steps / parts
        after = advance(model, tables, now, step, level, x, sign)
        new = has_turned(model, now + step / 2.0**level, after, sign)
        if new and level < deepest:
            level += 1
            continue
        steps += parts >> level
        x = after
        if new:
            for i in range(n):
                if x[n + i] * sign[i] < 0.0:
                    x[n + i] = 0.0
            settle(model, t + step * steps / parts, x, sign)
            level = 0
    return x


@compile_loop
def place(inputs: FloatArray, k: int, x: FloatArray) -> None:
    """Fill the state with what is given for a sample: at rest while held, else as released."""
    n = x.size // 2
    for i in range(n):
        x[i], x[n + i] = inputs[1 + i, k], 0.0 if inputs[0, k] > 0.0 else inputs[1 + n + i, k]


@compile_loop
def run(
    model: Any,
    tables: Any,
    clock: tuple[int, int, float, int],
    inputs: FloatArray,
    x: FloatArray,
    sign: FloatArray,
    free: bool,
    out: FloatArray,
) -> tuple[FloatArray, bool]:
    """Fill ``out``, shape ``(3 n, count)``, with displacements, velocities and accelerations.

    ``clock``: first sample, samples, sample interval, steps a sample. ``inputs``: rows of the hold
    (1 held, 0 free), then held displacement and released velocity of each coordinate.
    """
    first, count, interval_s, steps = clock
    n = sign.size
    step = interval_s / steps
    for k in range(count):
        t = (first + k) * interval_s
        held = inputs[0, k] > 0.0
        if held or not free:
            place(inputs, k, x)
        if not held and not free:
            settle(model, t, x, sign)
        free = not held
        rates = motion(model, t, x, sign)[0] if free else np.zeros(n)
        for i in range(n):
            out[i, k], out[n + i, k], out[2 * n + i, k] = x[i], x[n + i], rates[i]
        if free:
            for j in range(steps):
                x = interval(model, tables, t + j * step, step, x, sign)
    return x, free
