"""A simple estimate of the struts' forces, and how far it is to be trusted.

Mass, added mass, damping, weight and restoring as the rig's file gives them, constant over
frequency; velocities are those through the water, so that a pure yaw has no sway force. What is
steady is that of the mean incidence and of a circle: the same matrices, whose loads do not change.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Final, NamedTuple

import numpy as np

from analysis.ideal_rig import held_at_rest_n, incidence, mass_matrix, weight_matrix
from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.body import Body, ShipModel
from hardware.description.channels import FORCES
from hardware.description.oscillator import Oscillator
from hardware.description.setpoint import Medium
from hardware.description.struts import to_motion, to_strut_forces
from pmm.plan.motion_peaks import omega_of, rod_factor
from pmm.plan.rig_file import RigFile
from pmm.plan.rig_tables import HullEstimate
from pmm.plan.run_plan import RunPlan

# Relative standard uncertainties of what the estimate is made of: the upper ends of what each is
# usually wrong by (docs/effects.md: S8 and S9 with all that moves below the gauges, H1, H2, H5 of
# hydrostatics from the lines, M1 with K3 for the gauge and the amplitude).
MODEL_UNCERTAINTY: Final = 0.02
ADDED_MASS_UNCERTAINTY: Final = 0.2
DAMPING_UNCERTAINTY: Final = 0.3
RESTORING_UNCERTAINTY: Final = 0.05
READING_UNCERTAINTY: Final = 0.02
FAR: Final = 2.0  # standard uncertainties of the estimate: 95 % lie within


class ExpectedAmplitude(NamedTuple):
    """Amplitude of a gauge's first harmonic, in newtons, and its standard uncertainty."""

    amplitude_n: float
    standard_uncertainty_n: float

    def is_far(self, amplitude_n: float) -> bool:
        """Whether a measured amplitude can hardly be that of the rig that the file describes."""
        return abs(amplitude_n - self.amplitude_n) > FAR * self.standard_uncertainty_n


@dataclass(frozen=True)
class ForceEstimate:
    """First harmonics of the struts' forces, aft and fore.

    Attributes
    ----------
    forces
        Phasors in newtons, shape ``(2,)``.
    parts
        What each entry of each matrix has in them, times its relative standard uncertainty: shape
        ``(entries, 2)``.
    """

    forces: ComplexArray
    parts: ComplexArray


def force_estimate(run: RunPlan, rig: RigFile) -> ForceEstimate | None:
    """Return the estimate for a run that oscillates.

    It is ``None`` where the rig's file describes no model.
    """
    if rig.model is None:
        return None
    oscillator, point = rig.oscillator, run.set_point
    e, phi = point.eccentricity_m, point.strut_phase_rad
    aft, fore = complex(e), e * complex(math.cos(phi), math.sin(phi))
    motion = np.array(to_motion(aft, fore, oscillator.half_spacing_m, oscillator.plane))
    iw = 1j * omega_of(run)
    through = iw * motion + point.carriage_speed_m_s * incidence(oscillator.plane) @ motion
    moves = _Moves(motion, through, iw**2 * motion, iw * through)
    forces, parts = np.zeros(2, dtype=np.complex128), []
    for matrix, moved, relative in _reactions(run, rig, rig.model, moves):
        for row, column in np.ndindex(2, 2):
            load = np.zeros(2, dtype=np.complex128)
            load[row] = matrix[row][column] * moved[column]
            share = _at_struts(load, oscillator)
            forces += share
            parts.append(relative * share)
    return ForceEstimate(forces, np.array(parts))


def steady_forces_n(run: RunPlan, rig: RigFile) -> FloatArray:
    """Return what towing asks of the struts, aft and fore, in newtons, shape ``(2,)``.

    Damping by the mean incidence and the rate of turn, and inertia on a circle; zeros where the
    rig's file describes no model. Resistance and rudder are not in it.
    """
    if rig.model is None:
        return np.zeros(2)
    point, plane = run.set_point, rig.oscillator.plane
    heading = np.array([0.0, math.sin(point.drift_rad)])
    turning = np.array([0.0, point.turn_rate_rad_s])
    along_m_s = point.carriage_speed_m_s * math.cos(point.drift_rad)
    moves = _Moves(
        place=np.zeros(2),
        through=turning + point.carriage_speed_m_s * incidence(plane) @ heading,
        acceleration=np.array([along_m_s * point.turn_rate_rad_s, 0.0]),
        gain_through=np.zeros(2),
    )
    loads = [matrix @ moved for matrix, moved, _ in _reactions(run, rig, rig.model, moves)]
    return _at_struts(np.sum(loads, axis=0), rig.oscillator).real


def held_n(run: RunPlan, rig: RigFile) -> FloatArray:
    """Return what the struts hold at rest, aft and fore, in newtons, shape ``(2,)``.

    Weight less buoyancy, with a known mass, and what weight and restoring ask where a trim sets the
    model; zeros where the rig's file describes no model. A tare takes it off.
    """
    if rig.model is None:
        return np.zeros(2)
    point, added = run.set_point, run.known_mass
    trimmed = np.array([0.0, point.drift_rad])
    moves = _Moves(trimmed, np.zeros(2), np.zeros(2), np.zeros(2))
    loads = [matrix @ moved for matrix, moved, _ in _reactions(run, rig, rig.model, moves)]
    held = held_at_rest_n(rig.model, rig.oscillator, point.medium)
    if added is not None:
        mass = Body(added.mass_kg, 0.0, added.x_m)
        held = held + held_at_rest_n(mass, rig.oscillator, point.medium)
    return np.asarray(held + _at_struts(np.sum(loads, axis=0), rig.oscillator).real)


