"""Motor, gear, crank, struts, gauges, frame and model as ordinary differential equations, compiled.

The state ``y`` (:class:`Y`) is integrated; what rubs, creeps or remembers (:class:`H`) is held over
a step and brought forward exactly at its end (:mod:`tests.sealed.generator.rubbing`). How the
struts hold the model is in :mod:`tests.sealed.generator.holding`.
"""

import math

from tests.sealed.generator.compiled import compiled
from tests.sealed.generator.loads import (
    curved_springs,
    disturbances,
    drags,
    held_by_carriage,
    linear_water,
)
from tests.sealed.generator.parameters import FloatArray, P
from tests.sealed.generator.places import H, W, Y


@compiled
def crank(p: FloatArray, strut: int, theta: float, w: FloatArray) -> None:
    """Write displacement, slope and curvature over the shaft's angle (aft: 0, fore: 1)."""
    at = W.WAY_AFT + 3 * strut
    e = p[P.ECCENTRICITY] + p[P.ECC_ERROR_AFT + strut]
    turn = theta + strut * (p[P.STRUT_PHASE] + p[P.PHASE_ERROR])
    tilt = p[P.TILT_AFT + strut]
    if tilt != 0.0:
        turn += tilt
        e /= math.cos(tilt)
    sine, cosine = e * math.sin(turn), e * math.cos(turn)
    w[at], w[at + 1], w[at + 2] = sine, cosine, -sine
    if p[P.ROD] > 0.0:
        beside = cosine - p[P.ROD_OFFSET]
        along = math.sqrt(p[P.ROD] ** 2 - beside * beside)
        w[at] += along - p[P.ROD]
        w[at + 1] += beside * sine / along
        w[at + 2] += (beside * cosine - sine * sine) / along
        w[at + 2] -= (beside * sine) ** 2 / along**3


@compiled
def dead_zone(x: float, half: float) -> float:
    """Return how far ``x`` is beyond a clearance of ``half`` on either side."""
    if x > half:
        return x - half
    return x + half if x < -half else 0.0


@compiled
def clearance(p: FloatArray, x: float, half: float) -> float:
    """Return how far ``x`` is beyond a clearance; soft contacts take hold by and by."""
    if p[P.CONTACT_SOFT] > 0.0:
        return float(x - half * math.tanh(x / half)) if half > 0.0 else x
    return dead_zone(x, half)


@compiled
def gauge_force(p: FloatArray, y: FloatArray, held: FloatArray, strut: int, w: FloatArray) -> float:
    """Return the force of a strut on the model, through joint and gauge."""
    displaced, slope = w[W.WAY_AFT + 3 * strut], w[W.WAY_AFT + 3 * strut + 1]
    gap = displaced + y[Y.FRAME] - held[H.PLAY_AFT + strut] - w[W.AT_AFT + strut]
    stretch = clearance(p, gap, p[P.KNOCK])
    if stretch == 0.0 and p[P.KNOCK] > 0.0:
        return 0.0
    damping = p[P.GAUGE_DAMPING] * (
        slope * y[Y.CRANK_SPEED] + y[Y.FRAME_SPEED] - w[W.RATE_AFT + strut]
    )
    if p[P.GAUGE_UNLIKE] != 0.0:
        stretch *= 1.0 - p[P.GAUGE_UNLIKE] if strut == 0 else 1.0 + p[P.GAUGE_UNLIKE]
    return float(p[P.GAUGE_STIFFNESS] * stretch + damping)


@compiled
def meshed(p: FloatArray, y: FloatArray, held: FloatArray) -> float:
    """Return the torque from gear to crank, through uneven teeth and their clearance."""
    twist, rate = y[Y.MOTOR] - y[Y.CRANK] - held[H.CREPT], y[Y.MOTOR_SPEED] - y[Y.CRANK_SPEED]
    if p[P.TEETH] != 0.0:
        turn = p[P.TEETH_ORDER] * y[Y.CRANK] + p[P.TEETH_PHASE]
        uneven = math.sin(turn) + 0.1 * math.sin(2.0 * turn)
        slope = math.cos(turn) + 0.2 * math.cos(2.0 * turn)
        if p[P.TEETH_SHAPE] > 0.0:
            uneven = math.sin(turn) - math.sin(3.0 * turn) / 9.0 + math.sin(5.0 * turn) / 25.0
            slope = math.cos(turn) - math.cos(3.0 * turn) / 3.0 + math.cos(5.0 * turn) / 5.0
        twist += p[P.TEETH] / p[P.TEETH_ORDER] * uneven
        rate += p[P.TEETH] * y[Y.CRANK_SPEED] * slope
    for order in range(1, 3):
        at = P.RIPPLE_1S + 2 * (order - 1)
        if p[at] != 0.0 or p[at + 1] != 0.0:
            sine, cosine = math.sin(order * y[Y.CRANK]), math.cos(order * y[Y.CRANK])
            twist += (p[at] * sine + p[at + 1] * cosine) / order
            rate += y[Y.CRANK_SPEED] * (p[at] * cosine - p[at + 1] * sine)
    if p[P.BACKLASH] > 0.0:
        twist = clearance(p, twist, p[P.BACKLASH])
        if twist == 0.0:
            return 0.0
    return float(p[P.GEAR_STIFFNESS] * twist + p[P.GEAR_DAMPING] * rate)


