"""Drive, mechanism and model made ready for the compiled march (:mod:`sim.model.march`)."""

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Final

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError
from sim import signals
from sim.drive.loaded_drive import Unladen
from sim.drive.prescribed_drive import SHAFT, ShaftMotion
from sim.drive.shaft_system import TORQUE_DEGREE, MarchedShaft, ShaftSystem
from sim.mechanism.linkage import Mechanism
from sim.model.block_forces import HullState, marched_state
from sim.model.hull import Hull
from sim.model.law_table import has_number
from sim.model.model_march import OUTPUTS, Marching, marching_of
from sim.signals import Signals
from sim.solve.linear_system import LinearSystem, causal_hold
from sim.stage import Block, Stage

if TYPE_CHECKING:
    from typing import Any

    from sim.model.march import Course


_LEAST_N_M: Final = 1e-3  # a torque that turns no shaft as far as it is seen


@dataclass(frozen=True, eq=False)
class CoupledMarch:
    """Drive, mechanism and model over one block, from the states before it."""

    shaft: ShaftSystem
    mechanism: Mechanism
    hull: Hull
    model: Marching
    block: Block
    flow_m_s: FloatArray

    def run(
        self,
        states: tuple[float, ...] | None,
        torques: tuple[tuple[float, ...], ...],
        hull_state: HullState,
        unladen: Unladen,
    ) -> "tuple[MarchedShaft, Course, HullState, dict[str, FloatArray]] | None":
        """Return what the march has come to; ``None`` if a sample does not settle.

        Parameters
        ----------
        states, torques
            Of the shaft: its state, and the torques of the last samples; ``None`` and nothing
            before a run's first sample, in which nothing deviates yet.
        unladen
            The shaft without its struts.

        Raises
        ------
        ConfigurationError
            If the sample is one of a gear with backlash: sweeps cannot solve it either.
        """
        from sim.mechanism.compiled_linkage import linkages_of
        from sim.model.march import march

        shaft_motion = unladen.motion
        start = 1 if states is None else 0
        course = self._course(shaft_motion, hull_state, start)
        shaft = self._shaft_loop(unladen)
        if states is not None:
            shaft.states[TORQUE_DEGREE - 1] = states
            shaft.torques[:TORQUE_DEGREE] = torques
        has_joint = self.hull.mounting.joint is not None
        outputs = np.empty((self.block.count, OUTPUTS if has_joint else OUTPUTS - 2))
        links = linkages_of(self.mechanism)
        bad = march(self.model.model, self.model.table, course, shaft, links, outputs)
        if bad >= 0:
            self._check_unsettled(float(self.block.time_s[bad]))
            return None
        after = marched_state(course) if self.hull.system.states else hull_state
        force = self.hull.forces_over(self.block, self.flow_m_s).all_forces(
            outputs[:, :6], outputs[:, 6:8] + course.loads[TORQUE_DEGREE:, :2]
        )
        return shaft, course, after, self._signals(shaft.motion, course.struts[1:], force)

    def _check_unsettled(self, time_s: float) -> None:
        gear = self.shaft.settings.gear
        if gear is not None:
            raise ConfigurationError(
                f"drive: at {time_s:.4g} s the gear's teeth strike so hard that the sample has no "
                f"solution, with stiffness_n_m_rad = {gear.stiffness_n_m_rad:g} and "
                f"damping_n_m_s_rad = {gear.damping_n_m_s_rad:g}; make the teeth softer, or else "
                f"try another sample rate"
            )

    def _course(self, shaft_motion: ShaftMotion, state: HullState, start: int) -> "Course":
        struts = self._struts(shaft_motion)
        forces = self.hull.forces_over(self.block, self.flow_m_s)
        if not self.hull.system.states:  # a model that remembers nothing
            state = HullState((), (0.0,) * 6, ((0.0,) * 4,) * TORQUE_DEGREE)
        elif state.states is None:
            state = forces.at_first_sample(struts)
        course = forces.course(state, struts, start)
        reach = np.hypot(struts[:, :2], self._levers(shaft_motion)).max()
        # At no eccentricity nothing has an arm: the torque's rounding then.
        torque = max(2.0 * course.scale[0] * reach, _LEAST_N_M)
        more = np.full(len(self.shaft.system.B.T), torque)
        return course._replace(scale=np.concatenate([course.scale, more]))

    def _struts(self, shaft_motion: ShaftMotion) -> FloatArray:
        _, motion = self.mechanism.run(None, self.block, shaft_motion.signals)
        return np.column_stack([motion[signal.name] for signal in self.hull.reads[:6]])

    def _levers(self, shaft_motion: ShaftMotion) -> FloatArray:
        _, motion = self.mechanism.run(None, self.block, shaft_motion.signals)
        return np.column_stack([motion["lever_aft"], motion["lever_fore"]])

    def _shaft_loop(self, unladen: Unladen) -> MarchedShaft:
        shaft, count = self.shaft, self.block.count
        hold = _hold(shaft.system, 1.0 / self.block.sample_rate_hz)
        n, inputs = shaft.system.B.shape
        to_outputs = np.zeros((n, 4))
        to_outputs[:, : len(shaft.system.C)] = shaft.system.C.T
        by_torque = np.zeros((inputs, 4))
        by_torque[:, : len(shaft.system.D)] = shaft.system.D.T
        at_once = by_torque + 0.0
        by_torque += hold[1][-1].T @ to_outputs
        return MarchedShaft(
            True,
            hold[0],
            hold[1],
            to_outputs,
            by_torque,
            at_once,
            np.column_stack([*unladen.motion, unladen.opening]),
            np.zeros((count + TORQUE_DEGREE, n)),
            np.zeros((count + TORQUE_DEGREE, inputs)),
            np.empty((count, 5)),
            np.array([shaft.reflected_inertia_kg_m2, *shaft.friction[::-1], *shaft.lifted_n]),
            np.array(shaft.cogging, dtype=np.float64).reshape(-1, 3),
            np.array([*shaft.gap, 0.0]),
        )

    def _signals(
        self, motion: FloatArray, struts: FloatArray, force: FloatArray
    ) -> dict[str, FloatArray]:
        names = [signal.name for signal in (*SHAFT, signals.LEVER_AFT, signals.LEVER_FORE)]
        names += [signal.name for signal in (*self.hull.reads[:6], *self.hull.writes)]
        columns = np.hstack([motion, struts, force])
        return dict(zip(names, np.ascontiguousarray(columns.T), strict=True))


