"""What rubs, creeps and remembers, brought forward by one step, compiled.

A LuGre bristle under a velocity that is constant over the step decays towards its steady state with
the distance travelled: exact, whatever the step. Bouc-Wen's loop (n = 1) is of the same form.
"""

import math

from tests.sealed.generator.compiled import compiled
from tests.sealed.generator.mechanics import meshed
from tests.sealed.generator.parameters import FloatArray, P
from tests.sealed.generator.places import H, W, Y

# Distance in which a bristle comes to its steady state, and the cable's hysteresis likewise.
BRISTLE_M = 1e-4
WOUND_M = 2e-3
# Velocity at which a friction without bristles has turned.
TANH_M_S = 3e-3


@compiled
def settled(bristle: float, level: float, v: float, dt: float, distance: float) -> float:
    """Return a bristle's force after ``dt`` at velocity ``v``; ``level`` is its steady size."""
    goal = level if v > 0.0 else -level
    return goal + (bristle - goal) * math.exp(-abs(v) * dt / distance)


@compiled
def wound_up(bristle: float, level: float, v: float, dt: float, distance: float) -> float:
    """Return the force of a Bouc-Wen loop with n = 2 (beta = gamma) after ``dt``; exact too."""
    if level <= 0.0:
        return 0.0
    way, path = math.copysign(1.0, v), abs(v) * dt / distance
    along = way * bristle / level
    back = min(path, max(-along, 0.0))
    along = min(along + back, 1.0 - 1e-12)
    if along >= 0.0:
        along = math.tanh(math.atanh(along) + path - back)
    return way * level * along


@compiled
def bristle_force(
    p: FloatArray, bristle: float, level: float, v: float, dt: float, distance: float
) -> float:
    """Return a bristle's force after ``dt``, in the form that rubs here."""
    if p[P.BRISTLE_SHAPE] == 1.0:
        return level * math.tanh(v / TANH_M_S)
    if p[P.BRISTLE_SHAPE] == 2.0:
        return wound_up(bristle, level, v, dt, distance)
    return settled(bristle, level, v, dt, distance)


@compiled
def friction_level(p: FloatArray, force: float, v: float) -> float:
    """Return the steady friction below the dynamometer at velocity ``v``."""
    level = p[P.COULOMB] + math.copysign(0.5 * p[P.UNEVEN], v)
    if p[P.STRIBECK] != 0.0:
        if p[P.BRISTLE_SHAPE] > 0.0:
            level += p[P.STRIBECK] / (1.0 + (v / p[P.STRIBECK_SPEED]) ** 2)
        else:
            level += p[P.STRIBECK] * math.exp(-abs(v) / p[P.STRIBECK_SPEED])
    return float(level + p[P.LOAD_FRICTION] * abs(force + p[P.SIDE_LOAD]))


@compiled
def rubs(p: FloatArray) -> bool:
    """Tell whether anything rubs below the dynamometers."""
    some = p[P.COULOMB] + abs(p[P.UNEVEN]) + p[P.STRIBECK] + p[P.LOAD_FRICTION]
    return bool(some + p[P.CABLE_RUBBING] != 0.0)


@compiled
def rub_below(p: FloatArray, held: FloatArray, dt: float, work: FloatArray) -> None:
    """Bring friction and cable below the dynamometers forward by ``dt``."""
    for strut in range(2):
        v = work[W.RATE_AFT + strut]
        level = friction_level(p, held[H.FORCE_AFT + strut], v)
        at = H.BRISTLE_AFT + strut
        held[at] = bristle_force(p, held[at], level, v, dt, BRISTLE_M)
        at = H.WOUND_AFT + strut
        held[at] = settled(held[at], 1.0, v, dt, WOUND_M)


@compiled
def rub_above(p: FloatArray, y: FloatArray, held: FloatArray, dt: float, work: FloatArray) -> None:
    """Bring the guides' friction and the last joints' play forward by ``dt``."""
    for strut in range(2):
        v = work[W.WAY_AFT + 3 * strut + 1] * y[Y.CRANK_SPEED]
        at = H.GUIDE_AFT + strut
        held[at] = settled(held[at], p[P.GUIDE_COULOMB], v, dt, BRISTLE_M)
        if p[P.PLAY] > 0.0:
            at = H.PLAY_AFT + strut
            if p[P.PLAY_SHAPE] > 0.0:
                held[at] = min(max(held[at] + v * dt, -p[P.PLAY]), p[P.PLAY])
            else:
                held[at] = settled(held[at], p[P.PLAY], v, dt, p[P.PLAY])


@compiled
def rub(p: FloatArray, y: FloatArray, held: FloatArray, dt: float, work: FloatArray) -> None:
    """Bring everything that rubs forward by ``dt``."""
    if rubs(p):
        rub_below(p, held, dt, work)
    if p[P.GUIDE_COULOMB] > 0.0 or p[P.PLAY] > 0.0:
        rub_above(p, y, held, dt, work)


@compiled
def creep(p: FloatArray, y: FloatArray, held: FloatArray, dt: float) -> None:
    """Bring the belt's creep and the strut's ventilation forward by ``dt``."""
    if p[P.CREEP] != 0.0:
        torque = meshed(p, y, held)
        held[H.CREPT] += dt * p[P.CREEP] * torque * abs(torque) / (3.0 + abs(torque))
    if p[P.VENTILATION] != 0.0:
        fast = (
            p[P.SPEED] > p[P.VENTILATION_SPEED] and y[Y.V0] > 0.3 * p[P.OMEGA] * p[P.ECCENTRICITY]
        )
        goal = 1.0 if fast else 0.0
        held[H.AIRED] = goal + (held[H.AIRED] - goal) * math.exp(-dt / 0.12)
