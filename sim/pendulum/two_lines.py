"""A rigid body on two lines, for the compiled loop, and the sums of small vectors that it takes.

Import it inside the function that needs it: it loads numba where that is installed.
"""

import numpy as np

from hardware.description.arrays import FloatArray
from sim.solve.array_loops import copy, inner
from sim.solve.compilation import available, compile_loop


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
def attitude_rates(
    d: float, z: float, roll: float, q: FloatArray, v: FloatArray
) -> tuple[float, float]:
    """Return the rates of depth and roll, from the derivative of both constraints."""
    sp, cp, sr, cr = np.sin(q[2]), np.cos(q[2]), np.sin(roll), np.cos(roll)
    a11, a12 = z, d * d * cp * sr
    b1 = -(q[0] * v[0] + q[1] * v[1] + d * d * sp * cr * v[2])
    a21, a22 = sr, z * cr + (q[0] * sp - q[1] * cp) * sr
    b2 = v[0] * sp * cr + v[1] * (1.0 - cp * cr) + (q[0] * cp + q[1] * sp) * cr * v[2]
    det = a11 * a22 - a12 * a21
    return (b1 * a22 - a12 * b2) / det, (a11 * b2 - a21 * b1) / det


@compile_loop
def solve_two(a: float, b: float, c: float, right: FloatArray) -> tuple[float, float]:
    """Return the solution of ``a x + b y = right[0]``, ``b x + c y = right[1]``."""
    det = a * c - b * b
    return (right[0] * c - b * right[1]) / det, (a * right[1] - b * right[0]) / det


@compile_loop
def tensor(
    moments: tuple[float, float, float, float],
    axes: tuple[FloatArray, FloatArray, FloatArray],
    along: FloatArray,
) -> FloatArray:
    """Return a symmetric tensor of the body's plane of symmetry times a vector.

    ``moments`` are xx, yy, zz and xz in the body's ``axes``: forward, along the beam, down.
    """
    xx, yy, zz, xz = moments
    ahead, beam, down = axes
    x, z = inner(ahead, along), inner(down, along)
    flat = combine(xx * x + xz * z, ahead, xz * x + zz * z, down)
    return combine(1.0, flat, yy * inner(beam, along), beam)


@compile_loop
def inverse_moments(
    xx: float, yy: float, zz: float, xz: float
) -> tuple[float, float, float, float]:
    """Return the moments of the inverse tensor, in the same order."""
    square = xx * zz - xz * xz
    return zz / square, 1.0 / yy, xx / square, -xz / square


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
    z_rate, roll_rate = attitude_rates(d, z, roll, q, v)
    # unit vectors: vertical, roll axis, beam, and the body's own axes
    ez, e1 = vector(0.0, 0.0, 1.0), vector(cp, sp, 0.0)
    beam, e3 = vector(-sp * cr, cp * cr, sr), vector(sp * sr, -cp * sr, cr)
    ct, st = np.cos(q[3]), np.sin(q[3])
    axes = (combine(ct, e1, -st, e3), beam, combine(st, e1, ct, e3))
    rolled = combine(v[2], ez, roll_rate, e1)
    spin = combine(1.0, rolled, v[3], beam)
    eases = inverse_moments(p[6], p[7], p[8], p[9])
    # loads: a force at the beam's middle, a couple about it that works on yaw and pitch only
    middle = combine(-depth, axes[2], 0.0, ez)
    share = 1.0 - sr * sr
    turn, tip = (load[2] - sr * load[3]) / share, (load[3] - sr * load[2]) / share
    couple = combine(turn, ez, tip, beam)
    c0 = vector(load[0] / mass, load[1] / mass, p[5] / mass)
    momentum = tensor((p[6], p[7], p[8], p[9]), axes, spin)
    pushed = combine(1.0, couple, 1.0, cross(middle, vector(load[0], load[1], 0.0)))
    w0 = tensor(eases, axes, combine(1.0, pushed, -1.0, cross(spin, momentum)))
    # tensions per length of both lines, from their lengths that do not change
    right, line, lever, eased = np.empty(2), np.empty((2, 3)), np.empty((2, 3)), np.empty((2, 3))
    start = vector(v[0], v[1], z_rate)
    for i in range(2):
        side = d if i == 0 else -d
        arm = combine(side, beam, 1.0, middle)
        copy(combine(1.0, vector(q[0], q[1] - side, z), side, beam), line[i])
        copy(cross(arm, line[i]), lever[i])
        copy(tensor(eases, axes, lever[i]), eased[i])
        speed = combine(1.0, start, side, cross(spin, beam))
        swung = combine(1.0, c0, 1.0, cross(spin, cross(spin, arm)))
        right[i] = inner(line[i], swung) + inner(w0, lever[i]) + inner(speed, speed)
    m00 = inner(line[0], line[0]) / mass + inner(lever[0], eased[0])
    m01 = inner(line[0], line[1]) / mass + inner(lever[0], eased[1])
    m11 = inner(line[1], line[1]) / mass + inner(lever[1], eased[1])
    pull0, pull1 = solve_two(m00, m01, m11, right)
    pulled = combine(pull0, line[0], pull1, line[1])
    centre = combine(1.0, c0, -1.0 / mass, pulled)
    turning = combine(1.0, w0, -1.0, combine(pull0, eased[0], pull1, eased[1]))
    swung = combine(1.0, cross(turning, middle), 1.0, cross(spin, cross(spin, middle)))
    at_beam = combine(1.0, centre, 1.0, swung)
    free = combine(1.0, turning, -roll_rate * v[2], cross(ez, e1))
    free = combine(1.0, free, -v[3], cross(rolled, beam))
    up, along = free[2], inner(free, beam)
    accelerations = np.empty(4)
    accelerations[0], accelerations[1] = at_beam[0], at_beam[1]
    accelerations[2], accelerations[3] = (up - sr * along) / share, (along - sr * up) / share
    return accelerations


def product(matrix: FloatArray, vector: FloatArray) -> FloatArray:
    """Return a small matrix times a vector."""
    out = np.zeros(matrix.shape[0])
    for i in range(matrix.shape[0]):
        for j in range(vector.size):
            out[i] += matrix[i, j] * vector[j]
    return out


def total(a: float, one: FloatArray, b: float, other: FloatArray) -> FloatArray:
    """Return ``a one + b other``."""
    out = np.empty(one.size)
    for i in range(one.size):
        out[i] = a * one[i] + b * other[i]
    return out


def _by_arrays(a: float, one: FloatArray, b: float, other: FloatArray) -> FloatArray:
    return a * one + b * other


times = compile_loop(product) if available() else np.dot
combine = compile_loop(total) if available() else _by_arrays


@compile_loop
def vector(x: float, y: float, z: float) -> FloatArray:
    """Return the vector of three components."""
    out = np.empty(3)
    out[0], out[1], out[2] = x, y, z
    return out


@compile_loop
def cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return a x b."""
    return vector(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
