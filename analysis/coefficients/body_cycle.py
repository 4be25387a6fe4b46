"""The averaged cycle of a run in body axes: all harmonics of motion and loads, mean included.

Non-linear terms are fitted to several harmonics at once. The scatter of these is correlated, so one
covariance matrix holds all of them. Phasors are named ``force 0``, ``force 1`` ...; order 0 is
real.
"""

import math
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from analysis.coefficients.body_axes import at_order, labels
from analysis.coefficients.hull_cycle import HullCycle, on_hull
from analysis.coefficients.phasors import Phasors
from analysis.coefficients.stated_uncertainties import STATED
from analysis.coefficients.tare import Tare
from analysis.ideal_rig import mass_matrix, weight_matrix
from analysis.kinematics.body_frame import CHANNELS, HEELED, ROLL_MOMENT
from hardware.description.arrangement import Arrangement
from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.body import Body
from hardware.description.errors import ConfigurationError
from hardware.description.flags import Flag
from hardware.description.heel import Heel
from hardware.description.oscillator import Plane
from hardware.description.setpoint import Medium

MOTIONS = ("translation", "rotation")
LOADS = ("force", "moment")
SURGE_FORCE = CHANNELS[-1]
DRY_TAKEN_OFF = "dry_run_taken_off"  # flag of a run whose loads are less those in air

_STEPS = 720  # of a base period, in which the peak of many lines is sought


def zero_matrix() -> FloatArray:
    """Return the restoring of a body that nothing holds, shape ``(2, 2)``."""
    return np.zeros((2, 2))


def _no_phasors() -> ComplexArray:
    return np.zeros((0, 0), dtype=np.complex128)


