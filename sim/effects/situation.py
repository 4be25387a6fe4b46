"""A run of the nominal rig in closed form: what the signatures of effects are built from."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from hardware.description import channels
from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.setpoint import Medium, SetPoint
from sim import signals
from sim.model.system import HullSystem
from sim.periodic import SteadyState, steady_of
from sim.rig import SimulatedRig
from sim.run import steady_run
from sim.stage import Stage

# The forces of both struts, aft and fore, on their way: as they act, and as they are recorded.
STRUT_FORCES = (signals.FORCE_AFT.name, signals.FORCE_FORE.name)
STRUT_DISPLACEMENTS = (signals.DISPLACEMENT_AFT.name, signals.DISPLACEMENT_FORE.name)
RECORDED_FORCES = (
    signals.recorded(channels.FORCE_AFT).name,
    signals.recorded(channels.FORCE_FORE).name,
)


@dataclass(frozen=True, eq=False)
class Situation:
    """A nominal rig at a set-point.

    Phasors are ``H = S + i C`` per strut (aft, fore), shape ``(2,)``: the signal is
    ``S sin(n theta) + C cos(n theta)``.
    """

    rig: SimulatedRig
    set_point: SetPoint
    nominal: SteadyState

    @classmethod
    def of(
        cls, rig: SimulatedRig, set_point: SetPoint, orders: int = 12, points: int = 128
    ) -> "Situation":
        """Solve the nominal rig."""
        return cls(rig, set_point, steady_run(rig, set_point, orders=orders, points=points))

    @property
    def omega(self) -> float:
        """Circular frequency, rad/s."""
        return 2.0 * np.pi * self.set_point.frequency_hz

    @property
    def amplitude_m(self) -> float:
        """Amplitude of each strut."""
        return self.set_point.eccentricity_m

    @property
    def turn(self) -> ComplexArray:
        """``exp(i phi)`` of each strut's crank, shape ``(2,)``."""
        return np.exp(1j * np.array([0.0, self.set_point.strut_phase_rad]))

    @property
    def in_water(self) -> bool:
        """False for a run in air."""
        return self.set_point.medium is Medium.WATER

    @property
    def flow_m_s(self) -> float:
        """Mean speed of the flow past the model."""
        return self.system.speed_m_s

    @property
    def system(self) -> HullSystem:
        """The nominal model and water as a linear system."""
        return self.system_of(self.rig, self.set_point)

    @staticmethod
    def system_of(rig: SimulatedRig, set_point: SetPoint) -> HullSystem:
        """Return a rig's model and water as a linear system."""
        still = replace(rig, drive=replace(rig.drive, motor=None, gear=None))
        system: HullSystem = still.chain(set_point).stage("hull").system  # type: ignore[attr-defined]
        return system

    @property
    def recorded_waves(self) -> tuple[str, ...]:
        """The recorded channels of forces and displacements: what is analysed for harmonics."""
        beside = (channels.SHAFT_ANGLE, channels.CARRIAGE_SPEED)
        lines = self.rig.acquisition.lines
        return tuple(
            signals.recorded(line.channel).name for line in lines if line.channel not in beside
        )

    def impedance(self, order: float) -> ComplexArray:
        """Return force per strut displacement at a multiple of the frequency, shape ``(2, 2)``."""
        s = 1j * order * self.omega
        system = self.system
        radiation = system.radiation
        memory = system.memory_load @ np.linalg.solve(
            s * np.eye(radiation.states) - radiation.state_matrix,
            radiation.input_matrix @ (s * system.to_motion)
            + radiation.passing_matrix @ system.incidence,
        )
        return np.asarray(s**2 * system.mass + s * system.damping + system.stiffness + memory)

    def moved(
        self, changes: Mapping[int, ComplexArray], frequency_ratio: float = 1.0
    ) -> dict[tuple[str, int], complex]:
        """Return the signature of a change of the struts' motion, by the nominal model.

        Parameters
        ----------
        changes
            What the displacement's phasors change by, per strut and order.
        frequency_ratio
            Real frequency over the one that was set.
        """
        highest = max(1, *changes) if changes else 1
        period = self.nominal.period
        real = period.at(period.frequency_hz * frequency_ratio)
        spectra = dict(self.nominal.spectra)
        for strut, motions in enumerate(signals.STRUT_MOTIONS):
            displacement = spectra[motions[0].name].copy()
            for order, change in changes.items():
                displacement[order] += (-1j if order else 1.0) * change[strut]
            for power, motion in enumerate(motions):
                spectra[motion.name] = displacement * real.s**power
        _, forces = steady_of(self._hull, real, spectra)
        moved_phasors: dict[tuple[str, int], complex] = {}
        for order in range(highest + 1):
            after = np.array([_phasor(forces[name][order], order) for name in STRUT_FORCES])
            moved_phasors |= at_struts(after - self.force(order), order)
        for order, change in changes.items():
            moved_phasors |= at_struts(np.asarray(change), order, STRUT_DISPLACEMENTS)
        return moved_phasors

    @property
    def _hull(self) -> Stage[Any]:
        still = replace(self.rig, drive=replace(self.rig.drive, motor=None, gear=None))
        return still.chain(self.set_point).stage("hull")

    def force(self, order: int = 1) -> ComplexArray:
        """Return the nominal force at the struts, shape ``(2,)``; the mean for order 0."""
        return np.array([self.phasor(name, order) for name in STRUT_FORCES])

    def displacement(self, order: int = 1) -> ComplexArray:
        """Return the nominal displacement of the struts, shape ``(2,)``."""
        names = (signals.DISPLACEMENT_AFT.name, signals.DISPLACEMENT_FORE.name)
        return np.array([self.phasor(name, order) for name in names])

    def phasor(self, name: str, order: int) -> complex:
        """Return one signal's nominal harmonic ``S + i C``; the mean for order 0."""
        return _phasor(self.nominal.spectra[name][order], order)


def _phasor(harmonic: complex, order: int) -> complex:
    """Return S + i C of Re(X exp(i n w t)) = S sin + C cos: S = -Im X, C = Re X; the mean as is."""
    return complex(harmonic) if order == 0 else complex(-harmonic.imag, harmonic.real)


def at_struts(
    values: ComplexArray | FloatArray, order: int, names: tuple[str, str] = STRUT_FORCES
) -> dict[tuple[str, int], complex]:
    """Name the force phasors of both struts, shape ``(2,)``, as a part of a signature.

    ``names`` says where the change shows first: in the struts' forces, or only in their records.
    """
    return {(name, order): complex(value) for name, value in zip(names, values, strict=True)}
