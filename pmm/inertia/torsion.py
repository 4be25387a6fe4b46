"""A body on a torsion rod: inertia about one axis, or in a plane from several."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from analysis.inertia.compound_pendulum import torsional_inertia, torsional_stiffness
from analysis.inertia.elementary_functions import Value, sqrt
from analysis.inertia.plane_inertia import IN_PLANE, PlaneInertia, inertias_at, plane_inertia
from analysis.uncertainty.budget import derived
from analysis.uncertainty.estimate import Estimate, exactly
from analysis.uncertainty.monte_carlo import Assessment, assess
from hardware.description.errors import DataError
from pmm.inertia.experiment import Experiment
from pmm.inertia.outcome import Finding, PlaneAxes, assessed
from pmm.inertia.period_source import AngledPeriod, PeriodSource
from pmm.inertia.reading import one_of
from pmm.inertia.stated_values import stated_value


@dataclass(frozen=True)
class BarTable:
    """A round bar whose inertia across its length calibrates the rod."""

    mass_kg: float
    length_m: float
    period: PeriodSource
    u_mass_kg: float = 0.0
    u_length_m: float = 0.0
    diameter_m: float = 0.0
    u_diameter_m: float = 0.0


@dataclass(frozen=True)
class TorsionAxis(AngledPeriod):
    """The body hung with the rod at an angle to its z axis, towards x."""


@dataclass(frozen=True)
class TorsionTable:
    """The rod, by its stiffness or by a bar on it; ``axes`` for inertia in the x-z plane.

    ``u_common_angle`` is the standard uncertainty that all axes' angles share: that of the level
    or the datum from which they are measured.
    """

    stiffness_n_m_rad: float | None = None
    u_stiffness_n_m_rad: float = 0.0
    bar: BarTable | None = None
    axes: tuple[TorsionAxis, ...] = ()
    u_common_angle_deg: float = 0.0
    u_common_angle_rad: float = 0.0

    @staticmethod
    def rules(table: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
        """One way to the stiffness; in a plane, three axes or more."""
        yield from one_of(table, "stiffness_n_m_rad", "bar")
        yield from one_of(table, "u_common_angle_deg", "u_common_angle_rad", needed=False)
        axes = table.get("axes")
        if not axes and {"u_common_angle_deg", "u_common_angle_rad"} & set(table):
            yield "u_common_angle", "is of several axes; add [[torsion.axes]]"
        if isinstance(axes, list) and len(axes) < 3:
            yield "axes", f"are {len(axes)}; roll, yaw and their product need three or more"


def stiffness(test: Experiment[Any], table: TorsionTable, seed: int) -> Estimate:
    """Return the rod's stiffness, as given or by its bar."""
    if table.bar is None:
        return stated_value(table, "stiffness_n_m_rad")
    inputs = {key: stated_value(table.bar, key) for key in ("mass_kg", "length_m", "diameter_m")}
    inputs["period_s"] = test.period(table.bar.period, "torsion.bar.period").period

    def rod(mass_kg: Value, length_m: Value, diameter_m: Value, period_s: Value) -> Value:
        square = length_m * length_m / 12.0 + diameter_m * diameter_m / 16.0
        return torsional_stiffness(mass_kg * square, period_s)

    assessment = assess("c", rod, inputs, unit="N m/rad", seed=seed)
    test.findings.append(assessed("stiffness_n_m_rad", "torsion rod: stiffness", assessment))
    return assessment.budget.result


def about_rod(rod: Estimate, period: Estimate, seed: int) -> Assessment:
    """Return the inertia of what hangs, about the rod."""
    inputs = {"stiffness_n_m_rad": rod, "period_s": period}
    return assess("I", torsional_inertia, inputs, unit="kg m2", seed=seed)


@dataclass(frozen=True)
class TorsionPlane:
    """Inertia in the x-z plane, and about the axes that it comes from.

    Attributes
    ----------
    axes
        Angle of each axis to body z, and the inertia about it.
    """

    inertia: PlaneInertia
    axes: tuple[tuple[float, Estimate], ...]

    def findings(self) -> Iterator[Finding]:
        """Yield roll, yaw and product of inertia, and the principal axis."""
        for k, (name, words) in enumerate(zip(IN_PLANE, _WORDS, strict=True)):
            yield Finding(name, words, self.inertia.estimate(k))
        yield Finding("psi_rad", "principal x axis, from body x", self.inertia.principal_angle)

    def ellipse(self, mass: Estimate) -> PlaneAxes:
        """Return the principal gyradii of a body of that mass, with the measured axes.

        Raises
        ------
        DataError
            If a principal inertia is not above zero.
        """
        xx, zz, xz = (float(value) for value in self.inertia.uncertain.values)
        psi = self.inertia.principal_angle.value
        first, second = inertias_at(xx, zz, xz, psi)
        if min(first, second) <= 0.0:
            raise DataError(
                f"principal inertias of {first:.3g} and {second:.3g} kg m2 cannot be: check the "
                "axes' angles (from body z towards body x)"
            )
        measured = tuple((angle, _gyradius(about, mass)) for angle, about in self.axes)
        roll, yaw = (math.sqrt(inertia / mass.value) for inertia in (first, second))
        return PlaneAxes(roll, yaw, psi, measured)


_WORDS = ("roll inertia", "yaw inertia", "product of inertia, sum m x z")


def _gyradius(inertia: Estimate, mass: Estimate) -> Estimate:
    return derived("k", lambda about, mass: sqrt(about / mass), "m", about=inertia, mass=mass)


def in_plane(test: Experiment[Any], torsion: TorsionTable, rod: Estimate) -> TorsionPlane:
    """Return the inertia in the x-z plane from several axes, among the test's findings too.

    Raises
    ------
    DataError
        If the axes are too near to each other.
    """
    stiff = exactly(rod.value, rod.unit)  # its own uncertainty is a factor that all axes share
    angles, about = [], []
    common = torsion.u_common_angle_rad + math.radians(torsion.u_common_angle_deg)
    for number, axis in enumerate(torsion.axes, 1):
        runs = test.period(axis, f"torsion.axes[{number}]")
        angles.append(axis.angle.widened(common, label="torsion.common_angle"))
        inputs = {"stiffness_n_m_rad": stiff, "period_s": runs.period}
        about.append(derived("I", torsional_inertia, "kg m2", **inputs))
    inertia = plane_inertia(about, angles).scaled(rod.following(1.0, 1.0 / rod.value))
    measured = tuple((angle.value, estimate) for angle, estimate in zip(angles, about, strict=True))
    plane = TorsionPlane(inertia, measured)
    test.findings += plane.findings()
    test.redundancy.append(inertia.redundancy)
    return plane
