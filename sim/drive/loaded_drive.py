"""A drive whose speed changes under load: a motor, or cranks behind a gear with backlash."""

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError
from hardware.description.motor import Cogging, Guides, Motor
from sim import signals
from sim.drive.gear import geared
from sim.drive.motor import closed_loop, droop
from sim.drive.prescribed_drive import SHAFT, DriveSettings, ShaftMotion, shaft_over
from sim.drive.shaft_system import TORQUE_DEGREE, ShaftSystem
from sim.signals import Signals
from sim.solve.linear_system import Hold, LinearSystem, causal_hold
from sim.solve.period import Period, Spectra
from sim.solve.relaxation import Tail
from sim.stage import Block


class LoadedState(NamedTuple):
    """Where the shaft is; ``None`` and empty before the first sample.

    Attributes
    ----------
    states
        What the load has made of angle, speed and current.
    torques
        Of the load, at the last samples.
    ahead, speeds
        The same of the command alone: states less what the speed makes of them at once, and the
        last speeds that were told.
    """

    states: tuple[float, ...] | None = None
    torques: Tail = ()
    ahead: tuple[float, ...] = ()
    speeds: Tail = ()


class Unladen(NamedTuple):
    """The shaft's motion without its struts, the opening of its gear (rad), and what is kept."""

    motion: ShaftMotion
    opening: FloatArray
    ahead: tuple[float, ...]
    speeds: Tail


