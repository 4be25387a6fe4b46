"""Motor, gear, crank, struts, gauges, frame and model as ordinary differential equations, compiled.

The state ``y`` (:class:`Y`) is integrated; what rubs, creeps or remembers (:class:`H`) is held over
a step and brought forward exactly at its end (:mod:`tests.sealed.generator.rubbing`). With gauges
that give way the model moves on its own (:func:`loose_rates`); on rigid ones it goes where the
struts go, and the shaft feels its inertia (:func:`rigid_rates`).
"""

import math

from tests.sealed.generator.compiled import compiled
from tests.sealed.generator.loads import (
    carriage_speed,
    curved_springs,
    disturbances,
    drags,
    held_by_carriage,
    linear_water,
)
from tests.sealed.generator.parameters import FloatArray, P
from tests.sealed.generator.places import H, W, Y


@compiled
def side(p: FloatArray, strut: int) -> float:
    """Return +1 for the strut that a positive rotation moves along d, -1 for the other."""
    return float(p[P.AFT_SIGN] if strut == 0 else -p[P.AFT_SIGN])


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
def lift_of(p: FloatArray, rotation: float, strut: int) -> float:
    """Return the strut point's displacement by a rotation of the model."""
    turned = math.sin(rotation) if p[P.ARC] > 0.0 else rotation
    return float(side(p, strut) * p[P.LEVER] * turned)


@compiled
def gauge_force(
    p: FloatArray, y: FloatArray, held: FloatArray, strut: int, displaced: float, speed: float
) -> float:
    """Return the force of a strut on the model, through joint and gauge."""
    here = y[Y.Q0] + lift_of(p, y[Y.Q1], strut)
    rate = y[Y.V0] + side(p, strut) * p[P.LEVER] * y[Y.V1]
    gap = displaced + y[Y.FRAME] - held[H.PLAY_AFT + strut] - here
    stretch = dead_zone(gap, p[P.KNOCK])
    if stretch == 0.0 and p[P.KNOCK] > 0.0:
        return 0.0
    damping = p[P.GAUGE_DAMPING] * (speed + y[Y.FRAME_SPEED] - rate)
    return float(p[P.GAUGE_STIFFNESS] * stretch + damping)


@compiled
def meshed(p: FloatArray, y: FloatArray, held: FloatArray) -> float:
    """Return the torque from gear to crank, through uneven teeth and their clearance."""
    twist, rate = y[Y.MOTOR] - y[Y.CRANK] - held[H.CREPT], y[Y.MOTOR_SPEED] - y[Y.CRANK_SPEED]
    if p[P.TEETH] != 0.0:
        turn = p[P.TEETH_ORDER] * y[Y.CRANK] + p[P.TEETH_PHASE]
        uneven = math.sin(turn) + 0.1 * math.sin(2.0 * turn)
        twist += p[P.TEETH] / p[P.TEETH_ORDER] * uneven
        rate += p[P.TEETH] * y[Y.CRANK_SPEED] * (math.cos(turn) + 0.2 * math.cos(2.0 * turn))
    if p[P.BACKLASH] > 0.0:
        twist = dead_zone(twist, p[P.BACKLASH])
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
    if p[P.COGGING] != 0.0:
        torque += p[P.COGGING] * math.cos(p[P.COGGING_ORDER] * y[Y.MOTOR] + p[P.COGGING_PHASE])
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
def water_takes(p: FloatArray, t: float, y: FloatArray, held: FloatArray, w: FloatArray) -> None:
    """Write the loads of water and weight on the model, but for inertia."""
    w[W.WATER_0] = -p[P.PRELOAD]
    w[W.WATER_1] = p[P.MASS] * p[P.GRAVITY] * p[P.CG_Z] * y[Y.Q1]
    if p[P.WATER] > 0.0:
        speed = carriage_speed(p, t) * (1.0 + 1.5 * p[P.BLOCKAGE])
        through = y[Y.V0] + p[P.INCIDENCE] * speed * y[Y.Q1]
        linear_water(p, speed, y[Y.Q0], y[Y.Q1], through, y[Y.V1], w)
        drags(p, through, y[Y.V1], w)
        curved_springs(p, speed, y[Y.Q0], w)
        w[W.WATER_0] += disturbances(p, t, speed, y[Y.WAKE], held[H.AIRED]) + held[H.MEMORY_0]
        w[W.WATER_1] += held[H.MEMORY_1]


@compiled
def kept_at(p: FloatArray, y: FloatArray, held: FloatArray, strut: int) -> float:
    """Return what the parts between carriage and model take from one strut."""
    arm = side(p, strut) * p[P.LEVER]
    x, v = y[Y.Q0] + arm * y[Y.Q1], y[Y.V0] + arm * y[Y.V1]
    return held_by_carriage(p, x, v, held[H.BRISTLE_AFT + strut], held[H.WOUND_AFT + strut])


@compiled
def above(p: FloatArray, y: FloatArray, held: FloatArray, slope: float, strut: int) -> float:
    """Return the shaft's torque by one strut's guides above the dynamometer."""
    return float(
        slope * (held[H.GUIDE_AFT + strut] + p[P.GUIDE_VISCOUS] * slope * y[Y.CRANK_SPEED])
    )


