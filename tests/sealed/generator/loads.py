"""What model, water and rubbing parts take from the struts, compiled.

Every function takes the parameter vector first. Loads are positive where the struts have to exert
them; translation comes first, rotation second.
"""

import math

from tests.sealed.generator.compiled import compiled
from tests.sealed.generator.parameters import FloatArray, P
from tests.sealed.generator.places import W


@compiled
def smooth_square(v: float) -> float:
    """Return v |v|, rounded within 2 mm/s (or 2 mrad/s)."""
    return v * math.sqrt(v * v + 4e-6)


@compiled
def powered(v: float, power: float) -> float:
    """Return a power of a velocity with its sign, rounded within 2 mm/s (or 2 mrad/s)."""
    return float(v * math.pow(v * v + 4e-6, 0.5 * (power - 1.0)))


@compiled
def carriage_speed(p: FloatArray, t: float) -> float:
    """Return the speed over the ground at time ``t``: mean, and a swell with its half octave."""
    swell = 0.0
    if p[P.SURGE] != 0.0:
        turn = 2.0 * math.pi * p[P.SURGE_HZ] * t + p[P.SURGE_PHASE]
        swell = math.sin(turn) + 0.15 * math.sin(1.41 * turn)
    return float(p[P.SPEED] * (1.0 + p[P.CARRIAGE_ERROR] + p[P.SURGE] * swell))


@compiled
def kelvin(p: FloatArray) -> float:
    """Return by how much the tank is warmer than at the campaign's beginning."""
    return float(p[P.KELVIN_HOUR] * p[P.HOUR])


@compiled
def inertia(p: FloatArray, work: FloatArray) -> None:
    """Write the 2 x 2 matrix of model, tare and added mass, row by row."""
    wet = p[P.WATER] * (1.0 + p[P.DENSITY_KELVIN] * kelvin(p)) * (1.0 + p[P.BLOCKAGE])
    tare = p[P.TARE_MASS] * p[P.WATER]
    cross = -p[P.AFT_SIGN] * p[P.MASS] * p[P.CG_X]
    work[W.M00] = p[P.MASS] + 2.0 * tare + wet * p[P.ADDED_00]
    work[W.M01] = cross + wet * p[P.ADDED_01]
    work[W.M10] = cross + wet * p[P.ADDED_10]
    work[W.M11] = p[P.INERTIA] + 2.0 * tare * p[P.LEVER] ** 2 + wet * p[P.ADDED_11]


@compiled
def linear_water(p: FloatArray, q0: float, q1: float, r: float, work: FloatArray) -> None:
    """Add damping, restoring and the added mass's share of the turning velocity to ``work``."""
    wet, v = 1.0 + p[P.DENSITY_KELVIN] * kelvin(p), work[W.THROUGH]
    turn = wet * (1.0 + p[P.BLOCKAGE]) * p[P.INCIDENCE] * work[W.AHEAD] * r
    thin = (1.0 + p[P.DAMPING_KELVIN] * kelvin(p)) * (1.0 + 2.0 * p[P.BLOCKAGE])
    for row in range(2):
        damping = p[P.DAMPING_00 + 2 * row] * v + p[P.DAMPING_01 + 2 * row] * r
        restoring = p[P.RESTORING_00 + 2 * row] * q0 + p[P.RESTORING_01 + 2 * row] * q1
        work[W.WATER_0 + row] += p[P.ADDED_00 + 2 * row] * turn + thin * damping + wet * restoring