@dataclass(frozen=True)
class LoadedDrive:
    """A motor that gives way to the load torque, or cranks that do behind a gear with backlash.

    Attributes
    ----------
    reflected_inertia_kg_m2
        Mean inertia that the model adds at the shaft. It is solved as part of the motor; its torque
        is then no part of the load that is handed in. Any value gives the same motion; the true one
        gives it with the fewest sweeps.
    lifted_n
        What each strut holds at rest, aft and fore: gauges are tared of it, the shaft lifts it.
    """

    frequency_hz: float
    settings: DriveSettings
    motor: Motor | None
    reflected_inertia_kg_m2: float = 0.0
    lifted_n: tuple[float, float] = (0.0, 0.0)

    name = "drive"
    reads = (signals.LOAD_TORQUE,)
    writes = SHAFT

    def start(self, sample_rate_hz: float, seed: int) -> LoadedState:
        """Return the state before the first sample: no deviation yet."""
        return LoadedState()

    def run(self, state: LoadedState, block: Block, inputs: Signals) -> tuple[LoadedState, Signals]:
        """Return the shaft's motion under a load torque (less the reflected inertia's).

        Raises
        ------
        ConfigurationError
            If a gear has backlash: where its teeth meet is solved with the load only.
        """
        if self.settings.gear is not None:
            raise ConfigurationError(
                "drive: a gear with backlash is solved sample by sample with what loads it; leave "
                "out play that friction holds, laws without a compiled form and substituted "
                "signals, or the gear"
            )
        motion, _, ahead, speeds = self.unladen(state, block)
        torque = inputs[signals.LOAD_TORQUE.name]
        torque = torque + self.reflected_inertia_kg_m2 * motion.acceleration
        system = self.system
        hold = self._hold(block.sample_rate_hz)
        start = 0 if state.states is not None else 1
        if start:
            zero = (0.0,) * len(system.A)
            state = LoadedState(zero, ((float(torque[0]),),) * TORQUE_DEGREE)
        joined = np.concatenate([np.array(state.torques)[:, 0], torque[start:]])[:, np.newaxis]
        states = np.empty((block.count, len(system.A)))
        states[:start] = state.states
        states[start:] = hold.run(np.array(state.states), joined)
        shaft = motion.beyond(states @ system.C.T + torque[:, np.newaxis] @ system.D.T)
        tail = tuple((value,) for value in joined[-TORQUE_DEGREE:, 0].tolist())
        return LoadedState(tuple(states[-1].tolist()), tail, ahead, speeds), shaft.signals

    def unladen(self, state: LoadedState, block: Block) -> "Unladen":
        """Return how the shaft would turn without its struts.

        The told acceleration turns the drive's own inertia J: x' = A x + B J a. A ramp's corner is
        a step of a, which no polynomial through samples follows; of the told speed w it is a bend.
        So z = x - B J w is what goes on: z' = A z + A B J w.
        """
        motion = self.settings.commanded(self.frequency_hz, block.time_s)
        system = self._alone.system
        gain = system.B[:, :1] * self._inertia_alone
        driven = LinearSystem(system.A, system.A @ gain, system.C, system.C @ gain)
        speeds = motion.speed[:, np.newaxis]
        start = 0 if state.speeds else 1
        past = np.array(state.speeds) if state.speeds else np.repeat(speeds[:1], TORQUE_DEGREE, 0)
        first = np.array(state.ahead) if state.speeds else -gain[:, 0] * motion.speed[0]
        joined = np.concatenate([past, speeds[start:]])
        hold = causal_hold(driven, 1.0 / block.sample_rate_hz, TORQUE_DEGREE)
        states = np.vstack([np.tile(first, (start, 1)), hold.run(first, joined)])
        direct = system.D[:, :1].T * self._inertia_alone
        moved = (
            states @ driven.C.T + speeds @ driven.D.T + motion.acceleration[:, np.newaxis] @ direct
        )
        tail = tuple(tuple(row) for row in joined[-TORQUE_DEGREE:].tolist())
        opening = moved[:, 3] if moved.shape[1] > 3 else np.zeros(block.count)
        return Unladen(motion.beyond(moved), opening, tuple(states[-1].tolist()), tail)

    def steady(self, period: Period, inputs: Spectra) -> tuple[Period, Spectra]:
        """Return the period that the shaft really has under the load, and its harmonics."""
        torque = inputs[signals.LOAD_TORQUE.name]
        free_hz = self.settings.frequency_hz(self.frequency_hz)
        lost = 0.0 if self.motor is None else droop(self.motor)
        real = period.at(free_hz + lost * float(torque[0].real) / (2.0 * math.pi))
        ripple = self.settings.ripple_over(real)
        total = (
            torque
            + (self._inertia_alone + self.reflected_inertia_kg_m2)
            * ripple[signals.SHAFT_ACCELERATION.name]
        )
        beyond = ripple[signals.SHAFT_ANGLE.name].copy()
        beyond[1:] += self.system.response(real.s[1:])[:, 0, 0] * total[1:]
        return real, shaft_over(real, beyond)

    def load(self, run: Signals, turned: FloatArray | float = 0.0) -> FloatArray:
        """Return the load at the shaft: struts, their guides, and what varies with the angle.

        Parameters
        ----------
        run
            Angle and speed of the shaft, levers and forces of both struts.
        turned
            What the angle has besides.
        """
        angle = run[signals.SHAFT_ANGLE.name] + turned
        speed = run[signals.SHAFT_SPEED.name]
        total = np.zeros_like(angle)
        for strut, lifted_n in zip(("aft", "fore"), self.lifted_n, strict=True):
            lever = run[f"lever_{strut}"]
            total += (run[f"force_{strut}"] + lifted_n) * lever
            for guides in self.guides:
                if guides.coulomb_n or guides.viscous_n_s_m:
                    velocity = lever * speed
                    total += guides.viscous_n_s_m * velocity * lever
                    total += guides.coulomb_n * np.sign(velocity) * lever
        for cogging in self.cogging:
            total += cogging.torque_n_m * np.sin(cogging.order * angle + cogging.phase_rad)
        return total

    @cached_property
    def system(self) -> LinearSystem:
        """From the load torque to the shaft's deviation, a gear's teeth always in contact."""
        if self.settings.gear is not None:
            return geared(self.motor, self.settings.gear, self.reflected_inertia_kg_m2)
        if self.motor is None:
            raise ConfigurationError("drive: neither a motor nor a gear gives way to the load")
        return closed_loop(self.motor, self.reflected_inertia_kg_m2)

    @cached_property
    def guides(self) -> tuple[Guides, ...]:
        """Friction of the struts' guides: the drive's, and the motor's own."""
        guides = () if self.motor is None else (self.motor.guides,)
        return (*guides, self.settings.guides)

    @property
    def cogging(self) -> tuple[Cogging, ...]:
        """The motor's torques that vary with the shaft's angle."""
        return () if self.motor is None else self.motor.cogging

    @property
    def shaft(self) -> ShaftSystem:
        """What the march of drive and model needs of this drive."""
        gear = self.settings.gear
        return ShaftSystem(
            self.settings,
            self.frequency_hz,
            self.system,
            self.reflected_inertia_kg_m2,
            (
                sum(guide.coulomb_n for guide in self.guides),
                sum(guide.viscous_n_s_m for guide in self.guides),
            ),
            tuple(
                (float(harmonic.order), harmonic.torque_n_m, harmonic.phase_rad)
                for harmonic in self.cogging
            ),
            (0.0, 0.0) if gear is None else (gear.stiffness_n_m_rad, gear.backlash_rad / 2.0),
            self.lifted_n,
        )

    @cached_property
    def _alone(self) -> "LoadedDrive":
        """The drive without the model at its shaft."""
        return replace(self, reflected_inertia_kg_m2=0.0)

    @cached_property
    def _inertia_alone(self) -> float:
        """What the told acceleration has to turn of the drive itself."""
        gear, motor = self.settings.gear, self.motor
        inertia_kg_m2 = 0.0 if motor is None else motor.shaft_inertia_kg_m2
        return inertia_kg_m2 if gear is None else gear.crank_inertia_kg_m2

    def _hold(self, sample_rate_hz: float) -> Hold:
        return causal_hold(self.system, 1.0 / sample_rate_hz, TORQUE_DEGREE)