def force_peaks_n(run: RunPlan, rig: RigFile) -> FloatArray | None:
    """Return an estimate of the largest force of each strut, aft and fore, in newtons.

    It is the size of what is steady with the first harmonics, and ``None`` where nothing moves or
    the rig's file describes no model.
    """
    if rig.model is None or not (run.oscillates or run.set_point.carriage_speed_m_s):
        return None
    return np.abs(steady_forces_n(run, rig)) + oscillating_forces_n(run, rig)


def oscillating_forces_n(run: RunPlan, rig: RigFile) -> FloatArray:
    """Return what a motion asks of each strut at most beside what is steady, in newtons.

    Shape ``(2,)``, aft and fore; zeros of a shaft at rest, and where the rig's file describes no
    model.
    """
    sines = single_sines(run) if run.oscillates else ()
    estimates = [force_estimate(sine, rig) for sine in sines]
    sizes = [np.abs(estimate.forces) for estimate in estimates if estimate is not None]
    return np.asarray(np.sum([np.zeros(2), *sizes], axis=0) * rod_factor(run, rig.oscillator))


def force_peak_n(run: RunPlan, rig: RigFile) -> float | None:
    """Return an estimate of the largest force of a strut, in newtons.

    It is ``None`` as :func:`force_peaks_n` is.
    """
    peaks = force_peaks_n(run, rig)
    return None if peaks is None else float(peaks.max())


def single_sines(run: RunPlan) -> tuple[RunPlan, ...]:
    """Return a run for each line of a motion; their peaks together are its at most."""
    point = run.set_point
    if not point.lines:
        return (run,)
    return tuple(
        replace(
            run,
            set_point=replace(
                point,
                frequency_hz=line.order * point.frequency_hz,
                eccentricity_m=line.share * point.eccentricity_m,
                strut_phase_rad=line.strut_phase_rad,
                lines=(),
            ),
        )
        for line in point.lines
    )


def expected_readings(run: RunPlan, rig: RigFile) -> dict[str, ExpectedAmplitude]:
    """Return what each strut's gauge should read; empty where the file tells too little.

    A calibration's matrix makes readings of forces, as it does in the rig. A memory of the water
    (``[campaign.radiation]``) is not in the estimate, so that in water nothing is expected then; of
    a motion of many lines nothing is, for the first harmonic may be none of them.
    """
    in_water = run.set_point.medium is Medium.WATER
    unknown = in_water and (rig.hull is None or "radiation" in rig.campaign)
    unknown = unknown or bool(run.set_point.lines)
    estimate = None if unknown or not run.oscillates else force_estimate(run, rig)
    if estimate is None:
        return {}
    gauges = _gauges(rig)
    readings, parts = gauges @ estimate.forces, estimate.parts @ gauges.T
    reading_u = READING_UNCERTAINTY * np.abs(readings)
    spread = np.sqrt((np.abs(parts) ** 2).sum(axis=0) + reading_u**2)
    return {
        name: ExpectedAmplitude(float(abs(reading)), float(u))
        for name, reading, u in zip(FORCES, readings, spread, strict=True)
    }


def _gauges(rig: RigFile) -> FloatArray:
    """Return the readings of the strut gauges for a newton on each, shape ``(2, 2)``."""
    matrix = np.eye(2)
    calibration = rig.calibration
    if calibration is not None:
        names = [name for name in FORCES if name in calibration.channels]
        rows = [calibration.channels.index(name) for name in names]
        places = [FORCES.index(name) for name in names]
        matrix[np.ix_(places, places)] = calibration.matrix[np.ix_(rows, rows)]
    return matrix


def _at_struts(load: ComplexArray | FloatArray, oscillator: Oscillator) -> ComplexArray:
    force, moment = complex(load[0]), complex(load[1])
    return np.array(to_strut_forces(force, moment, oscillator.half_spacing_m, oscillator.plane))


class _Moves(NamedTuple):
    """Translation and rotation in m and rad, and their rates: phasors, or what is steady.

    ``through`` and ``gain_through`` are velocity and acceleration through the water, along the
    model's axes.
    """

    place: ComplexArray | FloatArray
    through: ComplexArray | FloatArray
    acceleration: ComplexArray | FloatArray
    gain_through: ComplexArray | FloatArray


def _reactions(
    run: RunPlan, rig: RigFile, model: ShipModel, moves: _Moves
) -> Iterator[tuple[FloatArray, ComplexArray | FloatArray, float]]:
    """Yield matrices, the moves that they act on, and their relative standard uncertainties."""
    plane, medium = rig.oscillator.plane, run.set_point.medium
    yield mass_matrix(_laden(model, run), plane), moves.acceleration, MODEL_UNCERTAINTY
    yield weight_matrix(model, plane, medium), moves.place, MODEL_UNCERTAINTY
    if medium is Medium.AIR:
        return
    hull = rig.hull or HullEstimate()
    yield np.array(hull.added_mass), moves.gain_through, ADDED_MASS_UNCERTAINTY
    yield np.array(hull.damping), moves.through, DAMPING_UNCERTAINTY
    yield np.array(hull.restoring), moves.place, RESTORING_UNCERTAINTY


def _laden(model: Body, run: RunPlan) -> Body:
    """Return the model with the run's known mass on it, as far as inertia goes."""
    added = run.known_mass
    if added is None:
        return model
    mass = model.mass_kg + added.mass_kg
    moment = model.mass_kg * model.cg_x_m + added.mass_kg * added.x_m
    inertia_kg_m2 = added.own_inertia_kg_m2 + added.mass_kg * added.x_m**2
    return Body(mass, model.inertia_kg_m2 + inertia_kg_m2, moment / mass)