@compiled
def drags(p: FloatArray, w: float, r: float, work: FloatArray) -> None:
    """Add drag with a square and with a cube of the velocities."""
    if p[P.DRAG_POWER] > 0.0:
        work[W.WATER_0] += p[P.QUADRATIC_0] * powered(w + p[P.DRIFT_SPEED], p[P.DRAG_POWER])
        work[W.WATER_1] += p[P.QUADRATIC_1] * powered(r, p[P.DRAG_POWER])
    elif p[P.QUADRATIC_0] != 0.0:
        work[W.WATER_0] += p[P.QUADRATIC_0] * smooth_square(w + p[P.DRIFT_SPEED])
        work[W.WATER_1] += p[P.QUADRATIC_1] * smooth_square(r)
    if p[P.CUBIC_POWER] > 0.0:
        work[W.WATER_0] += p[P.CUBIC_0] * powered(w, p[P.CUBIC_POWER])
        work[W.WATER_1] += p[P.CUBIC_1] * powered(r, p[P.CUBIC_POWER])
    else:
        work[W.WATER_0] += p[P.CUBIC_0] * w * w * w / (1.0 + 0.3 * w * w)
        work[W.WATER_1] += p[P.CUBIC_1] * r * r * r / (1.0 + 0.05 * r * r)


@compiled
def curved_springs(p: FloatArray, speed: float, q0: float, work: FloatArray) -> None:
    """Add flare, and what free surface, bottom and trim do with the square of the speed."""
    if p[P.FLARE_SHAPE] > 0.0:
        dipped = 0.5 * (q0 + math.sqrt(q0 * q0 + 4e-6))
        work[W.WATER_0] += (p[P.FLARE_2] + p[P.FLARE_3] * q0) * dipped * dipped
    elif p[P.FLARE_2] != 0.0 or p[P.FLARE_3] != 0.0:
        work[W.WATER_0] += p[P.FLARE_2] * (math.cosh(10.0 * q0) - 1.0) / 50.0
        work[W.WATER_0] += p[P.FLARE_3] * 0.06 * (math.sinh(10.0 * q0) / 10.0 - q0)
    near = 1.0 / (1.0 - 0.5 * p[P.SUCTION_RATE] * q0)
    gap = p[P.CLEARANCE] / (p[P.CLEARANCE] - q0)
    pulled = p[P.SUCTION] * (near * near - 1.0) + p[P.GROUND] * (gap * gap - 1.0)
    if p[P.GAP_SHAPE] > 0.0:
        pulled = p[P.SUCTION] * (near * near * near - 1.0) / 1.5
        pulled += p[P.GROUND] * (math.exp(2.0 * q0 / p[P.CLEARANCE]) - 1.0)
    sag = p[P.TRIM_LOAD] + p[P.TRIM_2] * q0 * q0
    if p[P.TRIM_1] != 0.0:
        sag += p[P.TRIM_1] * math.tanh(4.0 * q0) / 4.0
    work[W.WATER_0] += speed * speed * (pulled + sag)


@compiled
def disturbances(p: FloatArray, t: float, speed: float, wake: float, aired: float) -> float:
    """Return the translation's load by old waves, the struts' wakes and ventilation."""
    waves = 0.0
    if p[P.WAVE] != 0.0:
        turn = 2.0 * math.pi * p[P.WAVE_HZ] * t + p[P.WAVE_PHASE]
        left = p[P.WAVE] * math.exp(-(p[P.WAITED] + t) / p[P.WAVE_DECAY])
        waves = left * (math.sin(turn) + 0.3 * math.sin(1.13 * turn + 1.0))
    return float(
        waves + p[P.WAKE] * speed * speed * wake + p[P.VENTILATION] * speed * speed * aired
    )


@compiled
def held_by_carriage(p: FloatArray, x: float, v: float, bristle: float, wound: float) -> float:
    """Return the load of seals, guides and cable at one strut.

    ``bristle`` is the friction force, ``wound`` the cable's hysteresis between -1 and 1.
    """
    cable = p[P.CABLE_STIFFNESS] * x / (1.0 + p[P.CABLE_SOFTENING] * x * x) + p[P.CABLE_PRELOAD]
    tare = p[P.TARE_VISCOUS] * v + p[P.TARE_QUADRATIC] * smooth_square(v)
    below = p[P.GUIDE_BELOW] * v / (1.0 + 0.2 * abs(v))
    if p[P.GUIDE_POWER] > 0.0:
        below = p[P.GUIDE_BELOW] * powered(v, p[P.GUIDE_POWER])
    return float(
        bristle + below + 0.5 * cable + 0.5 * p[P.CABLE_RUBBING] * wound + p[P.WATER] * tare
    )
