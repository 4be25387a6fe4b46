"""Whether a ship keeps straight course with fixed controls."""

from dataclasses import dataclass

import numpy as np

from analysis.manoeuvring.ship import R, Ship, U, V
from hardware.description.arrays import FloatArray

_SMALL = 1e-6  # of the approach speed, or of U/L


_SIDES = (1.0, -1.0)  # of a turn to starboard, and to port


@dataclass(frozen=True)
class CourseStability:
    """Stability of straight course, shape ``(n,)`` each.

    A rudder straightens the flow from one side otherwise than from the other, so that slopes differ
    between turns to starboard and to port: what is given is that of the less stable side.

    Attributes
    ----------
    criterion
        C' of the bare hull: ``Y_v' (N_r' - m' x_G') - N_v' (Y_r' - m')`` over its own system
        (Y_r' of the water alone); above 0 it is stable.
    with_rudder
        The same with propeller and rudder amidships behind it.
    root
        Largest real part of the roots of sway and yaw with rudder, times L/U; below 0 it is stable.
    """

    criterion: FloatArray
    with_rudder: FloatArray
    root: FloatArray


def straight_course(ship: Ship) -> CourseStability:
    """Return the stability on straight course at the approach speed."""
    bare, behind = (
        [_criterion(ship, _slopes(ship, side, bare=alone)) for side in _SIDES]
        for alone in (True, False)
    )
    roots = [_root(ship, side) for side in _SIDES]
    return CourseStability(np.minimum(*bare), np.minimum(*behind), np.maximum(*roots))


def _state(ship: Ship) -> FloatArray:
    state = np.zeros((6, ship.count))
    state[U] = ship.approach_m_s
    return state


def _begun(ship: Ship, row: int, side: float) -> tuple[FloatArray, float]:
    """Return the state a little into a turn, by drift or by rate, and by how much, over U or U/L.

    The ship drifts to the outside of its turn.
    """
    step = -side * _SMALL if row == V else side * _SMALL
    state = _state(ship)
    state[row] = step * ship.approach_m_s / (1.0 if row == V else ship.hull.length_m)
    return state, step


def _slopes(ship: Ship, side: float, *, bare: bool) -> FloatArray:
    """Return d(Y, N)/d(v', r') over the hull's own unit, shape ``(2, 2, n)``."""
    length, still = ship.hull.length_m, np.zeros(ship.count)
    unit = 0.5 * ship.hull.density_kg_m3 * ship.hull.area_m2 * ship.approach_m_s**2

    def loads(state: FloatArray) -> FloatArray:
        both = ship.hull(*state[:3]) if bare else ship.loads(state, still)
        return np.asarray(both[1:] / unit / np.array([[1.0], [length]]))

    slopes = np.zeros((2, 2, ship.count))
    straight = loads(_state(ship))
    for column, row in enumerate((V, R)):
        state, step = _begun(ship, row, side)
        slopes[:, column] = (loads(state) - straight) / step
    return slopes


def _criterion(ship: Ship, slopes: FloatArray) -> FloatArray:
    hull = ship.hull
    mass = ship.mass_kg / (0.5 * hull.density_kg_m3 * hull.area_m2 * hull.length_m)
    arm = mass * ship.cg_x_m / hull.length_m
    (y_v, y_r), (n_v, n_r) = slopes
    return np.asarray(y_v * (n_r - arm) - n_v * (y_r - mass))


def _root(ship: Ship, side: float) -> FloatArray:
    """Of the linear system of sway and yaw, by differences of the whole ship's rates."""
    unit, still = ship.hull.length_m / ship.approach_m_s, np.zeros(ship.count)
    scales = np.array([[ship.approach_m_s], [1.0 / unit]])
    straight = ship.rates(_state(ship), still)[[V, R]]
    matrix = np.zeros((ship.count, 2, 2))
    for column, row in enumerate((V, R)):
        state, step = _begun(ship, row, side)
        change = (ship.rates(state, still)[[V, R]] - straight) / scales
        matrix[:, :, column] = (change / step).T * unit
    return np.asarray(np.linalg.eigvals(matrix).real.max(axis=1))
