"""Model, water and mounting: from the motion of the struts to the forces that they exert."""

from dataclasses import dataclass, fields, replace
from functools import cached_property, lru_cache, partial
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from hardware.description.arrays import FloatArray
from sim import signals
from sim.mechanism.geometry import BodyMotion, gauge_readings
from sim.model.block_forces import BlockForces, HullState
from sim.model.forces import Instants
from sim.model.heel import Heeling
from sim.model.hull_steady_state import HullSteady
from sim.model.model_march import Marching, marching_of
from sim.model.numbers import moving, surging_readings, turns_with
from sim.model.parameters import HullCoefficients, ModelParameters
from sim.model.steering_loads import steering_loads
from sim.model.system import HullSystem, system_of
from sim.model.waves import MetWaves
from sim.signals import Signal, Signals
from sim.solve.linear_system import Hold
from sim.solve.period import Period, Spectra
from sim.solve.recurrence import fine_enough, last_period
from sim.solve.relaxation import LONGEST_SWEEP
from sim.stage import Block

__all__ = ["Hull", "HullCoefficients"]

_FIELDS = tuple(field.name for field in fields(ModelParameters))
_FORCES = (signals.FORCE_AFT, signals.FORCE_FORE, signals.FORCE_X)
_HEELING = (signals.ROLL_MOMENT, signals.HEEL_ANGLE)
ValueT = TypeVar("ValueT", np.float64, np.complex128)


