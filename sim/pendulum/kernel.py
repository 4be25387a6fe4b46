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

from hardware.description.arrays import FloatArray
from sim.pendulum.vectors import cross, times
from sim.solve.compilation import compile_loop

LINEAR, PENDULUM, SUSPENSION = 0, 1, 2
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
def attitude(p: FloatArray, length: float, q: FloatArray) -> tuple[float, float]:
    """Return depth of the beam and roll angle that lines of this length allow.

    Sum and difference of ``|P - A|^2 = l^2`` for both lines; the roll is second order, so the
    iteration contracts by the fourth order of the displacements.
    """
    d, x, y = p[2], q[0], q[1]
    sp, cp = np.sin(q[2]), np.cos(q[2])
    roll, z = 0.0, length
    for _ in range(30):
        z = np.sqrt(length**2 - x * x - y * y - 2.0 * d * d * (1.0 - cp * np.cos(roll)))
        b = x * sp - y * cp
        new = np.arctan2(b, z) + np.arcsin(y / np.hypot(z, b))
        if abs(new - roll) < 1e-16:
            break
        roll = new
    return z, roll


@compile_loop
def suspended(
    p: FloatArray, t: float, q: FloatArray, v: FloatArray, load: FloatArray
) -> FloatArray:
    """Return the accelerations of a rigid body on two lines: Newton and Euler, two tensions.

    ``p``: line length, its creep per decade of minutes, half spacing d, depth of the centre of
    gravity, moving mass, weight, then I_xx, I_yy, I_zz, I_xz of the body about that centre.
    Coordinates: surge, sway of the beam's middle, yaw, pitch about the beam; ``load`` belongs to
    these. Lines from (0, +-d, 0) to the beam's ends, x forward, y starboard, z down.
    """
    length = p[0] * (1.0 + p[1] * np.log10(1.0 + max(t, 0.0) / 60.0))
    d, depth, mass = p[2], p[3], p[4]
    z, roll = attitude(p, length, q)
    sp, cp, sr, cr = np.sin(q[2]), np.cos(q[2]), np.sin(roll), np.cos(roll)
    # rates of depth and roll, from the derivative of both constraints
    a11, a12 = z, d * d * cp * sr
    b1 = -(q[0] * v[0] + q[1] * v[1] + d * d * sp * cr * v[2])
    a21, a22 = sr, z * cr + (q[0] * sp - q[1] * cp) * sr
    b2 = v[0] * sp * cr + v[1] * (1.0 - cp * cr) + (q[0] * cp + q[1] * sp) * cr * v[2]
    det = a11 * a22 - a12 * a21
    z_rate, roll_rate = (b1 * a22 - a12 * b2) / det, (a11 * b2 - a21 * b1) / det
    # unit vectors: vertical, roll axis, beam, and rows of the body's own axes
    ez, e1 = np.array((0.0, 0.0, 1.0)), np.array((cp, sp, 0.0))
    beam, e3 = np.array((-sp * cr, cp * cr, sr)), np.array((sp * sr, -cp * sr, cr))
    axes = np.empty((3, 3))
    axes[0] = np.cos(q[3]) * e1 - np.sin(q[3]) * e3
    axes[1] = beam
    axes[2] = np.sin(q[3]) * e1 + np.cos(q[3]) * e3
    spin = v[2] * ez + roll_rate * e1 + v[3] * beam
    body = np.array(((p[6], 0.0, p[9]), (0.0, p[7], 0.0), (p[9], 0.0, p[8])))
    inner = p[6] * p[8] - p[9] * p[9]
    inverse = np.array(((p[8], 0.0, -p[9]), (0.0, inner / p[7], 0.0), (-p[9], 0.0, p[6]))) / inner
    across = np.ascontiguousarray(axes.T)
    momentum = times(across, times(body, times(axes, spin)))
    ease = np.dot(across, np.dot(inverse, axes))
    # loads: a force at the beam's middle, a couple about it that works on yaw and pitch only
    middle = -depth * axes[2]
    force = np.array((load[0], load[1], 0.0))
    share = 1.0 - sr * sr
    couple = ((load[2] - sr * load[3]) * ez + (load[3] - sr * load[2]) * beam) / share
    c0 = (force + p[5] * ez) / mass
    w0 = times(ease, couple + cross(middle, force) - cross(spin, momentum))
    # tensions per length of both lines, from their lengths that do not change
    right, line, lever, eased = np.empty(2), np.empty((2, 3)), np.empty((2, 3)), np.empty((2, 3))
    start = np.array((v[0], v[1], z_rate))
    for i in range(2):
        side = d if i == 0 else -d
        line[i] = np.array((q[0], q[1] - side, z)) + side * beam
        arm = side * beam + middle
        lever[i] = cross(arm, line[i])
        eased[i] = times(ease, lever[i])
        speed = start + cross(spin, side * beam)
        swung = c0 + cross(spin, cross(spin, arm))
        right[i] = np.dot(line[i], swung) + np.dot(w0, lever[i]) + np.dot(speed, speed)
    m00 = np.dot(line[0], line[0]) / mass + np.dot(lever[0], eased[0])
    m01 = np.dot(line[0], line[1]) / mass + np.dot(lever[0], eased[1])
    m11 = np.dot(line[1], line[1]) / mass + np.dot(lever[1], eased[1])
    det = m00 * m11 - m01 * m01
    pull0, pull1 = (right[0] * m11 - m01 * right[1]) / det, (m00 * right[1] - m01 * right[0]) / det
    centre = c0 - (pull0 * line[0] + pull1 * line[1]) / mass
    turning = w0 - pull0 * eased[0] - pull1 * eased[1]
    at_beam = centre + cross(turning, middle) + cross(spin, cross(spin, middle))
    rolled = v[2] * ez + roll_rate * e1
    free = turning - roll_rate * v[2] * cross(ez, e1) - v[3] * cross(rolled, beam)
    up, along = free[2], np.dot(free, beam)
    return np.array((at_beam[0], at_beam[1], (up - sr * along) / share, (along - sr * up) / share))


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
        force -= times(K, q)
    return times(minv, force)


