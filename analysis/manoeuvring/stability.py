"""Whether a ship keeps straight course with fixed controls."""

from dataclasses import dataclass

import numpy as np

from analysis.manoeuvring.ship import R, Ship, U, V
from hardware.description.arrays import FloatArray

_SMALL = 1e-6  # of the approach speed, or of U/L


@dataclass(frozen=True)
class CourseStability:
    """Stability of straight course, shape ``(n,)`` each.

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
    return CourseStability(
        _criterion(ship, _slopes(ship, bare=True)),
        _criterion(ship, _slopes(ship, bare=False)),
        _root(ship),
    )


def _state(ship: Ship) -> FloatArray:
    state = np.zeros((6, ship.count))
    state[U] = ship.approach_m_s
    return state


def _slopes(ship: Ship, *, bare: bool) -> FloatArray:
    """Return d(Y, N)/d(v', r') over the hull's own unit, shape ``(2, 2, n)``."""
    length, still = ship.hull.length_m, np.zeros(ship.count)
    unit = 0.5 * ship.hull.density_kg_m3 * ship.hull.area_m2 * ship.approach_m_s**2
    slopes = np.zeros((2, 2, ship.count))
    for column, (row, scale) in enumerate(
        ((V, ship.approach_m_s), (R, ship.approach_m_s / length))
    ):
        ends = []
        for sign in (1.0, -1.0):
            state = _state(ship)
            state[row] = sign * _SMALL * scale
            loads = ship.hull(*state[:3]) if bare else ship.loads(state, still)
            ends.append(loads[1:] / unit / np.array([[1.0], [length]]))
        slopes[:, column] = (ends[0] - ends[1]) / (2.0 * _SMALL)
    return slopes


def _criterion(ship: Ship, slopes: FloatArray) -> FloatArray:
    hull = ship.hull
    mass = ship.mass_kg / (0.5 * hull.density_kg_m3 * hull.area_m2 * hull.length_m)
    arm = mass * ship.cg_x_m / hull.length_m
    (y_v, y_r), (n_v, n_r) = slopes
    return np.asarray(y_v * (n_r - arm) - n_v * (y_r - mass))


def _root(ship: Ship) -> FloatArray:
    """Of the linear system of sway and yaw, by differences of the whole ship's rates."""
    unit, still = ship.hull.length_m / ship.approach_m_s, np.zeros(ship.count)
    scales = {V: ship.approach_m_s, R: 1.0 / unit}
    matrix = np.zeros((ship.count, 2, 2))
    for column, row in enumerate((V, R)):
        ends = []
        for sign in (1.0, -1.0):
            state = _state(ship)
            state[row] = sign * _SMALL * scales[row]
            ends.append(ship.rates(state, still)[[V, R]] / np.array([[scales[V]], [scales[R]]]))
        matrix[:, :, column] = ((ends[0] - ends[1]) / (2.0 * _SMALL)).T * unit
    return np.asarray(np.linalg.eigvals(matrix).real.max(axis=1))