@dataclass(frozen=True)
class Hull(ModelParameters):
    """A rigid model in water, or in air where the water has no coefficients, on its mounting.

    The struts' motion moves the model exactly (:mod:`sim.mechanism.geometry`), whatever its angle:
    with its velocities u, v and r through the water in body axes, what the gauges read balances

        inertia + A (v', r') + B (v, r) + C (place, angle) + cross-flow - X + weight + mu + laws

    with the memory mu of the water, which is linear in the struts' motion, about the mean speed.
    What gauges read at rest where the drift is set, weight among it, is left out: they are tared
    with the model in place. The carriage's acceleration counts within u' and v' where it is told,
    for inertia and added mass; not for the memory and the laws.

    For the mounting and between samples the slopes of all this at small angles are a linear system
    (:mod:`sim.model.system`), solved exactly; what there is beyond them, and the laws, are solved
    sample by sample, or by sweeps over the block until nothing changes any more. On a rigid
    mounting the model moves as the struts do. Else gauges and frame give way, and model, water and
    mounting are solved together.
    """

    name = "hull"

    @cached_property
    def _hash(self) -> int:
        return hash(tuple(getattr(self, name) for name in _FIELDS))

    def __hash__(self) -> int:
        """Return the hash of all fields, found once: a diagnosis asks for it thousands of times."""
        return self._hash

    @property
    def reads(self) -> tuple[Signal, ...]:
        """Motion of the struts' ends, and the carriage's acceleration where the model surges."""
        gain = (signals.CARRIAGE_ACCELERATION,) if self.surges else ()
        return (*signals.MODEL_MOTION, *gain)

    @property
    def writes(self) -> tuple[Signal, ...]:
        """The struts' forces, that along the model, what propeller and rudder write, and roll."""
        steering = () if self.steering is None else self.steering.writes
        probe = () if self.waves is None else (signals.WAVE_PROBE,)
        return (*_FORCES, *steering, *(() if self.heeling is None else _HEELING), *probe)

    @property
    def system(self) -> HullSystem:
        """The linear part at the mean carriage speed."""
        return system_of(self)

    def start(self, sample_rate_hz: float, seed: int) -> HullState:
        """Return the state before the first sample: calm water, a mounting that is at rest."""
        return HullState()

    def run(self, state: HullState, block: Block, inputs: Signals) -> tuple[HullState, Signals]:
        """Return the force of each strut on the model over the block."""
        if not block.count:
            return state, {signal.name: np.empty(0) for signal in self.writes}
        columns = [inputs[signal.name] for signal in self.reads[:6]]
        struts = np.column_stack(columns)
        flow = self.flow_factor * inputs[signals.CARRIAGE_SPEED.name]
        instants = Instants(block.time_s, 1.0 / block.sample_rate_hz, flow)
        rolled = state.roll
        if not self.system.states:
            force = self._block_forces(instants).on_rigid_mounting(struts)
        else:
            state, force = self._with_memory(state, struts, instants)
        rows = np.ascontiguousarray(force.T)
        if self.steering is not None:
            steering_rows = steering_loads(self.steering, self.system.numbers, struts, flow)
            steering_rows[:3] += rows
            rows = steering_rows
        if self.heeling is not None:
            at = moving(self.system.numbers, struts, flow)
            roll, rolled = self.heeling.rolling(at, rolled, instants.step_s)
            rows = self._heeled(self.heeling, rows, at, roll)
            state = state._replace(roll=rolled)
        if self.surges and (gain := inputs[signals.CARRIAGE_ACCELERATION.name]).any():
            rows[:3] += surging_readings(self.system.numbers, struts, flow, gain)
        if self.waves is not None:
            rows = self._in_waves(self.waves, rows, struts, flow, block.time_s)
        return state, self._by_signal(rows)

    def _in_waves(
        self,
        waves: MetWaves,
        rows: FloatArray,
        struts: FloatArray,
        flow_m_s: FloatArray,
        time_s: FloatArray,
    ) -> FloatArray:
        """Return the rows with what the waves' loads ask of the struts, and the probe behind."""
        at = moving(self.system.numbers, struts, flow_m_s)
        loads, elevation = waves.at_instants(time_s, self.carriage_speed_m_s / self.flow_factor)
        loads[2] *= turns_with(self.plane)
        held = gauge_readings(self.system.numbers, at.cosine, at.sine, *-loads)
        rows[:3] += np.stack(held)
        return np.concatenate((rows, elevation[np.newaxis]))

    def _heeled(
        self, heeling: Heeling, rows: FloatArray, at: BodyMotion, roll: FloatArray
    ) -> FloatArray:
        """Return the rows with what heel adds, and its own two behind them."""
        heel_rows = heeling.readings(self.system.numbers, at, roll)
        rows = np.concatenate((rows, heel_rows[3:]))
        rows[:3] += heel_rows[:3]
        rows[:2] *= heeling.on_gauges(roll[0])
        return rows

    def _by_signal(self, rows: NDArray[ValueT]) -> dict[str, NDArray[ValueT]]:
        return {signal.name: row for signal, row in zip(self.writes, rows, strict=True)}

    def as_of(self, time_s: FloatArray, step_s: float) -> "tuple[Hull, int]":
        """Return the model in the water at the first sample, and for how many samples it stays so.

        What the water has no input for yet (:attr:`Radiation.onset_s`) has one from the first step
        that begins after the onset.
        """
        if self.radiation is None or not self.radiation.onset_s.any():
            return self, len(time_s)
        begun = time_s - step_s
        later = self.radiation.onset_s[self.radiation.onset_s > begun[0]]
        radiation = self.radiation.at(float(begun[0]))
        hull = self if radiation is self.radiation else replace(self, radiation=radiation)
        return hull, int(np.searchsorted(begun, later.min(initial=np.inf)))

    @property
    def repeating(self) -> "Hull":
        """The model as it is long after the start, with the laws that repeat."""
        laws = tuple(acting for acting in self.laws if acting.law.periodic)
        radiation = self.radiation
        if radiation is not None:
            radiation = replace(radiation, onset_s=np.zeros(radiation.states))
        return replace(self, laws=laws, radiation=radiation)

    def forces_over(self, block: Block, flow_m_s: FloatArray) -> BlockForces:
        """Return the forces over a block, at the flow's speed at each sample."""
        return self._block_forces(Instants(block.time_s, 1.0 / block.sample_rate_hz, flow_m_s))

    def _block_forces(self, instants: Instants, marching: Marching | None = None) -> BlockForces:
        return BlockForces(self.laws, self.system, instants, marching)

    def _with_memory(
        self, state: HullState, struts: FloatArray, instants: Instants
    ) -> tuple[HullState, FloatArray]:
        """Go on in stretches that fit the fastest memory, and one thread of the matrix products."""
        step_s = instants.step_s
        forces: list[FloatArray] = []
        first = 0
        while first < len(struts):
            hull, count = self.as_of(instants.time_s[first : first + LONGEST_SWEEP], step_s)
            part = slice(first, first + count)
            part_instants = instants._replace(
                time_s=instants.time_s[part], speed_m_s=instants.speed_m_s[part]
            )
            forces_here = hull._block_forces(
                part_instants, marching_of(hull.laws, hull.system, step_s)
            )
            state, force = forces_here.with_memory(state, struts[part], _holds(hull, step_s))
            forces.append(force)
            first += count
        return state, np.concatenate(forces)

    def steady(self, period: Period, inputs: Spectra) -> tuple[Period, Spectra]:
        """Return the harmonics of the forces: exact, the laws by harmonic balance.

        Where the gauges have a clearance the forces are run on until they repeat.
        """
        hull = self.at_speed(inputs)
        if self.mounting.joint is not None:
            return period, hull._settled(period, inputs)
        y = np.stack([inputs[signal.name] for signal in self.reads[:2]], axis=1)
        rows = _hull_steady(hull, period).balanced(y).T
        if self.waves is not None:  # of a frequency of their own: no part of the period
            calm_hull = replace(hull, waves=None)
            _, calm = calm_hull.steady(period, inputs)
            return period, {**calm, signals.WAVE_PROBE.name: period.constant(0.0)}
        if self.steering is None and self.heeling is None:
            return period, self._by_signal(rows)
        struts = np.stack([period.values(inputs[signal.name]) for signal in self.reads[:6]], axis=1)
        flow = np.full(period.points, hull.carriage_speed_m_s)
        if self.steering is not None:
            behind = steering_loads(self.steering, self.system.numbers, struts, flow)
            added = period.harmonics(behind.T).T
            added[:3] += rows
            rows = added
        if self.heeling is not None:
            at = moving(self.system.numbers, struts, flow)
            roll = self.heeling.settled(at, period)
            values = self._heeled(self.heeling, period.values(rows.T).T, at, roll)
            rows = period.harmonics(values.T).T
        return period, self._by_signal(rows)

    def at_speed(self, inputs: Spectra) -> "Hull":
        """Return the model at the carriage's mean speed."""
        speed = self.flow_factor * float(inputs[signals.CARRIAGE_SPEED.name][0].real)
        return self if speed == self.carriage_speed_m_s else replace(self, carriage_speed_m_s=speed)

    def _settled(self, period: Period, inputs: Spectra) -> Spectra:
        """Return the harmonics of the forces after as many periods as it takes."""
        hull, fine = self.repeating, fine_enough(period, self.system.state_matrix)
        samples = {signal.name: fine.values(inputs[signal.name]) for signal in self.reads}

        def run(state: HullState, turn: int) -> tuple[HullState, Signals]:
            rate_hz = fine.points * fine.frequency_hz
            return hull.run(state, Block(turn * fine.points, fine.points, rate_hz), samples)

        names = tuple(signal.name for signal in self.writes)
        settled = partial(_settled_memory, self.system, 1.0 / fine.frequency_hz)
        period_of_signals = last_period(run, HullState(), names, settled)
        return {name: fine.harmonics(period_of_signals[name]) for name in names}


@lru_cache(maxsize=256)
def _hull_steady(hull: Hull, period: Period) -> HullSteady:
    """Return the model over a period, kept: a rig's motion changes more often than its model."""
    return HullSteady(hull.laws, hull.system, hull.carriage_speed_m_s, period)


@lru_cache(maxsize=64)
def _holds(hull: Hull, step_s: float) -> tuple[Hold, Hold]:
    return hull.system.holds(step_s)


def _settled_memory(
    system: HullSystem, period_s: float, before: HullState, after: HullState
) -> HullState:
    """Return the state after a period with the memory that the same motion would lead to at last.

    The memory x of the water is linear and no part of what meets in a clearance: over a period of
    the same motion x goes to M x + c, so that what is left at last is x + (1 - M)^-1 (M x + c - x).
    """
    memory, first = system.radiation.states, 2 * system.elastic_count
    if before.states is None or after.states is None or not memory:
        return after
    from scipy.linalg import expm

    began, ended = np.array(before.states), np.array(after.states)
    loss = np.eye(memory) - expm(system.radiation.state_matrix * period_s)
    ended[first:] = began[first:] + np.linalg.solve(loss, (ended - began)[first:])
    return after._replace(states=tuple(ended.tolist()))
