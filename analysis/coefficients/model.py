"""The way from phasors to coefficients as one function of everything uncertain, vectorised.

Each trial has its own phasors of every run and its own deviations of what is known besides (mass,
amplitude, lag ...). Derivatives for the linear budget and Monte Carlo both call this one function.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from analysis.coefficients.least_squares import least_squares
from analysis.coefficients.names import Form, Place
from analysis.coefficients.phasors import (
    ComplexArray,
    FloatArray,
    from_interleaved,
    interleaved,
)
from analysis.coefficients.run import LOADS, MOTIONS, Run, point_matrix
from analysis.coefficients.stated import STATED, Stated
from analysis.motion import incidence
from hardware.description.oscillator import Plane
from hardware.description.struts import to_loads, to_motion, to_strut_forces, to_struts
from hardware.description.units import STANDARD_GRAVITY_M_S2

__all__ = ["PER_RUN", "STATED", "Problem", "Stated", "fit"]

PER_RUN = 8  # real numbers: S and C of translation, rotation, force, moment


@dataclass(frozen=True, eq=False)
class Problem:
    """Runs of one plane on one oscillator, and what is sought from them.

    Attributes
    ----------
    columns
        The motions whose coefficients are solved for: 0 translation, 1 rotation.
    weights
        Of each run in the fit of each load, shape ``(runs, 2)``.
    """

    runs: tuple[Run, ...]
    form: Form
    columns: tuple[int, ...]
    weights: FloatArray

    @property
    def plane(self) -> Plane:
        """The plane of all runs."""
        return self.runs[0].plane

    def phasor_parts(self) -> FloatArray:
        """The runs' phasors as real numbers, shape ``(runs, 8)``."""
        return self._parts.copy()

    @cached_property
    def _parts(self) -> FloatArray:
        rows = [
            run.phasors.values[[run.phasors.index(name) for name in (*MOTIONS, *LOADS)]]
            for run in self.runs
        ]
        return interleaved(np.stack(rows))

    def nominal(self) -> FloatArray:
        """Return the coefficients of the runs as they are, shape ``(2, columns, 2)``."""
        found = self.solve(self.phasor_parts()[None], np.zeros((1, len(STATED))))
        return np.asarray(found[0])

    def velocities(self) -> tuple[ComplexArray, FloatArray]:
        """Return the form's velocities ``(runs, 2)`` and angular frequencies ``(runs,)``."""
        return self._velocities

    @cached_property
    def _velocities(self) -> tuple[ComplexArray, FloatArray]:
        velocity, _, omega = self.reduce(self.phasor_parts()[None], np.zeros((1, len(STATED))))
        return velocity[0], omega[0]

    def solve(self, parts: FloatArray, deviations: FloatArray) -> FloatArray:
        """Return A and B of each trial.

        Parameters
        ----------
        parts
            Phasors, shape ``(trials, runs, 8)``.
        deviations
            Of the stated quantities from what the runs say, shape ``(trials, len(STATED))``.

        Returns
        -------
        numpy.ndarray
            Shape ``(trials, 2, columns, 2)``: row, column, (A, B) in SI units.
        """
        velocity, load, omega = self.reduce(parts, deviations)
        return fit(velocity[..., list(self.columns)], load, omega, self.weights)

    def reduce(
        self, parts: FloatArray, deviations: FloatArray
    ) -> tuple[ComplexArray, ComplexArray, FloatArray]:
        """Return velocities, hydrodynamic loads and angular frequencies.

        Returns
        -------
        velocity, load
            The form's velocities and the loads about the point, shape ``(trials, runs, 2)``.
        omega
            Shape ``(trials, runs)``.
        """
        off = {name: deviations[:, k, None] for k, name in enumerate(STATED)}
        omega = np.array([run.omega for run in self.runs]) * (1.0 + off["frequency_relative"])
        motion, load = self._struts_corrected(from_interleaved(parts), off, omega)
        arm = -off["midpoint_x_m"] * point_matrix(1.0, self.plane)[0, 1]
        motion[..., 0] += arm * motion[..., 1]
        load[..., 1] -= arm * load[..., 0]
        known = self._known(off, omega)
        load = load - np.einsum("trij,trj->tri", known, motion)
        moves, carry = self.to_point
        motion = np.einsum("rij,trj->tri", moves, motion)
        load = np.einsum("rij,trj->tri", carry, load)
        velocity = 1j * omega[..., None] * motion
        if self.form is Form.MANOEUVRING:
            velocity = velocity + self._incidence(motion, off)
        return velocity, load, omega

    @cached_property
    def to_point(self) -> tuple[FloatArray, FloatArray]:
        """What takes motions and loads to the points wanted, shape ``(runs, 2, 2)`` each."""
        moves = np.stack([point_matrix(run.point_ahead_m, run.plane) for run in self.runs])
        return moves, np.asarray(np.linalg.inv(moves).transpose(0, 2, 1))

    def _incidence(self, motion: ComplexArray, off: dict[str, FloatArray]) -> ComplexArray:
        """What the carriage's speed adds: by the rotation, and by drift or trim to the mean."""
        speed = np.array([run.speed_m_s for run in self.runs]) + off["speed_m_s"]
        drift = np.array([run.drift_rad for run in self.runs])
        mean = np.array([run.order == 0 for run in self.runs])
        turned = np.array(motion)
        turned[..., 1] = np.cos(drift) * (motion[..., 1] + mean * off["alignment_rad"])
        turned[..., 1] += mean * np.sin(drift)
        found: ComplexArray = speed[..., None] * (turned @ incidence(self.plane).T)
        return found

    def _struts_corrected(
        self, phasors: ComplexArray, off: dict[str, FloatArray], omega: FloatArray
    ) -> tuple[ComplexArray, ComplexArray]:
        """Let amplitude, strut phase, lag, skew and gain act where they do: at the struts."""
        half, plane = self.runs[0].half_spacing_m, self.plane
        order = np.array([run.order for run in self.runs])
        aft, fore = to_struts(phasors[..., 0], phasors[..., 1], half, plane)
        forces = to_strut_forces(phasors[..., 2], phasors[..., 3], half, plane)
        asked = np.array([run.motion_is_asked for run in self.runs])
        fore = fore * np.exp(1j * order * off["strut_phase_rad"])
        late = forces[1] * np.exp(1j * omega * off["skew_s"])
        gauge_aft = (1.0 + off["gauge_aft_relative"]) * forces[0] + off["cross_talk_aft"] * late
        gauge_fore = (1.0 + off["gauge_fore_relative"]) * late + off["cross_talk_fore"] * forces[0]
        motion = np.stack(to_motion(aft, fore, half, plane), axis=-1)
        load = np.stack(to_loads(gauge_aft, gauge_fore, half, plane), axis=-1)
        longer = 1.0 + off["half_spacing_m"] / half
        motion[..., 1] /= longer
        load[..., 1] *= longer
        lag = off["lag_s"] + asked * off["latency_s"]
        gain = (1.0 + off["force_gain_relative"]) * np.exp(1j * omega * lag)
        motion *= (1.0 + off["amplitude_relative"])[..., None]
        load *= gain[..., None]
        return motion, load

    def _known(self, off: dict[str, FloatArray], omega: FloatArray) -> FloatArray:
        """``C + G - omega^2 M`` of each trial and run, shape ``(trials, runs, 2, 2)``."""
        side = -1.0 if self.plane is Plane.VERTICAL else 1.0
        restoring = np.stack([run.restoring for run in self.runs])
        denser = (1.0 + off["restoring_relative"]) * (1.0 + off["density_relative"])
        known = restoring * denser[..., None, None]
        known = np.broadcast_to(known, (*omega.shape, 2, 2)).copy()
        has, own_mass, own_inertia, own_x, own_z = self._bodies
        square = has * omega**2
        mass = own_mass + off["mass_kg"]
        coupling = side * mass * (own_x + off["cg_x_m"])
        known[..., 0, 0] -= square * mass
        known[..., 0, 1] -= square * coupling
        known[..., 1, 0] -= square * coupling
        known[..., 1, 1] -= square * (own_inertia + off["inertia_kg_m2"])
        if self.plane is Plane.VERTICAL:
            known[..., 1, 1] += has * mass * STANDARD_GRAVITY_M_S2 * (own_z + off["cg_z_m"])
        return known

    @cached_property
    def _bodies(self) -> FloatArray:
        """Whether there is a body, its mass, inertia, and centre of gravity, ``(5, runs)``."""
        rows = [
            (0.0,) * 5
            if (body := run.body) is None
            else (1.0, body.mass_kg, body.inertia_kg_m2, body.cg_x_m, body.cg_z_m)
            for run in self.runs
        ]
        return np.array(rows).T

    def places(self) -> tuple[Place, ...]:
        """The coefficients that are solved for, column by column."""
        return tuple(
            Place(row, column, inertial)
            for column in self.columns
            for row in (0, 1)
            for inertial in (True, False)
        )

    def flat(self, matrices: FloatArray) -> FloatArray:
        """Return A and B as named coefficients: ``(trials, 2, columns, 2)`` to ``(trials, n)``."""
        ordered = matrices.transpose(0, 2, 1, 3)
        return self.form.sign * ordered.reshape(len(matrices), -1)


