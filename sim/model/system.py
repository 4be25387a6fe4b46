"""The model, the water and the mounting as one linear system, in the coordinates of the struts.

With y the strut motion, h = y + E p the model at the struts (E p what gauges and frame give way)
and v the velocity through the water, v = T h' + U S T h:

    F  = M h'' + B h' + C h + W xi + f            force of the struts on the model
    xi' = A_m xi + B_m (v + g)                    memory of the water; on board B_m T h'
    M_e p'' + C_e p' + K_e p = - E^T F            mounting

f are the forces that are no part of the linear system: those of laws, and what the exact geometry
asks for beyond M, B and C, its slopes at small angles. g is the velocity through the water that a
carriage adds which is not at its mean speed. Where the gauges' joints have a clearance, c is what
their springs then have too much, on the right of the last line. The states are (p, p', xi).
"""

import math
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.struts import to_motion
from sim.model.mounting import Elastic, StrutJoint
from sim.model.numbers import (
    corners_only,
    geometry_only,
    numbers_of,
    turns_with,
    weight_less_buoyancy,
    without_corners,
)
from sim.model.parameters import ModelParameters, mass_matrix
from sim.model.water.radiation import Radiation, constant
from sim.solve.linear_system import Hold, LinearSystem, causal_hold, hermite_hold

_NO_MEMORY = constant(np.zeros((2, 2)))
LOAD_DEGREE = 3  # of the polynomial by which f and g go on between samples


