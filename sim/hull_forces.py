"""The forces on the model that its linear system does not have: laws, and a varying speed."""

from dataclasses import dataclass, replace
from typing import ClassVar, NamedTuple

import numpy as np

from sim.acting import Acting, Point
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
    motion: ModelMotion,
    period: Period,
    speed_m_s: float,
) -> ComplexArray:
    """Return the harmonics of :func:`law_forces` over a period, shape ``(orders + 1, 2)``.

    ``motion`` holds values at the period's points.
    """
    instants = Instants(
        period.time_s, period.step_s, np.full(period.points, speed_m_s, dtype=np.float64)
    )
    taking_part = [one for one in laws if one.law.periodic]
    smooth = tuple(one for one in taking_part if not one.law.jumps)
    jumping = tuple(one for one in taking_part if one.law.jumps)
    found = period.harmonics(law_forces(smooth, cross_flow, system, motion, instants))
    if jumping:
        alone = replace(system, drift_load=np.zeros(2))
        means = period.harmonics(law_forces(jumping, None, alone, motion, instants))
        found += means / period.mean_over_step[:, np.newaxis]
    return found
