"""Standard uncertainties that the experimenter states, common to all runs of a campaign."""

from dataclasses import dataclass, fields

import numpy as np
from numpy.random import Generator

from analysis.uncertainty.distribution import Distribution, shaped
from hardware.description.arrays import FloatArray


@dataclass(frozen=True)
class StatedUncertainties:
    """Standard uncertainties of what all runs share; 0 where it is taken as exact.

    Attributes
    ----------
    mass_kg, cg_x_m, cg_z_m, inertia_kg_m2
        Of the body that is taken off, about the midpoint.
    half_spacing_m, speed_m_s, frequency_relative, restoring_relative
        Of geometry, carriage, frequency (u/f) and the restoring matrix (common factor).
    speed_age_s
        Of the age of what was recorded of a carriage's speed that follows a path.
    amplitude_relative
        Of the struts' motion: eccentricity setting, or calibration of the displacement sensors.
    strut_phase_rad
        Of the fore strut against the aft one, where set-points stand in for the motion.
    lag_s
        Of both forces against the motion: amplifier and skew.
    skew_s
        Of the fore gauge against the aft one.
    force_gain_relative
        Of both gauges together (the calibration's weights).
    gauge_aft_relative, gauge_fore_relative, cross_talk_aft, cross_talk_fore
        Of the calibration matrix: each gauge's own gain, and what it reads of the other's force.
    latency_s
        Of the photocell's pulse; acts where set-points stand in for the motion, which begins with
        the pulse, and nowhere else.
    midpoint_x_m
        Of where the midpoint between the struts stands on the model.
    alignment_rad
        Of the model's heading (or trim) against the carriage's way; acts where the mean incidence
        counts: in non-linear terms and under drift.
    density_relative
        Of the water; acts on the restoring, and again where a system without dimensions divides
        by it.
    heel_rad
        Of the heel as it was set, or as the inclinometer's zero has it.
    surge_gauge_relative, roll_gauge_relative
        Of the own gain of the surge gauge and of the roll gauge.
    turn_rate_relative, turn_radius_m
        Of the rate and the radius of runs on a circle. Where no speed was recorded the speed of
        these is the one times the other, and ``speed_m_s`` does not act on it.
    inertia_degrees_of_freedom
        Of the repeats behind ``inertia_kg_m2``; 0 where it does not rest on any.
    """

    mass_kg: float = 0.0
    cg_x_m: float = 0.0
    cg_z_m: float = 0.0
    inertia_kg_m2: float = 0.0
    half_spacing_m: float = 0.0
    speed_m_s: float = 0.0
    frequency_relative: float = 0.0
    restoring_relative: float = 0.0
    amplitude_relative: float = 0.0
    strut_phase_rad: float = 0.0
    lag_s: float = 0.0
    skew_s: float = 0.0
    force_gain_relative: float = 0.0
    gauge_aft_relative: float = 0.0
    gauge_fore_relative: float = 0.0
    cross_talk_aft: float = 0.0
    cross_talk_fore: float = 0.0
    latency_s: float = 0.0
    midpoint_x_m: float = 0.0
    alignment_rad: float = 0.0
    density_relative: float = 0.0
    heel_rad: float = 0.0
    surge_gauge_relative: float = 0.0
    roll_gauge_relative: float = 0.0
    turn_rate_relative: float = 0.0
    turn_radius_m: float = 0.0
    speed_age_s: float = 0.0
    inertia_degrees_of_freedom: float = 0.0

    @property
    def vector(self) -> FloatArray:
        """All standard uncertainties, in the order of :data:`STATED`."""
        return np.array([getattr(self, name) for name in STATED])

    def freedom(self, name: str) -> float:
        """Return the degrees of freedom of a standard uncertainty; infinite but for repeats."""
        of_inertia = self.inertia_degrees_of_freedom if name == "inertia_kg_m2" else 0.0
        return of_inertia if of_inertia > 0.0 else np.inf

    def draw(self, count: int, generator: Generator) -> FloatArray:
        """Draw deviations, shape ``(count, len(STATED))``: Student's t where repeats are behind."""
        deviations = generator.standard_normal((count, len(STATED))) * self.vector
        for k, name in enumerate(STATED):
            column = deviations[None, :, k]
            deviations[:, k] = shaped(column, Distribution.NORMAL, self.freedom(name), generator)[0]
        return deviations


STATED = tuple(
    field.name
    for field in fields(StatedUncertainties)
    if field.name != "inertia_degrees_of_freedom"
)