@dataclass(frozen=True, eq=False)
class BodyCycle:
    """Motion and loads of the model about the midpoint, at the harmonics 0 to ``orders``.

    The loads are gross, as the struts exerted them. What is known of them (the model's inertia and
    weight, hydrostatic restoring) is named beside them and taken off in :attr:`hull`, so that an
    uncertain mass or amplitude acts there as it does in truth.

    Attributes
    ----------
    frequency_hz
        Of the fundamental; 0 for a static run, which has order 0 alone.
    speed_m_s
        Of the carriage; where that follows the struts' path, of the model along itself.
    phasors
        By order, :data:`analysis.kinematics.body_frame.CHANNELS`: displacement across the tank (m),
        rotation from where the drift sets the model (rad), velocities through the water along and
        across it (m/s), force (N), moment (N m) and, where there is a gauge for it, surge force (N)
        of the struts on the model; of one that heels, their roll moment (N m) and its heel (rad).
    sensitivity
        Slope of the phasors' real numbers by each stated quantity, shape ``(2 n, len(STATED))``.
    mean_known
        Whether zero runs were taken off, so that the means are loads of the water.
    body
        What is taken off as inertia and weight; ``None`` where nothing is (a dry run was).
    restoring
        Hydrostatic restoring that is taken off, N/m, N and N m; about the midpoint, per
        displacement from where the model floats without drift.
    tare
        Where the drift sets the model, and what a zero run there took off.
    point_ahead_m
        Where coefficients are wanted, ahead of the midpoint.
    drift_rad
        Steady heading of the model against the carriage's way, bow to starboard (bow up).
    rudder_rad
        Angle at which the rudder is laid, positive to turn to starboard; 0 where there is none.
    arrangement
        Of the rig, by which motion and loads were made of what was read.
    readings
        Phasors of the struts' displacements and gauges, ``force_x`` last where there is one, shape
        ``(orders + 1, 4 or 5)``; empty where only motion and loads are known. Roll moment and heel
        follow.
    heel, heel_rad
        How the model heels, and the heel of the run's set-point, to starboard.
    turn_rate_rad_s
        Steady rate of turn of a run on a circle, bow to starboard; 0 for a straight way.
    varies_m_s
        What the carriage's speed is besides at each instant, where it follows the struts' path.
    lines
        Harmonics at which a motion of many frequencies has its lines; empty for a single sine.
    """

    name: str
    plane: Plane
    half_spacing_m: float
    frequency_hz: float
    speed_m_s: float
    phasors: Phasors
    orders: int
    medium: Medium = Medium.WATER
    body: Body | None = None
    restoring: FloatArray = field(default_factory=zero_matrix)
    point_ahead_m: float = 0.0
    drift_rad: float = 0.0
    mean_known: bool = False
    flags: tuple[Flag, ...] = ()
    sensitivity: FloatArray = field(default_factory=lambda: np.zeros((0, len(STATED))))
    tare: Tare = field(default_factory=Tare)
    arrangement: Arrangement = field(default_factory=Arrangement)
    readings: ComplexArray = field(default_factory=_no_phasors)
    rudder_rad: float = 0.0
    heel: Heel | None = None
    heel_rad: float = 0.0
    lines: tuple[int, ...] = ()
    turn_rate_rad_s: float = 0.0
    varies_m_s: FloatArray = field(default_factory=lambda: np.zeros(()))

    @property
    def has_roll(self) -> bool:
        """Whether the roll moment was measured."""
        return at_order(ROLL_MOMENT, 0) in self.phasors.names

    @property
    def has_surge(self) -> bool:
        """Whether the surge force was measured."""
        return at_order(SURGE_FORCE, 0) in self.phasors.names

    @property
    def channels(self) -> tuple[str, ...]:
        """Names of the channels whose phasors the cycle has."""
        return tuple(name for name in HEELED if at_order(name, 0) in self.phasors.names)

    @property
    def motion(self) -> ComplexArray:
        """Translation and rotation at the fundamental (of a static run none), shape ``(2,)``."""
        return self._at(MOTIONS)

    @property
    def amplitude(self) -> FloatArray:
        """Translation (m) and rotation (rad), shape ``(2,)``; of lines the peak of all together."""
        if not self.lines:
            return np.abs(self.motion)
        orders = np.arange(1, self.orders + 1)
        turn = np.exp(2j * math.pi * np.outer(orders, np.arange(_STEPS)) / _STEPS)
        moved = np.array([self._at(MOTIONS, int(order)) for order in orders])
        return np.asarray(np.abs((moved.T @ turn).real).max(axis=1))

    @property
    def at_struts(self) -> ComplexArray:
        """Translation, and rotation times half the strut spacing, at the fundamental, m."""
        return np.asarray(self.motion * np.array([1.0, self.half_spacing_m]))

    @property
    def loads(self) -> ComplexArray:
        """Force and moment at the fundamental, gross, shape ``(2,)``."""
        return self._at(LOADS)

    @property
    def load_magnitudes(self) -> FloatArray:
        """Magnitudes of the struts' loads from inertia, weight and restoring at the fundamental.

        Of each, force and moment about the midpoint; shape ``(3, 2)``.
        """
        matrix = np.zeros((3, 2, 2))
        if self.body is not None:
            square = (2.0 * math.pi * self.frequency_hz) ** 2
            matrix[0] = square * mass_matrix(self.body, self.plane)
            matrix[1] = weight_matrix(self.body, self.plane, self.medium)
        matrix[2] = self.restoring
        return np.abs(matrix @ self.motion)

    def _at(self, names: tuple[str, ...], order: int = 1) -> ComplexArray:
        if order > self.orders:
            return np.zeros(len(names), dtype=np.complex128)
        return self.phasors.values[[self.phasors.index(at_order(name, order)) for name in names]]

    @cached_property
    def hull(self) -> HullCycle:
        """Motion through the water about the wanted point, and the water's loads on the hull."""
        return on_hull(
            self.phasors,
            self.sensitivity if len(self.sensitivity) else self._insensitive(),
            self.channels,
            plane=self.plane,
            medium=self.medium,
            frequency_hz=self.frequency_hz,
            speed_m_s=self.speed_m_s,
            drift_rad=self.drift_rad,
            tare=self.tare,
            body=self.body,
            restoring=self.restoring,
            point_ahead_m=self.point_ahead_m,
            heel=self.heel,
            heel_rad=self.heel_rad,
            turn_rate_rad_s=self.turn_rate_rad_s,
        )

    @property
    def speed_slope(self) -> FloatArray:
        """How the carriage's speed follows what is stated, ``(len(STATED),)``.

        On a circle whose speed was not recorded it is the rate times the radius.
        """
        speed, rate, radius = (
            STATED.index(name) for name in ("speed_m_s", "turn_rate_relative", "turn_radius_m")
        )
        slope = np.zeros(len(STATED))
        if self.turn_rate_rad_s and not self.sensitivity[:, speed].any():
            slope[[rate, radius]] = self.speed_m_s, abs(self.turn_rate_rad_s)
        else:
            slope[speed] = 1.0
        return slope

    def _insensitive(self) -> FloatArray:
        return np.zeros((2 * len(self.phasors.names), len(STATED)))

    def without(self, body: Body | None = None, restoring: FloatArray | None = None) -> "BodyCycle":
        """Return the cycle with what is to be taken off.

        Parameters
        ----------
        body
            The model with all that moves below the dynamometers, about the midpoint.
        restoring
            Hydrostatic, shape ``(2, 2)``, about the midpoint.

        Raises
        ------
        ConfigurationError
            If a dry run was taken off already, which holds the inertia.
        """
        if body is not None and any(flag.code == DRY_TAKEN_OFF for flag in self.flags):
            raise ConfigurationError(
                f"{self.name}: a dry run was taken off; the body's inertia must not be, again"
            )
        return replace(
            self,
            body=self.body if body is None else body,
            restoring=self.restoring if restoring is None else np.asarray(restoring),
        )

    def about(self, ahead_m: float) -> "BodyCycle":
        """Return the cycle with its coefficients wanted about a point ahead of the midpoint."""
        return replace(self, point_ahead_m=ahead_m)


__all__ = ["DRY_TAKEN_OFF", "LOADS", "MOTIONS", "SURGE_FORCE", "BodyCycle", "at_order", "labels"]