@compiled
def loose_rates(
    p: FloatArray, t: float, y: FloatArray, held: FloatArray, w: FloatArray, dy: FloatArray
) -> None:
    """Write the rates of a model on gauges (and a frame) that give way."""
    push0, push1, pull, load = -w[W.WATER_0], -w[W.WATER_1], 0.0, 0.0
    for strut in range(2):
        at = W.WAY_AFT + 3 * strut
        slope = w[at + 1]
        force = gauge_force(p, y, held, strut, w[at], slope * y[Y.CRANK_SPEED])
        free = force - kept_at(p, y, held, strut)
        held[H.FORCE_AFT + strut] = force
        load += slope * force + above(p, y, held, slope, strut)
        pull += force
        push0 += free
        push1 += side(p, strut) * p[P.LEVER] * free
    drive_rates(p, y, held, load, 0.0, dy)
    frame_rates(p, t, y, pull, dy)
    det = w[W.M00] * w[W.M11] - w[W.M01] * w[W.M10]
    dy[Y.Q0] = y[Y.V0]
    dy[Y.Q1] = y[Y.V1]
    dy[Y.V0] = (w[W.M11] * push0 - w[W.M01] * push1) / det
    dy[Y.V1] = (w[W.M00] * push1 - w[W.M10] * push0) / det


@compiled
def rigid_place(p: FloatArray, y: FloatArray, w: FloatArray) -> None:
    """Write the model's place by the struts' into ``y`` and ``w``: slopes and curvatures too."""
    for i in range(3):
        w[W.MEAN + i] = 0.5 * (w[W.WAY_AFT + i] + w[W.WAY_FORE + i])
        w[W.TURN + i] = side(p, 0) * (w[W.WAY_AFT + i] - w[W.WAY_FORE + i]) / (2.0 * p[P.LEVER])
    w[W.COSINE] = 1.0
    if p[P.ARC] > 0.0:
        u, slope, curve = w[W.TURN], w[W.TURN + 1], w[W.TURN + 2]
        cosine = math.sqrt(1.0 - u * u)
        w[W.TURN] = math.asin(u)
        w[W.TURN + 1] = slope / cosine
        w[W.TURN + 2] = (curve + u * slope * slope / cosine**2) / cosine
        w[W.COSINE] = cosine
    y[Y.Q0], y[Y.V0] = w[W.MEAN], w[W.MEAN + 1] * y[Y.CRANK_SPEED]
    y[Y.Q1], y[Y.V1] = w[W.TURN], w[W.TURN + 1] * y[Y.CRANK_SPEED]


@compiled
def put(p: FloatArray, y: FloatArray, w: FloatArray) -> None:
    """Write the struts' places into ``w``; on rigid gauges the model's go with them."""
    for strut in range(2):
        crank(p, strut, y[Y.CRANK], w)
    if p[P.GAUGE_STIFFNESS] == 0.0:
        rigid_place(p, y, w)


@compiled
def rigid_rates(
    p: FloatArray, y: FloatArray, held: FloatArray, w: FloatArray, dy: FloatArray
) -> None:
    """Write the rates of a shaft that carries the model's inertia; forces by Newton's law."""
    speed = y[Y.CRANK_SPEED]
    slope0, slope1 = w[W.MEAN + 1], w[W.TURN + 1]
    load0 = w[W.WATER_0] + (w[W.M00] * w[W.MEAN + 2] + w[W.M01] * w[W.TURN + 2]) * speed**2
    load1 = w[W.WATER_1] + (w[W.M10] * w[W.MEAN + 2] + w[W.M11] * w[W.TURN + 2]) * speed**2
    heavy0 = w[W.M00] * slope0 + w[W.M01] * slope1
    heavy1 = w[W.M10] * slope0 + w[W.M11] * slope1
    load = slope0 * load0 + slope1 * load1
    for strut in range(2):
        slope = w[W.WAY_AFT + 3 * strut + 1]
        w[W.KEPT_AFT + strut] = kept_at(p, y, held, strut)
        load += slope * w[W.KEPT_AFT + strut] + above(p, y, held, slope, strut)
    drive_rates(p, y, held, load, slope0 * heavy0 + slope1 * heavy1, dy)
    load0 += heavy0 * dy[Y.CRANK_SPEED]
    load1 += heavy1 * dy[Y.CRANK_SPEED]
    for strut in range(2):
        moment = side(p, strut) * load1 / (2.0 * p[P.LEVER] * w[W.COSINE])
        held[H.FORCE_AFT + strut] = 0.5 * load0 + moment + w[W.KEPT_AFT + strut]
    dy[Y.V0] = w[W.MEAN + 2] * speed**2 + slope0 * dy[Y.CRANK_SPEED]


@compiled
def rates(
    p: FloatArray, t: float, y: FloatArray, held: FloatArray, w: FloatArray, dy: FloatArray
) -> None:
    """Write the rates of all states; the gauges' forces are left in ``held``."""
    dy[:] = 0.0
    loose = p[P.GAUGE_STIFFNESS] > 0.0
    put(p, y, w)
    water_takes(p, t, y, held, w)
    if p[P.SLOSH_MASS] > 0.0:
        w[W.WATER_0] -= p[P.SLOSH_MASS] * slosh_rates(p, y, dy)
    if loose:
        loose_rates(p, t, y, held, w, dy)
    else:
        rigid_rates(p, y, held, w, dy)
    dy[Y.SLOSH_SPEED] -= dy[Y.V0]
    if p[P.WAKE] != 0.0:
        wake_rates(p, y, carriage_speed(p, t), dy)
    if not loose:
        dy[Y.V0] = 0.0