def fit(
    velocity: ComplexArray, load: ComplexArray, omega: FloatArray, weights: FloatArray
) -> FloatArray:
    """Solve ``load = (B + i omega A) velocity`` for real A and B by weighted least squares.

    Parameters
    ----------
    velocity
        Shape ``(trials, runs, columns)``.
    load
        Shape ``(trials, runs, 2)``.
    weights
        Shape ``(runs, 2)``: one over the standard deviation of each load.

    Returns
    -------
    numpy.ndarray
        Shape ``(trials, 2, columns, 2)``: row, column, (A, B).
    """
    trials, runs, columns = velocity.shape
    pace = omega / omega[:, :1]  # runs at slightly different frequencies share one A
    z = np.stack((1j * pace[..., None] * velocity, velocity), axis=-1)
    z = z.reshape(trials, runs, 2 * columns)
    found = np.empty((trials, 2, columns, 2))
    for row in (0, 1):
        weight = weights[:, row, None]
        design = np.concatenate(((weight * z).real, (weight * z).imag), axis=1)
        right = weights[:, row] * load[..., row]
        target = np.concatenate((right.real, right.imag), axis=1)
        found[:, row] = least_squares(design, target).reshape(trials, columns, 2)
    found[..., 0] /= omega[:, :1, None]
    return found
