"""Drive, mechanism and model in one stage: a drive that feels the load of the struts.

The three parts are the same as in an open chain. The drive's linear part answers exactly to the
load torque between samples; torque, motion and forces are then swept over the block until they fit
each other (:mod:`sim.relaxation`), so that any part, changed by whatever effect, can be inside.
"""

import math
from dataclasses import dataclass, replace
from typing import Any, ClassVar, NamedTuple

import numpy as np

from hardware.description.setpoint import SetPoint
from sim import signals
from sim.coupled_march import TORQUE_DEGREE, ShaftSystem, coupled_march
from sim.drive import SHAFT, DriveSettings, Shaft, shaft_over
from sim.linear import ComplexArray, Hold, causal_hold
from sim.motor import Motor, closed_loop, droop
from sim.period import Period, Spectra
from sim.relaxation import LONGEST_SWEEP, Tail, relax
from sim.sampled import steady_of
from sim.signals import FloatArray, Signal, Signals
from sim.stage import Block, Stage


class LoadedState(NamedTuple):
    """Deviation of angle, speed and current; ``None`` before the first sample; last torques."""

    states: tuple[float, ...] | None = None
    torques: Tail = ()


@dataclass(frozen=True)
class LoadedDrive:
    """A motor that gives way to the load torque.

    Attributes
    ----------
    reflected_inertia_kg_m2
        Mean inertia that the model adds at the shaft. It is solved as part of the motor; its torque
        is then no part of the load that is handed in. Any value gives the same motion; the true one
        gives it with the fewest sweeps.
    """

    frequency_hz: float
    settings: DriveSettings
    motor: Motor
    reflected_inertia_kg_m2: float = 0.0

    name: ClassVar[str] = "drive"
    reads: ClassVar[tuple[Signal, ...]] = (signals.LOAD_TORQUE,)
    writes: ClassVar[tuple[Signal, ...]] = SHAFT

    def start(self, sample_rate_hz: float, seed: int) -> LoadedState:
        """Return the state before the first sample: no deviation yet."""
        return LoadedState()

    def run(self, state: LoadedState, block: Block, inputs: Signals) -> tuple[LoadedState, Signals]:
        """Return the shaft's motion under a load torque (less the reflected inertia's)."""
        told = self.settings.commanded(self.frequency_hz, block.time_s)
        inertia = self.motor.shaft_inertia_kg_m2 + self.reflected_inertia_kg_m2
        torque = inputs[signals.LOAD_TORQUE.name] + inertia * told.acceleration
        system = closed_loop(self.motor, self.reflected_inertia_kg_m2)
        hold = self._hold(block.sample_rate_hz)
        known = 0 if state.states is not None else 1
        if known:
            zero = (0.0,) * len(system.A)
            state = LoadedState(zero, ((float(torque[0]),),) * TORQUE_DEGREE)
        joined = np.concatenate([np.array(state.torques)[:, 0], torque[known:]])[:, np.newaxis]
        states = np.empty((block.count, len(system.A)))
        states[:known] = state.states
        states[known:] = hold.run(np.array(state.states), joined)
        deviation = states @ system.C.T + torque[:, np.newaxis] @ system.D.T
        shaft = Shaft(*(given + more for given, more in zip(told, deviation.T, strict=True)))
        tail = tuple((value,) for value in joined[-TORQUE_DEGREE:, 0].tolist())
        return LoadedState(tuple(states[-1].tolist()), tail), shaft.signals

    def steady(self, period: Period, inputs: Spectra) -> tuple[Period, Spectra]:
        """Return the period that the shaft really has under the load, and its harmonics."""
        torque = inputs[signals.LOAD_TORQUE.name]
        free_hz = self.settings.frequency_hz(self.frequency_hz)
        slower = droop(self.motor) * float(torque[0].real) / (2.0 * math.pi)
        real = period.at(free_hz + slower)
        told = self.settings.ripple_over(real)
        inertia = self.motor.shaft_inertia_kg_m2 + self.reflected_inertia_kg_m2
        whole = torque + inertia * told[signals.SHAFT_ACCELERATION.name]
        system = closed_loop(self.motor, self.reflected_inertia_kg_m2)
        beyond = told[signals.SHAFT_ANGLE.name].copy()
        beyond[1:] += system.response(real.s[1:])[:, 0, 0] * whole[1:]
        return real, shaft_over(real, beyond)

    @property
    def shaft(self) -> ShaftSystem:
        """What the march of drive and model needs of this drive."""
        motor, inertia = self.motor, self.reflected_inertia_kg_m2
        both = (motor.guides, self.settings.guides)
        return ShaftSystem(
            self.settings,
            self.frequency_hz,
            closed_loop(motor, inertia),
            motor.shaft_inertia_kg_m2,
            inertia,
            (sum(one.coulomb_n for one in both), sum(one.viscous_n_s_m for one in both)),
            tuple((float(one.order), one.torque_n_m, one.phase_rad) for one in motor.cogging),
            (0.0, 0.0, 0.0),
        )

    def _hold(self, sample_rate_hz: float) -> Hold:
        system = closed_loop(self.motor, self.reflected_inertia_kg_m2)
        return causal_hold(system, 1.0 / sample_rate_hz, TORQUE_DEGREE)


