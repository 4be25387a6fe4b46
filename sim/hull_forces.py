"""The forces on the model that its linear system does not have: laws, and a varying speed."""

from dataclasses import dataclass, replace
from typing import ClassVar, NamedTuple

import numpy as np

from sim.acting import Acting, Point
from sim.corners import nodes_between
from sim.hull_system import HullSystem
from sim.laws import Motion
from sim.linear import ComplexArray, Rows, as_rows
from sim.period import Period
from sim.signals import FloatArray
from sim.stage import UNKNOWN_KEYS_REFUSED
from sim.water.force_laws import cubic_loads, quadratic_loads


@dataclass(frozen=True)
class CrossFlow:
    """Cubic and quadratic loads of both velocities through the water, coupled.

    Attributes
    ----------
    cubic, quadratic
        Rows force and moment; columns as in :mod:`sim.water.force_laws`. ``None`` for none.
    """

    cubic: Rows | None = None
    quadratic: Rows | None = None

    __pydantic_config__: ClassVar = UNKNOWN_KEYS_REFUSED

    def scaled(self, factor: float) -> "CrossFlow":
        """Return loads that are larger by a factor."""
        return CrossFlow(_times(self.cubic, factor), _times(self.quadratic, factor))

    def loads(self, velocity: FloatArray) -> FloatArray:
        """Return force and moment, shape ``(2, samples)``, for velocities of that shape."""
        total = np.zeros_like(velocity)
        if self.cubic is not None:
            total += cubic_loads(self.cubic, velocity)
        if self.quadratic is not None:
            total += quadratic_loads(self.quadratic, velocity)
        return total


def _times(rows: Rows | None, factor: float) -> Rows | None:
    return None if rows is None else as_rows(np.array(rows) * factor)


class ModelMotion(NamedTuple):
    """The model at the struts: h, h', h'' and the load of the linear parts, ``(samples, 2)``."""

    position: FloatArray
    velocity: FloatArray
    acceleration: FloatArray
    load: FloatArray


class Instants(NamedTuple):
    """When, and how fast the carriage is."""

    time_s: FloatArray
    step_s: float
    speed_m_s: FloatArray


def law_forces(
    laws: tuple[Acting, ...],
    cross_flow: CrossFlow | None,
    system: HullSystem,
    motion: ModelMotion,
    instants: Instants,
) -> FloatArray:
    """Return the force of each strut that the laws and a drift angle ask for, ``(samples, 2)``."""
    total = np.zeros_like(motion.position)
    for acting in laws:
        along, at_point = at(acting.point, system, motion, instants)
        total += acting.law.force(at_point)[:, np.newaxis] * along
    flow = instants.speed_m_s[:, np.newaxis]
    if cross_flow is not None:
        incidence = motion.position @ system.incidence.T + flow * system.drift
        velocity = motion.velocity @ system.to_motion.T + incidence
        total += cross_flow.loads(velocity.T).T @ system.to_motion
    return total + flow * system.drift_load


def at(
    point: Point, system: HullSystem, motion: ModelMotion, instants: Instants
) -> tuple[FloatArray, Motion]:
    """Return the direction of a point's motion in strut coordinates, and that motion."""
    along, load = direction(point, system.to_motion)
    velocity, acceleration = motion.velocity @ along, motion.acceleration @ along
    if point is Point.THROUGH_WATER:
        velocity = velocity + motion.position @ system.incidence[0]
        velocity = velocity + instants.speed_m_s * system.drift[0]
        acceleration = acceleration + motion.velocity @ system.incidence[0]
    return along, Motion(
        motion.position @ along, velocity, acceleration, motion.load @ load, *instants
    )


def direction(point: Point, to_motion: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return what of the struts' motion a point has, and what of their loads: shape ``(2,)``."""
    if point in (Point.AFT, Point.FORE):
        unit = np.eye(2)[0 if point is Point.AFT else 1]
        return unit, unit
    row = 1 if point is Point.ROTATION else 0
    return to_motion[row], np.linalg.inv(to_motion).T[row]


def law_harmonics(
    laws: tuple[Acting, ...],
    cross_flow: CrossFlow | None,
    system: HullSystem,
    waves: ComplexArray,
    period: Period,
    speed_m_s: float,
) -> ComplexArray:
    """Return the harmonics of :func:`law_forces` over a period, shape ``(orders + 1, 2)``.

    What jumps or bends is integrated between its corners, all else at the period's points.

    Parameters
    ----------
    waves
        Harmonics of h, h', h'' and the load of the linear parts at the struts,
        ``(orders + 1, 8)``.
    """
    laws = tuple(one for one in laws if one.law.periodic)
    smooth = tuple(one for one in laws if not one.law.corners)
    at_points = ModelMotion(*np.split(period.values(waves), 4, axis=1))
    instants = Instants(period.time_s, period.step_s, np.full(period.points, speed_m_s))
    found = period.harmonics(law_forces(smooth, None, system, at_points, instants))
    alone = replace(system, drift_load=np.zeros(2))
    orders = np.arange(len(waves))
    for one in (*(one for one in laws if one.law.corners), cross_flow):
        if one is None:
            continue
        signals, corners = _cornered(one, system, waves, speed_m_s)
        phase, weight = nodes_between(signals, corners, period.points)
        turned = np.exp(1j * np.outer(phase, orders))
        motion = ModelMotion(*np.split((turned @ waves).real, 4, axis=1))
        instants = Instants(phase / period.omega_rad_s, 0.0, np.full(phase.size, speed_m_s))
        if isinstance(one, CrossFlow):
            force = law_forces((), one, alone, motion, instants)
        else:
            force = law_forces((one,), None, alone, motion, instants)
        added = 2.0 * (turned.conj() * weight[:, np.newaxis]).T @ force
        added[0] = added[0].real / 2.0
        found += added
    return found


def _cornered(
    one: Acting | CrossFlow, system: HullSystem, waves: ComplexArray, speed_m_s: float
) -> tuple[ComplexArray, FloatArray]:
    """Return the harmonics of what a force depends on, a row each, and its corners."""
    h, velocity, acceleration, load = np.split(waves, 4, axis=1)
    flow = np.zeros(len(waves))
    flow[0] = speed_m_s
    if isinstance(one, CrossFlow):
        through = velocity @ system.to_motion.T + h @ system.incidence.T
        through = through + flow[:, np.newaxis] * system.drift
        return through.T, np.array([[0.0, 0.0], [1.0, 0.0]])
    along, share = direction(one.point, system.to_motion)
    v, a = velocity @ along, acceleration @ along
    if one.point is Point.THROUGH_WATER:
        v = v + h @ system.incidence[0] + flow * system.drift[0]
        a = a + velocity @ system.incidence[0]
    return np.stack([h @ along, v, a, load @ share]), np.array(one.law.corners, dtype=float)
