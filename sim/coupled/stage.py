"""Drive, mechanism and model in one stage, for a drive whose speed depends on the load.

The three parts are the same as in an open chain. The drive's linear part answers exactly to the
load torque between samples; torque, motion and forces are then solved sample by sample
(:mod:`sim.coupled.march`). What that does not know is swept over the block until it fits
(:mod:`sim.solve.relaxation`), so that any part, changed by whatever effect, can be inside.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.setpoint import SetPoint
from sim import signals
from sim.coupled.march import coupled_march
from sim.coupled.steady_state import CoupledSteady
from sim.drive.loaded_drive import LoadedDrive, LoadedState
from sim.drive.prescribed_drive import SHAFT
from sim.drive.shaft_system import TORQUE_DEGREE
from sim.signals import Signal, Signals
from sim.solve.period import Period, Spectra
from sim.solve.recurrence import fine_enough, last_period, substeps
from sim.solve.relaxation import LONGEST_SWEEP, relax
from sim.stage import Block, Stage


@dataclass(frozen=True)
class Coupled:
    """A drive that feels its load, with the mechanism and the model that are the load.

    A substituted shaft motion, strut motion or force takes the place of what the part gives, inside
    too: everything behind it is fed with it.
    """

    drive: LoadedDrive
    mechanism: Stage[Any]
    hull: Stage[Any]

    name = "drive"
    reads = (signals.CARRIAGE_SPEED,)

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
        """Return the first states of drive, mechanism and hull."""
        return (
            self.drive.start(sample_rate_hz, seed),
            self.mechanism.start(sample_rate_hz, seed),
            self.hull.start(sample_rate_hz, seed),
        )

    def run(
        self, state: tuple[Any, Any, Any], block: Block, inputs: Signals
    ) -> tuple[tuple[Any, Any, Any], Signals]:
        """Return states and signals over the block.

        Where a gear's teeth ring faster than the samples follow, there are steps between them; the
        carriage's speed stays over these as at the sample that they lead to.
        """
        if self.drive.settings.gear is None or not block.count:
            return self._in_stretches(state, block, inputs)
        times = substeps(self.drive.system.A, 1.0 / block.sample_rate_hz)
        lone = 1 if block.first == 0 else 0  # a run's first sample has no step before it
        first = 0 if lone else times * (block.first - 1) + 1
        count = times * (block.count - lone) + lone
        fine = {name: np.repeat(values, times)[-count:] for name, values in inputs.items()}
        state, out = self._in_stretches(
            state, Block(first, count, times * block.sample_rate_hz), fine
        )
        last = 0 if lone else times - 1
        return state, {name: values[last::times] for name, values in out.items()}

    def _in_stretches(
        self, state: tuple[Any, Any, Any], block: Block, inputs: Signals
    ) -> tuple[tuple[Any, Any, Any], Signals]:
        """Return states and signals over the block, swept in stretches."""
        written: list[Signals] = []
        first = 0
        while first < block.count:
            # A run's first sample is swept: it has no state yet to march from.
            swept = state[0].states is None and self.drive.settings.gear is None
            most = 1 if swept else LONGEST_SWEEP
            count = min(most, block.count - first)
            part = Block(block.first + first, count, block.sample_rate_hz)
            stage, count = self._as_of(part)
            part = replace(part, count=count)
            part_inputs = {name: values[first : first + count] for name, values in inputs.items()}
            state, out = _Stretch(stage, state, part, part_inputs).solve()
            written.append(out)
            first += count
        if len(written) == 1:
            return state, written[0]
        names = [signal.name for signal in self.writes]
        return state, {
            name: np.concatenate([out[name] for out in written] or [np.empty(0)]) for name in names
        }

    def _as_of(self, block: Block) -> "tuple[Coupled, int]":
        """Return the stage with the water as it is at the block's first sample, and for how many.

        The march solves a stretch with one and the same water.
        """
        if not hasattr(self.hull, "as_of"):
            return self, block.count
        hull, count = self.hull.as_of(block.time_s, 1.0 / block.sample_rate_hz)
        return (self if hull is self.hull else self.with_part("hull", hull)), count

    def steady(self, period: Period, inputs: Spectra) -> tuple[Period, Spectra]:
        """Return the period that the shaft has under its load, and the harmonics of all parts.

        A gear with backlash is run on until its motion repeats.
        """
        if self.drive.settings.gear is None:
            return self._balanced(period, inputs)
        settings = replace(self.drive.settings, gear=None)
        held = replace(self, drive=replace(self.drive, settings=settings))
        real = period.at(settings.frequency_hz(self.drive.frequency_hz))
        if self.drive.motor is not None:
            real, _ = held._balanced(period, inputs)
        return real, self._settled(real, inputs)

    def _balanced(self, period: Period, inputs: Spectra) -> tuple[Period, Spectra]:
        parts = CoupledSteady(self.drive, self.mechanism, self.hull, period, inputs)
        real, balanced = parts.solve()
        return real, {signal.name: balanced[signal.name] for signal in self.writes}

    def _settled(self, real: Period, inputs: Spectra) -> Spectra:
        """Return the harmonics of all parts after as many periods as it takes."""
        old = self.drive.settings
        tones = tuple(tone for tone in old.ripple if float(tone.order).is_integer())
        steady = replace(old, initial_angle_rad=0.0, start_ramp_s=0.0, stop_at_s=None, ripple=tones)
        stage = replace(self, drive=replace(self.drive, settings=steady))
        hull: Any = self.hull
        if hasattr(hull, "repeating"):
            stage = stage.with_part("hull", hull.repeating)
        fine = fine_enough(real, self.drive.system.A)
        if hasattr(hull, "system") and hull.system.elastic_count:
            fine = fine_enough(fine, hull.system.state_matrix)
        samples = {name: fine.values(values) for name, values in inputs.items()}

        def run(state: Any, turn: int) -> tuple[Any, Signals]:
            rate_hz = fine.points * fine.frequency_hz
            state, out = stage.run(state, Block(turn * fine.points, fine.points, rate_hz), samples)
            turned = fine.omega_rad_s * (fine.time_s + turn / fine.frequency_hz)
            beyond = out[signals.SHAFT_ANGLE.name] - turned
            return state, {**out, signals.SHAFT_ANGLE.name: beyond}

        forces = last_period(run, stage.start(1.0, 0), ("force_aft", "force_fore"))
        # Time counts from where the mean angle is 0.
        late = fine.harmonics(forces[signals.SHAFT_ANGLE.name])[0].real / fine.omega_rad_s
        spectra = {
            name: fine.harmonics(force) * np.exp(-fine.s * late) for name, force in forces.items()
        }
        spectra[signals.SHAFT_ANGLE.name][0] = 0.0
        return spectra


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
        before: LoadedState = self.state[0]
        swept = before.states is None and self.stage.drive.settings.gear is None
        march = coupled_march(self.stage.drive.shaft, self.stage.parts, self.block, self.inputs)
        if swept or march is None:
            return None
        unladen = self.stage.drive.unladen(before, self.block)
        marched = march.run(before.states, before.torques, self.state[2], unladen)
        if marched is None:
            return None
        shaft, _, hull, run = marched
        run[signals.LOAD_TORQUE.name] = self.stage.drive.load(run)
        tail = tuple(tuple(row) for row in shaft.torques[-TORQUE_DEGREE:].tolist())
        states = tuple(shaft.states[-1].tolist())
        drive = LoadedState(states, tail, unladen.ahead, unladen.speeds)
        return (drive, self.state[1], hull), {
            signal.name: run[signal.name] for signal in self.stage.writes
        }

    def _sweep(self) -> tuple[tuple[Any, Any, Any], Signals]:
        at_start = np.zeros(self.block.count)
        if self.state[0].torques:
            at_start += self.state[0].torques[-1][0]
        torque = relax(self._back, at_start, self.stage.name, self._scale(at_start))
        after, written = self._parts(torque)
        return after, {signal.name: written[signal.name] for signal in self.stage.writes}

    def _parts(self, torque: FloatArray) -> tuple[tuple[Any, Any, Any], dict[str, FloatArray]]:
        stage, inputs = self.stage, self.inputs
        load = {signals.LOAD_TORQUE.name: torque}
        drive, shaft = stage.drive.run(self.state[0], self.block, load)
        run: dict[str, FloatArray] = {**shaft, **inputs}
        mechanism, motion = stage.mechanism.run(self.state[1], self.block, run)
        run = {**run, **motion, **inputs}
        hull, forces = stage.hull.run(self.state[2], self.block, run)
        run = {**run, **forces, **inputs}
        run[signals.LOAD_TORQUE.name] = stage.drive.load(run)
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