@compile_loop
def motion(model: Any, t: float, x: FloatArray, sign: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return accelerations, and what friction has to hold where a coordinate is stuck (sign 0)."""
    n = sign.size
    q, v = x[:n], x[n:]
    coulomb = model[4][:, COULOMB]
    load, held = -sign * coulomb, np.zeros(n)
    a = accelerate(model, t, q, v, load)
    if not model[6]:
        return a, held
    stuck = np.nonzero((coulomb > 0.0) & (sign == 0.0))[0]
    if stuck.size > 0:
        columns = np.empty((stuck.size, n))
        for j in range(stuck.size):
            load[stuck[j]] += 1.0
            columns[j] = accelerate(model, t, q, v, load) - a
            load[stuck[j]] -= 1.0
        square = np.ascontiguousarray(columns[:, stuck].T)
        held[stuck] = np.linalg.solve(square, a[stuck])
        a -= np.dot(held[stuck], columns)
        a[stuck] = 0.0
    return a, held


@compile_loop
def pattern(sign: FloatArray, loads: FloatArray) -> int:
    """Number the set of coordinates that friction holds: bit i for coordinate i."""
    stuck = (loads[:, COULOMB] > 0.0) & (sign == 0.0)
    return int(np.sum(stuck * 2 ** np.arange(sign.size)))


@compile_loop
def remainder(
    model: Any, A: FloatArray, B: FloatArray, t: float, x: FloatArray, sign: FloatArray
) -> FloatArray:
    """Return the rate of the state less its linear part, shape ``(2 n,)``."""
    n = sign.size
    rate = np.zeros(2 * n)
    a, _ = motion(model, t, x, sign)
    rub = -sign * model[4][:, COULOMB]
    rate[n:] = a - times(A[n:], x) - times(B[n:], rub)
    return rate


@compile_loop
def advance(
    model: Any, tables: Any, t: float, step: float, level: int, x: FloatArray, sign: FloatArray
) -> FloatArray:
    """Return the state after ``step / 2^level``, no reversal within it."""
    index, A, B, E, G = tables
    k = index[pattern(sign, model[4])] if model[6] else 0
    rub = -sign * model[4][:, COULOMB]
    if not model[5]:
        return times(E[k, level], x) + times(G[k, level], rub)
    h = step / 2.0**level
    half, push = E[k, level + 1], times(G[k, level + 1], rub)
    r1 = remainder(model, A[k], B[k], t, x, sign)
    middle = times(half, x) + push
    r1_half = times(half, r1)
    r2 = remainder(model, A[k], B[k], t + h / 2.0, middle + h / 2.0 * r1_half, sign)
    r3 = remainder(model, A[k], B[k], t + h / 2.0, middle + h / 2.0 * r2, sign)
    late = times(half, middle + h * r3) + push
    r4 = remainder(model, A[k], B[k], t + h, late, sign)
    moved = middle + h / 6.0 * (r1_half + 2.0 * (r2 + r3))
    return times(half, moved) + push + h / 6.0 * r4


@compile_loop
def settle(model: Any, t: float, x: FloatArray, sign: FloatArray) -> None:
    """Set each friction's sign: along the velocity, or held at rest where it can hold."""
    n = sign.size
    coulomb = model[4][:, COULOMB]
    sign[:] = np.where(coulomb > 0.0, np.sign(x[n:]), 0.0)
    for _ in range(n):
        held = motion(model, t, x, sign)[1]
        sign[:] = np.where(np.abs(held) > coulomb, np.sign(held), sign)


@compile_loop
def turned(model: Any, t: float, x: FloatArray, sign: FloatArray) -> bool:
    """Tell whether a sliding coordinate has reversed, or a held one broken loose."""
    if np.any(x[sign.size :] * sign < 0.0):
        return True
    if pattern(sign, model[4]) > 0:
        return bool(np.any(np.abs(motion(model, t, x, sign)[1]) > model[4][:, COULOMB]))
    return False


@compile_loop
def interval(
    model: Any, tables: Any, t: float, step: float, x: FloatArray, sign: FloatArray
) -> FloatArray:
    """Return the state after ``step``; ``sign`` is brought up to date in place."""
    n = sign.size
    if not model[6]:
        return advance(model, tables, t, step, 0, x, sign)
    deepest = tables[3].shape[1] - 2
    whole = 1 << deepest
    steps, level = 0, 0
    while steps < whole:
        while (whole >> level) > whole - steps:
            level += 1
        now = t + step * steps / whole
        after = advance(model, tables, now, step, level, x, sign)
        new = turned(model, now + step / 2.0**level, after, sign)
        if new and level < deepest:
            level += 1
            continue
        steps += whole >> level
        x = after
        if new:
            x[n:] = np.where(x[n:] * sign < 0.0, 0.0, x[n:])
            settle(model, t + step * steps / whole, x, sign)
            level = 0
    return x


@compile_loop
def run(
    model: Any,
    tables: Any,
    clock: tuple[int, int, float, int],
    given: FloatArray,
    x: FloatArray,
    sign: FloatArray,
    free: bool,
    out: FloatArray,
) -> tuple[FloatArray, bool]:
    """Fill ``out``, shape ``(3 n, count)``, with displacements, velocities and accelerations.

    ``clock``: first sample, samples, sample interval, steps a sample. ``given``: rows of the hold
    (1 held, 0 free), then held displacement and released velocity of each coordinate.
    """
    first, count, interval_s, steps = clock
    n = sign.size
    step = interval_s / steps
    for k in range(count):
        t = (first + k) * interval_s
        if given[0, k] > 0.0:
            x[:n], x[n:] = given[1 : 1 + n, k], 0.0
            free = False
        elif not free:
            x[:], free = given[1:, k], True
            settle(model, t, x, sign)
        out[: 2 * n, k] = x
        out[2 * n :, k] = 0.0
        if free:
            out[2 * n :, k] = motion(model, t, x, sign)[0]
            for j in range(steps):
                x = interval(model, tables, t + j * step, step, x, sign)
    return x, free
