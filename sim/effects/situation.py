"""A run of the nominal rig in closed form: what the signatures of effects are built from."""

from dataclasses import dataclass

import numpy as np

from hardware.description.setpoint import SetPoint
from sim import signals
from sim.linear import ComplexArray
from sim.periodic import SteadyState, steady_run
from sim.rig import SimulatedRig
from sim.signals import FloatArray


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
    def of(cls, rig: SimulatedRig, set_point: SetPoint) -> "Situation":
        """Solve the nominal rig."""
        return cls(rig, set_point, steady_run(rig, set_point))

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

    def impedance(self, order: int) -> ComplexArray:
        """Return force per strut displacement at a multiple of the frequency, shape ``(2, 2)``."""
        hull = self.rig.chain(self.set_point).stage("hull")
        s = 1j * order * self.omega
        system = hull.system  # type: ignore[attr-defined]
        radiation = system.radiation
        memory = system.memory_load @ np.linalg.solve(
            s * np.eye(radiation.states) - radiation.state_matrix,
            radiation.input_matrix @ (s * system.to_motion + system.incidence),
        )
        return np.asarray(s**2 * system.mass + s * system.damping + system.stiffness + memory)

    def force(self, order: int = 1) -> ComplexArray:
        """Return the nominal force at the struts, shape ``(2,)``; the mean for order 0."""
        names = (signals.FORCE_AFT.name, signals.FORCE_FORE.name)
        return np.array([self._phasor(name, order) for name in names])

    def displacement(self, order: int = 1) -> ComplexArray:
        """Return the nominal displacement of the struts, shape ``(2,)``."""
        names = (signals.DISPLACEMENT_AFT.name, signals.DISPLACEMENT_FORE.name)
        return np.array([self._phasor(name, order) for name in names])

    def _phasor(self, name: str, order: int) -> complex:
        harmonic = complex(self.nominal.spectra[name][order])
        # Re(X exp(i n w t)) = S sin + C cos with S = -Im X, C = Re X.
        return harmonic if order == 0 else complex(-harmonic.imag, harmonic.real)


def at_struts(values: ComplexArray | FloatArray, order: int) -> dict[tuple[str, int], complex]:
    """Name the force phasors of both struts, shape ``(2,)``, as a part of a signature."""
    names = (signals.FORCE_AFT.name, signals.FORCE_FORE.name)
    return {(name, order): complex(value) for name, value in zip(names, values, strict=True)}
