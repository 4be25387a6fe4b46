"""The forces on the model over one block of samples."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError
from sim.model.forces import Instants, ModelMotion, law_forces
from sim.model.law_point import Acting
from sim.model.law_table import has_number
from sim.model.model_march import Marching, course_of, march_model
from sim.model.numbers import geometry_only
from sim.model.system import LOAD_DEGREE, HullSystem
from sim.solve.compilation import follow
from sim.solve.linear_system import Hold
from sim.solve.relaxation import Tail, relax

if TYPE_CHECKING:
    from sim.model.march import Course


class HullState(NamedTuple):
    """State of the mounting and of the water's memory.

    Attributes
    ----------
    states
        (p, p', xi) at the last sample; ``None`` before the first.
    motion
        Displacements, velocities and accelerations of the struts at the last sample.
    loads
        The loads (f, g) of the last samples.
    roll
        Of a model that is free to roll (:func:`sim.model.roll_march.march_roll`).
    """

    states: tuple[float, ...] | None = None
    motion: tuple[float, ...] = ()
    loads: Tail = ()
    roll: tuple[float, ...] = ()


@dataclass(frozen=True, eq=False)
class BlockForces:
    """The forces over one block; arrays have one row a sample.

    Strut motion is (y, y', y''), aft and fore: six columns. Loads are (f, g): four columns. Forces
    are those of the struts, aft and fore, and the one along the model: three.
    ``marching`` solves for them sample by sample; without it they are swept over the block.
    """

    laws: tuple[Acting, ...]
    system: HullSystem
    instants: Instants
    marching: Marching | None = None

    def on_rigid_mounting(self, struts: FloatArray) -> FloatArray:
        """Return the forces where nothing is remembered: arithmetic on whole blocks."""
        linear = self._linear(struts)
        force = self._forces(self.laws, self.system.numbers, struts, linear)
        force[:, :2] += linear
        return force

    def all_forces(self, motion: FloatArray, at_struts: FloatArray) -> FloatArray:
        """Return all forces, for the model's motion and those at the struts."""
        along = self._forces(self.laws, self.system.numbers, motion, at_struts)[:, 2:]
        return np.hstack([at_struts, along])

    def with_memory(
        self, state: HullState, struts: FloatArray, holds: tuple[Hold, Hold]
    ) -> tuple[HullState, FloatArray]:
        """Return state and forces where mounting or water remember something."""
        by_motion, by_load = holds
        start = 0 if state.states is not None else 1
        if start:
            state = self.at_first_sample(struts)
        if self.marching is not None and self.acts_back:
            solved = self._marched(self.marching, state, struts, start)
            if solved is not None:
                return solved
        driven = by_motion.forcing(np.vstack([np.array(state.motion), struts[start:]]))
        history = np.array(state.loads)
        by_struts, by_states, by_loads = self.system.model_maps
        rigid = struts @ by_struts

        def under(loads: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
            forcing = driven + by_load.forcing(np.vstack([history[start:], loads]))
            states = np.empty((len(struts), self.system.states))
            states[:start] = state.states
            states[start:] = follow(by_motion.step, forcing, np.array(state.states))
            model = rigid + states @ by_states
            model += loads @ by_loads
            return states, model[:, :6], model[:, 6:]

        def respond(loads: FloatArray) -> FloatArray:
            return self._loads(*under(loads)[1:])

        loads = self._loads(struts, self._linear(struts))
        if not self.system.elastic_count:
            loads = respond(loads)  # with the memory's part of what the linear parts ask
        elif loads.any():
            loads = relax(respond, loads, "hull", self.scale(struts))
        states, motion, linear = under(loads)
        tail = np.vstack([history[start:], loads])[-LOAD_DEGREE:]
        after = HullState(_value(states[-1]), _value(struts[-1]), tuple(map(_value, tail)))
        return after, self.all_forces(motion, linear + loads[:, :2])

    @property
    def acts_back(self) -> bool:
        """Whether loads depend on what they do: on how the mounting gives way to them."""
        return self.system.elastic_count > 0

    @property
    def _extra(self) -> FloatArray:
        return self.instants.speed_m_s - self.system.speed_m_s

    def _marched(
        self, marching: Marching, state: HullState, struts: FloatArray, start: int
    ) -> tuple[HullState, FloatArray] | None:
        """Solve sample by sample; laws that the march does not know are swept around it."""
        course = self.course(state, struts, start)
        rest = tuple(acting for acting in self.laws if not has_number(acting.law))
        alone = geometry_only(self.system.numbers)
        outputs = march_model(marching, course)

        def respond(loads: FloatArray) -> FloatArray:
            nonlocal outputs
            course.external_loads[:, :2] = loads
            outputs = march_model(marching, course)
            return loads if outputs is None else swept(outputs)

        def swept(feedback: FloatArray) -> FloatArray:
            return self._forces(rest, alone, feedback[:, :6], feedback[:, 6:8])[:, :2]

        if rest and outputs is not None:
            relax(respond, swept(outputs), "hull", self.scale(struts)[:2])
        if outputs is None:
            self._check_unsettled()
            return None
        force = outputs[:, 6:8] + course.loads[LOAD_DEGREE:, :2]
        return marched_state(course), self.all_forces(outputs[:, :6], force)

    def _check_unsettled(self) -> None:
        """Refuse a clearance that the march could not solve: sweeps cannot either."""
        if self.system.joint is not None:
            raise ConfigurationError(
                "hull: what meets in the gauges' clearance is too stiff for the sample rate; "
                "sample faster, or make the gauges softer"
            )

    def _forces(
        self,
        laws: tuple[Acting, ...],
        numbers: FloatArray,
        motion: FloatArray,
        linear: FloatArray,
    ) -> FloatArray:
        at_struts = ModelMotion(motion[:, :2], motion[:, 2:4], motion[:, 4:], linear)
        return law_forces(laws, numbers, self.system, at_struts, self.instants)

    def course(self, state: HullState, struts: FloatArray, start: int) -> "Course":
        """Return what a march over the block starts from and is given."""
        instants = self.instants
        joined, history = np.vstack([np.array(state.motion), struts]), np.array(state.loads)
        flow = self._extra.any() or history[:, 2:].any()
        loads = history.shape[1] if flow or self.system.joint is not None else 2
        course = course_of(
            joined,
            self.system.states,
            loads,
            instants.time_s,
            instants.step_s,
            self.scale(struts),
        )
        # Of the states before the block only the last counts; a first sample has its own.
        course.states[LOAD_DEGREE - 1 + start] = state.states
        course.loads[:LOAD_DEGREE] = history[:, :loads]
        course.instants[:, 1] = self._extra
        course.instants[:, 2] = instants.speed_m_s
        return course._replace(is_start_known=start)

    def at_first_sample(self, struts: FloatArray) -> HullState:
        """Return the state at a run's first sample: mounting and water at rest under the load."""
        first = BlockForces(
            self.laws,
            self.system,
            self.instants._replace(
                time_s=self.instants.time_s[:1], speed_m_s=self.instants.speed_m_s[:1]
            ),
        )
        linear = first._linear(struts[:1])
        loads = first._loads(struts[:1], linear)
        at_rest = self.system.at_rest((linear + loads[:, :2])[0])
        given_back = () if self.system.joint is None else (0.0, 0.0)
        last = (*_value(loads[0]), *given_back)
        return HullState(_value(at_rest), _value(struts[0]), (last,) * LOAD_DEGREE)

    def _linear(self, motion: FloatArray) -> FloatArray:
        """Return the force of the linear parts for the model's motion, without the memory."""
        return motion @ self.system.per_motion.T

    def _loads(self, motion: FloatArray, linear: FloatArray) -> FloatArray:
        """Return what is no part of the linear system, at this motion of the model."""
        loads = np.zeros((len(motion), 4))
        loads[:, :2] = self._forces(self.laws, self.system.numbers, motion, linear)[:, :2]
        extra = self._extra
        if extra.any():
            loads[:, 2:] = extra[:, np.newaxis] * (motion[:, :2] @ self.system.turn.T)
        return loads

    def scale(self, struts: FloatArray) -> FloatArray:
        """Return what a change of the loads counts relative to."""
        force = (np.abs(struts) @ np.abs(self.system.per_motion.T)).max()
        extra = np.abs(self._extra).max()
        velocity = extra * np.abs(self.system.turn).max() * np.abs(struts[:, :2]).max()
        return np.array([force, force, velocity, velocity])


def marched_state(course: "Course") -> HullState:
    """Return the state after a march."""
    last = course.loads[-LOAD_DEGREE:]
    rest = (0.0,) * (4 - last.shape[1])
    tail = tuple((*_value(row), *rest) for row in last)
    return HullState(_value(course.states[-1]), _value(course.struts[-1]), tail)


def _value(row: FloatArray) -> tuple[float, ...]:
    return tuple(row.tolist())