def coupled_march(
    shaft: ShaftSystem, parts: "tuple[Stage[Any], ...]", block: Block, inputs: Signals
) -> CoupledMarch | None:
    """Return the march over a block; ``None`` where only sweeps can do it.

    That is without numba, with a law that has no number, with play that friction holds, with a part
    that is another than the usual, or with a signal substituted between the parts.
    """
    mechanism, hull = parts
    if not (type(mechanism) is Mechanism and type(hull) is Hull):
        return None
    play = mechanism.aft.half_play_m or mechanism.fore.half_play_m
    numbered = all(has_number(acting.law) for acting in hull.laws)
    if play or not numbered or inputs.keys() != {signals.CARRIAGE_SPEED.name}:
        return None
    model = marching_of(hull.laws, hull.system, 1.0 / block.sample_rate_hz, shaft.gap[1] > 0.0)
    if model is None:
        return None
    flow = hull.flow_factor * inputs[signals.CARRIAGE_SPEED.name]
    return CoupledMarch(shaft, mechanism, hull, model, block, flow)


@lru_cache(maxsize=64)
def _hold(system: LinearSystem, step_s: float) -> tuple[FloatArray, FloatArray]:
    hold = causal_hold(system, step_s, TORQUE_DEGREE)
    return np.array(hold.step), np.array(hold.weights)