@compiled
def drive_rates(
    p: FloatArray, y: FloatArray, held: FloatArray, load: float, carried: float, dy: FloatArray
) -> None:
    """Write the rates of motor, servo and crank.

    ``load`` is the torque that the struts take, ``carried`` the inertia that turns with the crank.
    """
    mesh = meshed(p, y, held)
    slow = p[P.OMEGA] * (1.0 + p[P.SPEED_ERROR]) - y[Y.MOTOR_SPEED]
    torque = p[P.SERVO_P] * slow + p[P.SERVO_I] * y[Y.SERVO]
    if p[P.SERVO_SOFT] > 0.0:
        torque = p[P.SERVO_P] * p[P.SERVO_SOFT] * math.tanh(slow / p[P.SERVO_SOFT])
    if p[P.COGGING] != 0.0:
        turn = p[P.COGGING_ORDER] * y[Y.MOTOR] + p[P.COGGING_PHASE]
        torque += p[P.COGGING] * math.cos(turn)
        if p[P.COGGING_SHAPE] > 0.0:
            torque += p[P.COGGING] * (0.4 * math.cos(2.0 * turn) + 0.2 * math.sin(3.0 * turn))
    dy[Y.MOTOR] = y[Y.MOTOR_SPEED]
    dy[Y.MOTOR_SPEED] = (torque - mesh) / p[P.MOTOR_INERTIA]
    dy[Y.SERVO] = slow
    dy[Y.CRANK] = y[Y.CRANK_SPEED]
    dy[Y.CRANK_SPEED] = (mesh - load) / (p[P.CRANK_INERTIA] + carried)


@compiled
def frame_rates(p: FloatArray, t: float, y: FloatArray, pull: float, dy: FloatArray) -> None:
    """Write the rates of the frame that carries both struts; without stiffness it is rigid."""
    dy[Y.FRAME] = y[Y.FRAME_SPEED]
    if p[P.FRAME_STIFFNESS] > 0.0:
        turn = 2.0 * math.pi * p[P.FRAME_SHAKE_HZ] * t
        shake = p[P.FRAME_SHAKE] * (math.sin(turn) + 0.4 * math.sin(0.83 * turn))
        spring = p[P.FRAME_STIFFNESS] * y[Y.FRAME] + p[P.FRAME_DAMPING] * y[Y.FRAME_SPEED]
        dy[Y.FRAME_SPEED] = (shake - spring - pull) / p[P.FRAME_MASS]


@compiled
def slosh_rates(p: FloatArray, y: FloatArray, dy: FloatArray) -> float:
    """Write the rates of water that sloshes in the model; return its pull on the model."""
    s, rate = y[Y.SLOSH], y[Y.SLOSH_SPEED]
    omega = p[P.SLOSH_OMEGA]
    pull = omega * omega * s * (1.0 + p[P.SLOSH_HARDENING] * s * s)
    pull += 2.0 * p[P.SLOSH_DAMPING] * omega * rate
    dy[Y.SLOSH] = rate
    dy[Y.SLOSH_SPEED] = -pull
    return float(pull)


@compiled
def wake_rates(p: FloatArray, y: FloatArray, speed: float, dy: FloatArray) -> None:
    """Write the rates of a van der Pol wake, which the strut's own acceleration pulls along."""
    omega = 2.0 * math.pi * p[P.STROUHAL] * speed / p[P.WAKE_DIAMETER]
    q, rate = y[Y.WAKE], y[Y.WAKE_SPEED]
    dy[Y.WAKE] = rate
    dy[Y.WAKE_SPEED] = 0.3 * omega * (1.0 - 4.0 * q * q) * rate - omega * omega * q
    dy[Y.WAKE_SPEED] += dy[Y.V0] / p[P.WAKE_DIAMETER]


@compiled
def water_takes(
    p: FloatArray, t: float, speed: float, y: FloatArray, held: FloatArray, w: FloatArray
) -> None:
    """Write the loads of water and weight on the model, but for inertia.

    ``speed`` is that at which the water passes.
    """
    w[W.WATER_0] = -p[P.PRELOAD]
    w[W.WATER_1] = p[P.MASS] * p[P.GRAVITY] * p[P.CG_Z] * math.sin(y[Y.Q1])
    if p[P.WATER] > 0.0:
        linear_water(p, y[Y.Q0], y[Y.Q1], y[Y.V1], w)
        drags(p, w[W.THROUGH], y[Y.V1], w)
        curved_springs(p, speed, y[Y.Q0], w)
        w[W.WATER_0] += disturbances(p, t, speed, y[Y.WAKE], held[H.AIRED]) + held[H.MEMORY_0]
        w[W.WATER_1] += held[H.MEMORY_1]


@compiled
def kept_at(p: FloatArray, held: FloatArray, strut: int, w: FloatArray) -> float:
    """Return what the parts between carriage and model take from one strut."""
    x, v = w[W.AT_AFT + strut], w[W.RATE_AFT + strut]
    return held_by_carriage(p, x, v, held[H.BRISTLE_AFT + strut], held[H.WOUND_AFT + strut])


@compiled
def above(p: FloatArray, y: FloatArray, held: FloatArray, slope: float, strut: int) -> float:
    """Return the shaft's torque by one strut's guides above the dynamometer."""
    return float(
        slope * (held[H.GUIDE_AFT + strut] + p[P.GUIDE_VISCOUS] * slope * y[Y.CRANK_SPEED])
    )
