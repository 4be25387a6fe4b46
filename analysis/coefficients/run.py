"""One run as coefficients see it: motion and loads of the model at one frequency.

The loads are gross, as the struts exerted them. What is known of them (the model's inertia and
weight, hydrostatic restoring) is named beside them and taken off when coefficients are solved for,
so that an uncertain mass or amplitude acts there as it does in truth.
"""

import math
from dataclasses import dataclass, field, replace

import numpy as np

from analysis.coefficients.measured import StrutRun
from analysis.coefficients.phasors import FloatArray, Phasors
from analysis.motion import mass_matrix, weight_matrix
from hardware.description.body import Body
from hardware.description.errors import ConfigurationError
from hardware.description.flags import Flag, Severity
from hardware.description.oscillator import Oscillator, Plane
from hardware.description.setpoint import Medium
from hardware.description.struts import to_loads, to_motion

MOTIONS = ("translation", "rotation")
LOADS = ("force", "moment")

_SAME_FREQUENCY = 5e-3
_SAME_MOTION = 1e-2


def _nothing() -> FloatArray:
    return np.zeros((2, 2))


@dataclass(frozen=True, eq=False)
class Run:
    """Motion and loads of the model about the midpoint between the struts.

    Attributes
    ----------
    frequency_hz
        Of the fundamental; the phasors are those of harmonic ``order``.
    phasors
        ``translation`` (m), ``rotation`` (rad), ``force`` (N), ``moment`` (N m).
    body
        What is taken off as inertia and weight; ``None`` where nothing is (a dry run was).
    restoring
        Hydrostatic restoring that is taken off, N/m, N and N m; about the midpoint.
    point_ahead_m
        Where coefficients are wanted, ahead of the midpoint.
    drift_rad
        Steady heading of the model against the carriage's way, bow to starboard (bow up); the
        struts move it across this heading.
    """

    name: str
    plane: Plane
    half_spacing_m: float
    frequency_hz: float
    speed_m_s: float
    medium: Medium
    phasors: Phasors
    order: int = 1
    body: Body | None = None
    restoring: FloatArray = field(default_factory=_nothing)
    point_ahead_m: float = 0.0
    flags: tuple[Flag, ...] = ()
    drift_rad: float = 0.0

    @property
    def motion_is_asked(self) -> bool:
        """Whether the set-point's motion stands in for one that was not measured."""
        return any(flag.code == "motion_from_set_point" for flag in self.flags)

    @property
    def omega(self) -> float:
        """Angular frequency of this harmonic, rad/s."""
        return 2.0 * math.pi * self.frequency_hz * self.order

    @property
    def motion(self) -> Phasors:
        """Translation and rotation."""
        return self.phasors.select(MOTIONS)

    @property
    def loads(self) -> Phasors:
        """Force and moment, gross."""
        return self.phasors.select(LOADS)

    def known(self) -> FloatArray:
        """Return ``C + G - omega^2 M``: what inertia, weight and restoring ask per displacement."""
        total = np.array(self.restoring, dtype=np.float64)
        if self.body is not None:
            total = total + weight_matrix(self.body, self.plane)
            total = total - self.omega**2 * mass_matrix(self.body, self.plane)
        return total

    def net(self) -> Phasors:
        """Return the hydrodynamic force and moment about the point: gross less what is known."""
        carry = np.linalg.inv(point_matrix(self.point_ahead_m, self.plane)).T
        keep = np.asarray(carry @ np.hstack((-self.known(), np.eye(2))), dtype=np.float64)
        ordered = self.phasors.select((*MOTIONS, *LOADS))
        return ordered.mapped(keep, LOADS, ("N", "N m"))

    def without(self, body: Body | None = None, restoring: FloatArray | None = None) -> "Run":
        """Return the run with what is to be taken off.

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
        if body is not None and any(flag.code == "dry_run_taken_off" for flag in self.flags):
            raise ConfigurationError(
                f"{self.name}: a dry run was taken off; the body's inertia must not be, again"
            )
        return replace(
            self,
            body=self.body if body is None else body,
            restoring=self.restoring if restoring is None else np.asarray(restoring),
        )

    def without_dry(self, dry: "Run") -> "Run":
        """Return the run less a run in still air with the same motion.

        The dry loads are scaled by the ratio of the motions, which also turns them to this run's
        phase.

        Raises
        ------
        ConfigurationError
            If the dry run is not one: in water, another frequency, motion or harmonic.
        """
        self._check_dry(dry)
        wet, own = self.motion.values, dry.motion.values
        lever = np.array([1.0, self.half_spacing_m])
        ratio = np.vdot(own * lever, wet * lever) / np.vdot(own * lever, own * lever)
        left = np.abs((wet - ratio * own) * lever).max() / np.abs(wet * lever).max()
        if left > _SAME_MOTION or abs(abs(ratio) - 1.0) > 0.1:
            raise ConfigurationError(
                f"{self.name}: dry run {dry.name} moved {abs(ratio):.3g} times as far with "
                f"{100 * left:.2g} % in another motion (limits 0.9 to 1.1 and "
                f"{100 * _SAME_MOTION:g} %); run it with the same set-point"
            )
        scale = np.diag([0.0, 0.0, ratio, ratio])
        text = f"the loads of dry run {dry.name} were taken off"
        flag = Flag("dry_run_taken_off", Severity.NOTE, text)
        ordered = dry.phasors.shared.select((*MOTIONS, *LOADS)).mapped(scale)
        mine = self.phasors.select((*MOTIONS, *LOADS))
        return replace(self, phasors=mine.minus(ordered), flags=(*self.flags, flag))

    def _check_dry(self, dry: "Run") -> None:
        faults = []
        if dry.medium is not Medium.AIR:
            faults.append("it was run in water")
        if self.body is not None or dry.body is not None:
            faults.append("the body's inertia is taken off as well")
        if dry.order != self.order or dry.plane is not self.plane:
            faults.append("its harmonic or plane is another")
        if abs(dry.frequency_hz / self.frequency_hz - 1.0) > _SAME_FREQUENCY:
            faults.append(f"it ran at {dry.frequency_hz:g} Hz, not {self.frequency_hz:g} Hz")
        if faults:
            raise ConfigurationError(
                f"{self.name}: {dry.name} cannot be its dry run: {'; '.join(faults)}"
            )

    def referred_to(self, motion: str) -> "Run":
        """Return the run with all phases from this motion's own (``translation``, ``rotation``).

        Coefficients do not change; tables of loads against motion read more easily.

        Raises
        ------
        ConfigurationError
            If it does not move in that way.
        """
        return replace(self, phasors=self.phasors.referred_to(motion))

    def about(self, ahead_m: float) -> "Run":
        """Return the run with its coefficients wanted about a point ahead of the midpoint, m.

        Phasors, body and restoring stay those about the midpoint; :meth:`net` and the coefficients
        are about the point.
        """
        return replace(self, point_ahead_m=ahead_m)


def point_matrix(ahead_m: float, plane: Plane) -> FloatArray:
    """Return what turns the midpoint's motion into that of a point ahead of it.

    Its inverse, transposed, does the same to loads, because the power stays.
    """
    side = -1.0 if plane is Plane.VERTICAL else 1.0
    return np.array([[1.0, side * ahead_m], [0.0, 1.0]])


def strut_matrix(oscillator: Oscillator) -> FloatArray:
    """Return what turns the struts' displacements and forces into motion and loads, ``(4, 4)``."""
    half, plane, unit = oscillator.half_spacing_m, oscillator.plane, np.eye(2)
    whole = np.zeros((4, 4))
    whole[:2, :2] = np.stack(to_motion(unit[0], unit[1], half, plane))
    whole[2:, 2:] = np.stack(to_loads(unit[0], unit[1], half, plane))
    return whole


def from_struts(run: StrutRun) -> Run:
    """Combine the struts' phasors into motion and loads about the midpoint."""
    half, plane = run.oscillator.half_spacing_m, run.oscillator.plane
    ordered = run.phasors.select((*run.displacements.names, *run.forces.names))
    return Run(
        run.name,
        plane,
        half,
        run.frequency_hz,
        run.set_point.carriage_speed_m_s,
        run.set_point.medium,
        ordered.mapped(strut_matrix(run.oscillator), (*MOTIONS, *LOADS), ("m", "rad", "N", "N m")),
        run.order,
        flags=run.flags,
    )
