"""Turning circle, zig-zag and spiral, from straight course at the approach speed.

Turning circle and zig-zag are those of IMO MSC.137(76) and MSC/Circ.1053; distances are those of
the point that the hull's derivatives are about. The spiral is Dieudonne's (1953).
"""

import math
from dataclasses import dataclass

import numpy as np

from analysis.manoeuvring.march import Log, ShipState, approach, heading_beyond, march, turning_back
from analysis.manoeuvring.ship import PSI, R, Ship, U, V, X, Y
from hardware.description.arrays import FloatArray

STEP_LENGTHS = 0.04  # of a step, in L/U of the approach: overshoots to 1e-6 of themselves
_LONGEST_LENGTHS = 120.0  # of a phase: a ship that takes longer does not come there
_TURNED = 4.0 * math.pi  # after which a turn is steady
_SPIRAL_STEP = 0.5  # where the turn ends does not depend on it; modes up to 5 U/L do not grow
_SPIRAL_HOLDS = 5.0  # L/U of one hold; a rudder angle is held until the turn is steady
_SPIRAL_MOST = 120  # holds of one angle
_SPIRAL_STEADY = 1e-6  # r' changes by less in L/U: KCS at rudder 0, dying in 60 L/U, has 6e-5 left


@dataclass(frozen=True)
class TurningCircle:
    """A turning circle; every array has the shape ``(n,)``, NaN for a ship that does not turn.

    Attributes
    ----------
    advance, transfer, tactical_diameter
        Over L: along and across the approach at a change of heading of 90 degrees, and across at
        180 degrees.
    steady_diameter, steady_speed, steady_drift_rad
        Of the steady turn: 2 U / r over L, U over the approach speed, and drift.
    """

    advance: FloatArray
    transfer: FloatArray
    tactical_diameter: FloatArray
    steady_diameter: FloatArray
    steady_speed: FloatArray
    steady_drift_rad: FloatArray


@dataclass(frozen=True)
class ZigZag:
    """A zig-zag; every array has the shape ``(n,)``.

    Attributes
    ----------
    initial_turning
        Track over L until the first change of heading is reached.
    overshoots_rad
        First, second ... overshoot angle, shape ``(k, n)``.
    """

    initial_turning: FloatArray
    overshoots_rad: FloatArray


@dataclass(frozen=True)
class Spiral:
    """A spiral: rudder to starboard, in steps to port and back.

    Attributes
    ----------
    rudder_rad
        Angles, from starboard to port, shape ``(k,)``.
    down, up
        r' = r L / U with the rudder going to port and coming back, shape ``(k, n)``; NaN where the
        turn was not steady after the longest hold.
    """

    rudder_rad: FloatArray
    down: FloatArray
    up: FloatArray

    @property
    def height(self) -> FloatArray:
        """R' going less r' coming back at rudder 0: the loop of an unstable ship, ``(n,)``."""
        middle = int(np.argmin(np.abs(self.rudder_rad)))
        return np.asarray(self.down[middle] - self.up[middle])


def scale_s(ship: Ship) -> float:
    """Return L/U of the approach, s."""
    return ship.hull.length_m / ship.approach_m_s


def turning_circle(
    ship: Ship, rudder_rad: float, log: Log | None = None, step: float = STEP_LENGTHS
) -> TurningCircle:
    """Turn with the rudder laid at once to an angle; a positive one turns to starboard."""
    side, unit, length = math.copysign(1.0, rudder_rad), scale_s(ship), ship.hull.length_m
    now, places = approach(ship), []
    for angle in (0.5 * math.pi, math.pi, _TURNED):
        event = heading_beyond(side * angle, side)
        now = march(ship, now, rudder_rad, event, _LONGEST_LENGTHS * unit, step * unit, log)
        places.append(now.state)
    quarter, half, steady = places
    speed = np.hypot(steady[U], steady[V])
    return TurningCircle(
        quarter[X] / length,
        side * quarter[Y] / length,
        side * half[Y] / length,
        2.0 * speed / (side * steady[R]) / length,
        speed / ship.approach_m_s,
        np.arctan2(-steady[V], steady[U]) * side,
    )


def zigzag(
    ship: Ship,
    rudder_rad: float,
    heading_rad: float,
    overshoots: int = 2,
    log: Log | None = None,
    step: float = STEP_LENGTHS,
) -> ZigZag:
    """Zig-zag, first to the side of the rudder's sign, until so many overshoots are seen."""
    side, unit = math.copysign(1.0, rudder_rad), scale_s(ship)
    size, angle = abs(rudder_rad), abs(heading_rad)
    longest, steps = _LONGEST_LENGTHS * unit, step * unit
    track = Log(ship.count)
    now = march(
        ship, approach(ship), side * size, heading_beyond(side * angle, side), longest, steps, track
    )
    if log is not None:
        for moment in track.moments:
            log.keep(moment)
    beyond = []
    for _ in range(overshoots):
        now = march(ship, now, -side * size, turning_back(side), longest, steps, log)
        beyond.append(side * now.state[PSI] - angle)
        event = heading_beyond(-side * angle, -side)
        now = march(ship, now, -side * size, event, longest, steps, log)
        side = -side
    return ZigZag(_track_length(track.moments) / ship.hull.length_m, np.array(beyond))


def spiral(ship: Ship, largest_rad: float, step_rad: float) -> Spiral:
    """Hold rudder angles from starboard to port and back, each until the turn is steady.

    So no lag is left in the loop, other than of a ship that takes longer than 600 L/U.
    """
    count = round(largest_rad / step_rad)
    angles = step_rad * np.arange(count, -count - 1, -1, dtype=np.float64)
    unit, now = scale_s(ship), approach(ship)
    reached = []
    for angle in (*angles, *angles[-2::-1]):
        for _ in range(_SPIRAL_MOST):
            now = march(ship, now, angle, None, _SPIRAL_HOLDS * unit, _SPIRAL_STEP * unit)
            turn, change = _turning(ship, now)
            steady = np.abs(change) * unit < _SPIRAL_STEADY
            if steady.all():
                break
        reached.append(np.where(steady, turn, np.nan))
    down = np.array(reached[: len(angles)])
    return Spiral(np.asarray(angles), down, np.array(reached[len(angles) - 1 :])[::-1])


def _turning(ship: Ship, now: ShipState) -> tuple[FloatArray, FloatArray]:
    """Return r' = r L / U and how fast it changes, 1/s."""
    u, v, r = now.state[[U, V, R]]
    du, dv, dr = ship.rates(now.state, now.rudder_rad)[[U, V, R]]
    speed, length = np.hypot(u, v), ship.hull.length_m
    return r * length / speed, length / speed * (dr - r * (u * du + v * dv) / speed**2)


def _track_length(moments: list[ShipState]) -> FloatArray:
    """Return how far each ship went, m: chords of the track."""
    places = np.array([moment.state[[X, Y]] for moment in moments])
    return np.asarray(np.hypot(*np.diff(places, axis=0).swapaxes(0, 1)).sum(axis=0))