@dataclass(frozen=True, eq=False)
class HullSystem:
    """The linear system at one carriage speed.

    Attributes
    ----------
    mass, damping, stiffness
        M, B and C of the model with the water, shape ``(2, 2)``.
    speed_m_s
        Mean carriage speed U.
    turn
        The velocity through the water that a displacement gives per unit of speed: S T.
    numbers
        Of the exact geometry and loads (:mod:`sim.mechanism.geometry`), which f has beyond M, B and
        C.
    to_motion
        T: from the struts to translation and rotation, at small angles.
    joint
        The clearance of the gauges, which are the first two elastic coordinates then.
    """

    mass: FloatArray
    damping: FloatArray
    stiffness: FloatArray
    speed_m_s: float
    turn: FloatArray
    numbers: FloatArray
    to_motion: FloatArray
    radiation: Radiation
    elastic: Elastic
    joint: StrutJoint | None = None

    @property
    def elastic_count(self) -> int:
        """Number r of elastic coordinates."""
        return int(self.elastic.shape.shape[1])

    @property
    def states(self) -> int:
        """Number of states: 2 r and those of the memory."""
        return 2 * self.elastic_count + self.radiation.states

    @cached_property
    def incidence(self) -> FloatArray:
        """The velocity through the water that a displacement gives: U S T, shape ``(2, 2)``."""
        return self.speed_m_s * self.turn

    @cached_property
    def per_motion(self) -> FloatArray:
        """C, B and M side by side: force per (h, h', h''), shape ``(2, 6)``."""
        return np.hstack([self.stiffness, self.damping, self.mass])

    @cached_property
    def parts(self) -> tuple[FloatArray, FloatArray]:
        """The hull's numbers without its loads that have corners, and these alone.

        The second are two, without any loads and with those that have corners.
        """
        alone = (geometry_only(self.numbers), corners_only(self.numbers))
        return without_corners(self.numbers), np.stack(alone)

    @cached_property
    def memory_load(self) -> FloatArray:
        """W, shape ``(2, n)``."""
        return self.to_motion.T @ self.radiation.output_matrix

    @cached_property
    def _inertia(self) -> FloatArray:
        shape = self.elastic.shape
        return shape.T @ self.mass @ shape + self.elastic.mass

    @cached_property
    def state_matrix(self) -> FloatArray:
        """Rate of the states per state."""
        r, shape = self.elastic_count, self.elastic.shape
        into = self.radiation.input_matrix
        matrix = np.zeros((self.states, self.states))
        matrix[:r, r : 2 * r] = np.eye(r)
        pull = np.hstack(
            [
                shape.T @ self.stiffness @ shape + self.elastic.stiffness,
                shape.T @ self.damping @ shape + self.elastic.damping,
                shape.T @ self.memory_load,
            ]
        )
        matrix[r : 2 * r] = -np.linalg.solve(self._inertia, pull)
        matrix[2 * r :, :r] = self.radiation.passing_matrix @ self.incidence @ shape
        matrix[2 * r :, r : 2 * r] = into @ self.to_motion @ shape
        matrix[2 * r :, 2 * r :] = self.radiation.state_matrix
        return matrix

    @cached_property
    def motion_inputs(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """What y, y' and y'' add to the states' rate, shape ``(states, 2)`` each."""
        into = self.radiation.input_matrix
        nothing = np.zeros_like(into)
        return (
            self._driven(self.stiffness, self.radiation.passing_matrix @ self.incidence),
            self._driven(self.damping, into @ self.to_motion),
            self._driven(self.mass, nothing),
        )

    @cached_property
    def load_input(self) -> FloatArray:
        """What (f, g) add to the states' rate, or (f, g, c); shape ``(states, 4)`` or 6."""
        passing = self.radiation.passing_matrix
        force = self._driven(np.eye(2), np.zeros_like(passing))
        velocity = self._driven(np.zeros((2, 2)), passing)
        if self.joint is None:
            return np.hstack([force, velocity])
        r, given_back = self.elastic_count, np.zeros((self.states, 2))
        given_back[r : 2 * r] = np.linalg.inv(self._inertia)[:, :2]
        return np.hstack([force, velocity, given_back])

    def _driven(self, load: FloatArray, memory: FloatArray) -> FloatArray:
        r = self.elastic_count
        pushed = -np.linalg.solve(self._inertia, self.elastic.shape.T @ load)
        return np.vstack([np.zeros((r, 2)), pushed, memory])

    @cached_property
    def model_maps(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """What struts (six columns), states and loads (f, g, c) give the model.

        Eight columns each: h, h', h'' at both struts, and the force of the linear parts there.
        """
        r = self.elastic_count
        rows = slice(r, 2 * r)
        shape = self.elastic.shape.T
        states = np.zeros((self.states, 6))
        states[:r, :2] = shape
        states[rows, 2:4] = shape
        states[:, 4:] = self.state_matrix[rows].T @ shape
        loads = np.zeros((self.load_input.shape[1], 6))
        loads[:, 4:] = self.load_input[rows].T @ shape
        struts = np.eye(6)
        struts[:, 4:] += np.hstack(self.motion_inputs)[rows].T @ shape
        with_force = [
            np.hstack([rows, rows @ self.per_motion.T]) for rows in (struts, states, loads)
        ]
        with_force[1][2 * r :, 6:] += self.memory_load.T
        return with_force[0], with_force[1], with_force[2]

    def holds(self, step_s: float) -> tuple[Hold, Hold]:
        """Return the steps under the strut motion and under the loads (f, g)."""
        width = self.load_input.shape[1]
        loads = LinearSystem(
            self.state_matrix, self.load_input, np.eye(self.states), np.zeros((self.states, width))
        )
        return (
            hermite_hold(self.state_matrix, self.motion_inputs, step_s),
            causal_hold(loads, step_s, LOAD_DEGREE),
        )

    def at_rest(self, load: FloatArray) -> FloatArray:
        """Return the state in which the mounting just carries a load and the water is calm."""
        r, shape = self.elastic_count, self.elastic.shape
        state = np.zeros(self.states)
        carried = shape.T @ self.stiffness @ shape + self.elastic.stiffness
        state[:r] = -np.linalg.solve(carried, shape.T @ load)
        return state

    def impedance(self, s: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
        """Return force per motion h and per extra velocity g, each of shape ``(k, 2, 2)``."""
        column = s[:, np.newaxis, np.newaxis]
        rigid = self.mass * column**2 + self.damping * column + self.stiffness
        if not self.radiation.states:
            return rigid, np.zeros_like(rigid)
        water = self.radiation
        resolvent = column * np.eye(water.states) - water.state_matrix
        inputs = np.hstack([water.input_matrix, water.passing_matrix]).astype(complex)
        into = np.broadcast_to(inputs, (s.size, water.states, 4))
        moved, passed = np.split(self.memory_load @ np.linalg.solve(resolvent, into), 2, axis=2)
        return rigid + moved @ (self.to_motion * column) + passed @ self.incidence, passed

    def mounting_impedance(self, s: ComplexArray) -> ComplexArray:
        """Return M_e s^2 + C_e s + K_e, shape ``(k, r, r)``."""
        column = s[:, np.newaxis, np.newaxis]
        elastic = self.elastic
        impedance: ComplexArray = (
            elastic.mass * column**2 + elastic.damping * column + elastic.stiffness
        )
        return impedance


@lru_cache(maxsize=256)
def system_of(hull: ModelParameters) -> HullSystem:
    """Return the linear system of a model, kept."""
    to = np.array(
        [to_motion(a, f, hull.half_spacing_m, hull.plane) for a, f in ((1.0, 0.0), (0.0, 1.0))]
    ).T
    radiation = _NO_MEMORY if hull.radiation is None else hull.radiation
    added = np.array(hull.water.added_mass) + radiation.added_mass_infinite
    water_damping = np.array(hull.water.damping)
    restoring = np.array(hull.water.restoring)
    restoring[1, 1] += weight_less_buoyancy(hull)[2]
    turn = np.zeros((2, 2))
    turn[0] = -turns_with(hull.plane) * math.cos(hull.drift_rad) * to[1]
    incidence = hull.carriage_speed_m_s * turn
    mass = to.T @ (np.array(mass_matrix(hull.body, hull.plane)) + added) @ to
    damping = to.T @ (water_damping @ to + added @ incidence)
    stiffness = to.T @ (restoring @ to + water_damping @ incidence)
    return HullSystem(
        mass=mass,
        damping=damping,
        stiffness=stiffness,
        speed_m_s=hull.carriage_speed_m_s,
        turn=turn,
        numbers=numbers_of(hull, added, np.hstack([stiffness, damping, mass])),
        to_motion=to,
        radiation=radiation,
        elastic=hull.mounting.elastic,
        joint=hull.mounting.joint,
    )