@dataclass(frozen=True)
class Coupled:
    """A drive that feels its load, with the mechanism and the model that are the load.

    A substituted shaft motion, strut motion or force takes the place of what the part gives, inside
    too: everything behind it is fed with it.
    """

    drive: LoadedDrive
    mechanism: Stage[Any]
    hull: Stage[Any]

    name: ClassVar[str] = "drive"
    reads: ClassVar[tuple[Signal, ...]] = (signals.CARRIAGE_SPEED,)

    @property
    def parts(self) -> tuple[Stage[Any], ...]:
        """What is solved together, in the order of an open chain."""
        return (self.mechanism, self.hull)

    def with_part(self, name: str, part: Stage[Any]) -> "Coupled":
        """Return the stage with one part changed."""
        changed: dict[str, Any] = {name: part}
        return replace(self, **changed)

    @property
    def writes(self) -> tuple[Signal, ...]:
        """All that the three parts write, and the load torque."""
        inner = tuple(signal for part in self.parts for signal in part.writes)
        return (*SHAFT, *inner, signals.LOAD_TORQUE)

    def start(self, sample_rate_hz: float, seed: int) -> tuple[Any, Any, Any]:
        """Return the states of the three parts."""
        return (
            self.drive.start(sample_rate_hz, seed),
            self.mechanism.start(sample_rate_hz, seed),
            self.hull.start(sample_rate_hz, seed),
        )

    def run(
        self, state: tuple[Any, Any, Any], block: Block, inputs: Signals
    ) -> tuple[tuple[Any, Any, Any], Signals]:
        """Return states and signals over the block, swept in stretches."""
        written: list[Signals] = []
        first = 0
        while first < block.count:
            # A run's first sample has no state to march from.
            most = 1 if state[0].states is None else LONGEST_SWEEP
            count = min(most, block.count - first)
            part = Block(block.first + first, count, block.sample_rate_hz)
            given = {name: values[first : first + count] for name, values in inputs.items()}
            state, out = _Stretch(self, state, part, given).solve()
            written.append(out)
            first += count
        if len(written) == 1:
            return state, written[0]
        names = [signal.name for signal in self.writes]
        return state, {
            name: np.concatenate([out[name] for out in written] or [np.empty(0)]) for name in names
        }

    def steady(self, period: Period, inputs: Spectra) -> tuple[Period, Spectra]:
        """Return the period that the shaft has under its load, and the harmonics of all parts."""
        found: dict[str, ComplexArray] = {}
        real = period

        def respond(torque: ComplexArray) -> ComplexArray:
            nonlocal real
            real, shaft = self.drive.steady(period, {signals.LOAD_TORQUE.name: torque})
            found.update(inputs)
            found.update(shaft)
            for part in self.parts:
                found.update(steady_of(part, real, {**found, **inputs})[1])
            found.update({name: inputs[name] for name in found.keys() & inputs.keys()})
            load = real.harmonics(
                self._torque({name: real.values(values) for name, values in found.items()}, real)
            )
            found[signals.LOAD_TORQUE.name] = load
            inertia = self.drive.reflected_inertia_kg_m2
            rest: ComplexArray = load - inertia * found[signals.SHAFT_ACCELERATION.name]
            return rest

        start = respond(period.constant(0.0))
        relax(respond, start, self.name)
        return real, {signal.name: found[signal.name] for signal in self.writes}

    def _torque(self, run: Signals, period: Period | None = None) -> FloatArray:
        """Return the load at the shaft: struts, their guides, and what varies with the angle."""
        motor = self.drive.motor
        angle, speed = run[signals.SHAFT_ANGLE.name], run[signals.SHAFT_SPEED.name]
        if period is not None:
            angle = angle + period.omega_rad_s * period.time_s
        total = np.zeros_like(angle)
        for strut in ("aft", "fore"):
            lever = run[f"lever_{strut}"]
            total += run[f"force_{strut}"] * lever
            for guides in (motor.guides, self.drive.settings.guides):
                if guides.coulomb_n or guides.viscous_n_s_m:
                    velocity = lever * speed
                    total += guides.viscous_n_s_m * velocity * lever
                    total += guides.coulomb_n * np.sign(velocity) * lever
        for cogging in motor.cogging:
            total += cogging.torque_n_m * np.sin(cogging.order * angle + cogging.phase_rad)
        return total


