"""The time loop: Runge-Kutta for what moves, exact steps for what rubs, sums of what remembers."""

import math

import numpy as np

from tests.sealed.generator.attitude import follow, through
from tests.sealed.generator.compiled import compiled
from tests.sealed.generator.loads import carriage_speed, inertia
from tests.sealed.generator.mechanics import crank
from tests.sealed.generator.parameters import FloatArray, P
from tests.sealed.generator.places import H, W, Y
from tests.sealed.generator.rates import put, rates
from tests.sealed.generator.rubbing import creep, rub

STATES, HELD, WORK = max(Y) + 1, max(H) + 1, max(W) + 1
RUNAWAY = 1e9


@compiled
def start(p: FloatArray, theta: float, work: FloatArray) -> FloatArray:
    """Return the states of a rig that turns steadily at shaft angle ``theta``."""
    y = np.zeros(STATES)
    y[Y.MOTOR] = y[Y.CRANK] = theta
    y[Y.MOTOR_SPEED] = y[Y.CRANK_SPEED] = p[P.OMEGA] * (1.0 + p[P.SPEED_ERROR])
    for strut in range(2):
        crank(p, strut, theta, work)
    follow(p, y, work)
    y[Y.WAKE] = 0.5
    return y


@compiled
def step(
    p: FloatArray,
    t: float,
    dt: float,
    y: FloatArray,
    held: FloatArray,
    work: FloatArray,
    k: FloatArray,
) -> None:
    """Advance ``y`` by one classical Runge-Kutta step; ``k`` is scratch, shape ``(5, states)``."""
    rates(p, t, y, held, work, k[0])
    for i in range(len(y)):
        k[4, i] = y[i] + 0.5 * dt * k[0, i]
    rates(p, t + 0.5 * dt, k[4], held, work, k[1])
    for i in range(len(y)):
        k[4, i] = y[i] + 0.5 * dt * k[1, i]
    rates(p, t + 0.5 * dt, k[4], held, work, k[2])
    for i in range(len(y)):
        k[4, i] = y[i] + dt * k[2, i]
    rates(p, t + dt, k[4], held, work, k[3])
    for i in range(len(y)):
        y[i] += dt / 6.0 * (k[0, i] + 2.0 * (k[1, i] + k[2, i]) + k[3, i])


@compiled
def remembered(kernel: FloatArray, past: FloatArray, n: int, interval: float) -> float:
    """Return the convolution of a retardation function with the velocities up to sample ``n``."""
    taps = min(len(kernel), n + 1)
    total = 0.5 * kernel[0] * past[n]
    for i in range(1, taps):
        total += kernel[i] * past[n - i]
    return float(total * interval)


@compiled
def remember(
    p: FloatArray,
    t: float,
    n: int,
    y: FloatArray,
    kernels: FloatArray,
    past: FloatArray,
    interval: float,
    work: FloatArray,
    out: FloatArray,
) -> None:
    """Keep the velocity through the water; write both memories' loads now and one sample ago."""
    put(p, y, work)
    through(p, carriage_speed(p, t), y, work)
    past[0, n] = work[W.THROUGH]
    past[1, n] = y[Y.V1]
    for row in range(2):
        out[row, 1] = out[row, 0]
        out[row, 0] = remembered(kernels[row], past[row], n, interval)


@compiled
def keep(
    p: FloatArray,
    t: float,
    y: FloatArray,
    held: FloatArray,
    work: FloatArray,
    scratch: FloatArray,
    out: FloatArray,
) -> None:
    """Write one sample: angle, struts' displacements and forces, speed, all as they are."""
    rates(p, t, y, held, work, scratch)
    out[0] = y[Y.CRANK]
    for strut in range(2):
        crank(p, strut, y[Y.CRANK], work)
        out[1 + strut] = work[W.WAY_AFT + 3 * strut] - held[H.PLAY_AFT + strut]
        out[3 + strut] = held[H.FORCE_AFT + strut]
    out[5] = carriage_speed(p, t)


@compiled
def escaped(y: FloatArray) -> bool:
    """Tell whether a state is beyond what any rig could do: an effect at that size has no motion.

    SI units throughout: a shaft turns at some 10 rad/s, a model moves by less than 1 m.
    """
    return not np.abs(y).sum() < RUNAWAY  # nor is what is no number


@compiled
def integrate(
    p: FloatArray, kernels: FloatArray, interval: float, substeps: int, before: int, samples: int
) -> tuple[FloatArray, FloatArray]:
    """Integrate ``before`` samples ahead of time 0 and ``samples`` from there on.

    Parameters
    ----------
    kernels
        Retardation functions of translation and rotation at the sample interval, ``(2, taps)``.

    Returns
    -------
    tuple of FloatArray
        Samples, shape ``(6, before + samples)``: shaft angle, displacements aft and
        fore, forces aft and fore, carriage speed, not a number from where the motion runs away; and
        the times of the photocell's mark from 0 on.
    """
    dt = interval / substeps
    work, held, k = np.zeros(WORK), np.zeros(HELD), np.empty((5, STATES))
    inertia(p, work)
    y = start(p, -math.pi, work)
    past, memory = np.zeros((2, before + samples)), np.zeros((2, 2))
    out, edges, count = np.empty((before + samples, 6)), np.empty(samples), 0
    for n in range(before + samples):
        if escaped(y):
            out[n:] = np.nan
            break
        t = (n - before) * interval
        if len(kernels[0]) > 1:
            remember(p, t, n, y, kernels, past, interval, work, memory)
            held[H.MEMORY_0], held[H.MEMORY_1] = memory[0, 0], memory[1, 0]
        keep(p, t, y, held, work, k[0], out[n])
        for i in range(substeps):
            for row in range(2):
                slope = memory[row, 0] - memory[row, 1]
                held[H.MEMORY_0 + row] = memory[row, 0] + slope * (i + 0.5) / substeps
            old = (y[Y.CRANK] - p[P.MARK]) / (2.0 * math.pi)
            step(p, t + i * dt, dt, y, held, work, k)
            put(p, y, work)
            rub(p, y, held, dt, work)
            creep(p, y, held, dt)
            new = (y[Y.CRANK] - p[P.MARK]) / (2.0 * math.pi)
            if math.floor(new) > math.floor(old) and n >= before:
                edges[count] = t + dt * (i + (math.floor(new) - old) / (new - old))
                count += 1
    return out.T.copy(), edges[:count].copy()
