"""The forces on the model over one block of samples."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from sim.acting import Acting
from sim.compiled import follow
from sim.hull_forces import CrossFlow, Instants, ModelMotion, law_forces
from sim.hull_system import LOAD_DEGREE, HullSystem
from sim.linear import Hold
from sim.relaxation import Tail, relax
from sim.signals import FloatArray


class HullState(NamedTuple):
    """What the mounting and the water remember.

    Attributes
    ----------
    states
        (p, p', xi) at the last sample; ``None`` before the first.
    motion
        Displacements, velocities and accelerations of the struts at the last sample.
    loads
        The loads (f, g) of the last samples.
    """

    states: tuple[float, ...] | None = None
    motion: tuple[float, ...] = ()
    loads: Tail = ()


@dataclass(frozen=True, eq=False)
class BlockForces:
    """The forces over one block; arrays have one row a sample.

    Strut motion is (y, y', y''), aft and fore: six columns. Loads are (f, g): four columns.
    """

    laws: tuple[Acting, ...]
    cross_flow: CrossFlow | None
    system: HullSystem
    instants: Instants

    def on_rigid_mounting(self, struts: FloatArray) -> FloatArray:
        """Return the forces where nothing is remembered: arithmetic on whole blocks."""
        linear = self._linear(struts)
        return linear + self._loads(struts, linear)[:, :2]

    def with_memory(
        self, state: HullState, struts: FloatArray, holds: tuple[Hold, Hold]
    ) -> tuple[HullState, FloatArray]:
        """Return state and forces where mounting or water remember something."""
        by_motion, by_load = holds
        known = 0 if state.states is not None else 1
        if known:
            state = self._at_first_sample(struts)
        driven = by_motion.forcing(np.vstack([np.array(state.motion), struts[known:]]))
        history = np.array(state.loads)
        by_struts, by_states, by_loads = self.system.model_maps
        rigid = struts @ by_struts

        def under(loads: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
            forcing = driven + by_load.forcing(np.vstack([history, loads[known:]]))
            states = np.empty((len(struts), self.system.states))
            states[:known] = state.states
            states[known:] = follow(by_motion.step, forcing, np.array(state.states))
            model = rigid + states @ by_states
            model += loads @ by_loads
            return states, model[:, :6], model[:, 6:]

        def respond(loads: FloatArray) -> FloatArray:
            return self._loads(*under(loads)[1:])

        loads = self._loads(struts, self._linear(struts))
        if self.system.elastic_count and loads.any():
            loads = relax(respond, loads, "hull", self._scale(struts))
        states, _, linear = under(loads)
        tail = np.vstack([history, loads[known:]])[-LOAD_DEGREE:]
        after = HullState(_value(states[-1]), _value(struts[-1]), tuple(map(_value, tail)))
        return after, linear + loads[:, :2]

    def _at_first_sample(self, struts: FloatArray) -> HullState:
        first = BlockForces(
            self.laws,
            self.cross_flow,
            self.system,
            self.instants._replace(
                time_s=self.instants.time_s[:1], speed_m_s=self.instants.speed_m_s[:1]
            ),
        )
        linear = first._linear(struts[:1])
        loads = first._loads(struts[:1], linear)
        at_rest = self.system.at_rest((linear + loads[:, :2])[0])
        return HullState(_value(at_rest), _value(struts[0]), (_value(loads[0]),) * LOAD_DEGREE)

    def _linear(self, motion: FloatArray) -> FloatArray:
        """Return the force of the linear parts for the model's motion, without the memory."""
        return motion @ self.system.per_motion.T

    def _loads(self, motion: FloatArray, linear: FloatArray) -> FloatArray:
        """Return what is no part of the linear system, at this motion of the model."""
        loads = np.zeros((len(motion), 4))
        position, velocity, acceleration = motion[:, :2], motion[:, 2:4], motion[:, 4:]
        if self.laws or self.cross_flow is not None:
            at_struts = ModelMotion(position, velocity, acceleration, linear)
            loads[:, :2] = law_forces(
                self.laws, self.cross_flow, self.system, at_struts, self.instants
            )
        extra = self.instants.speed_m_s - self.system.speed_m_s
        if extra.any():
            by_position, by_velocity = self.system.speed_loads
            added = position @ by_position.T + velocity @ by_velocity.T
            loads[:, :2] += extra[:, np.newaxis] * added
            loads[:, 2:] = extra[:, np.newaxis] * (position @ self.system.turn.T)
        return loads

    def _scale(self, struts: FloatArray) -> FloatArray:
        """Return what a change of the loads counts relative to."""
        force = (np.abs(struts) @ np.abs(self.system.per_motion.T)).max()
        extra = np.abs(self.instants.speed_m_s - self.system.speed_m_s).max()
        velocity = extra * np.abs(self.system.turn).max() * np.abs(struts[:, :2]).max()
        return np.array([force, force, velocity, velocity])


def _value(row: FloatArray) -> tuple[float, ...]:
    return tuple(row.tolist())