def reflected_inertia(mass: FloatArray, set_point: SetPoint) -> float:
    """Return the mean over a turn of the inertia that a mass at the struts has at the shaft.

    Parameters
    ----------
    mass
        Per strut acceleration, shape ``(2, 2)``; the struts move as yokes.
    """
    struts = np.exp(1j * np.array([0.0, set_point.strut_phase_rad]))
    return float((struts.conj() @ mass @ struts).real) * set_point.eccentricity_m**2 / 2.0


@dataclass(frozen=True, eq=False)
class _Stretch:
    """Samples that are swept together."""

    stage: Coupled
    state: tuple[Any, Any, Any]
    block: Block
    inputs: Signals

    def solve(self) -> tuple[tuple[Any, Any, Any], Signals]:
        """March, or sweep until torque and motion fit each other."""
        marched = self._march()
        return self._sweep() if marched is None else marched

    def _march(self) -> tuple[tuple[Any, Any, Any], Signals] | None:
        states, torques = self.state[0]
        march = coupled_march(self.stage.drive.shaft, self.stage.parts, self.block, self.inputs)
        found = None if states is None or march is None else march.run(*self.state[0], self.state[2])
        if found is None:
            return None
        shaft, _, hull, run = found
        run[signals.LOAD_TORQUE.name] = self.stage._torque(run)
        tail = tuple(tuple(row) for row in shaft.torques[-TORQUE_DEGREE:].tolist())
        drive = LoadedState(tuple(shaft.states[-1].tolist()), tail)
        return (drive, self.state[1], hull), {one.name: run[one.name] for one in self.stage.writes}

    def _sweep(self) -> tuple[tuple[Any, Any, Any], Signals]:
        at_start = np.zeros(self.block.count)
        if self.state[0].torques:
            at_start += self.state[0].torques[-1][0]
        torque = relax(self._back, at_start, self.stage.name, self._scale(at_start))
        after, written = self._parts(torque)
        return after, {signal.name: written[signal.name] for signal in self.stage.writes}

    def _parts(self, torque: FloatArray) -> tuple[tuple[Any, Any, Any], dict[str, FloatArray]]:
        stage, given = self.stage, self.inputs
        load = {signals.LOAD_TORQUE.name: torque}
        drive, shaft = stage.drive.run(self.state[0], self.block, load)
        run: dict[str, FloatArray] = {**shaft, **given}
        mechanism, motion = stage.mechanism.run(self.state[1], self.block, run)
        run = {**run, **motion, **given}
        hull, forces = stage.hull.run(self.state[2], self.block, run)
        run = {**run, **forces, **given}
        run[signals.LOAD_TORQUE.name] = stage._torque(run)
        return (drive, mechanism, hull), run

    def _back(self, torque: FloatArray) -> FloatArray:
        run = self._parts(torque)[1]
        inertia = self.stage.drive.reflected_inertia_kg_m2
        rest: FloatArray = (
            run[signals.LOAD_TORQUE.name] - inertia * run[signals.SHAFT_ACCELERATION.name]
        )
        return rest

    def _scale(self, torque: FloatArray) -> float:
        """Return what a change of the torque counts relative to: never zero in passing."""
        run = self._parts(torque)[1]
        size = float(np.abs(run[signals.LOAD_TORQUE.name]).max())
        for strut in ("aft", "fore"):
            reach = np.hypot(run[f"lever_{strut}"], run[f"displacement_{strut}"]).max()
            size += float(np.abs(run[f"force_{strut}"]).max() * reach)
        return size
