"""Inertia in a plane from any number of axes in it: roll, yaw and their product.

About an axis at an angle phi to the z axis, in the x-z plane,

    I(phi) = Ixx sin^2 phi + Izz cos^2 phi - 2 Ixz sin phi cos phi,      Ixz = sum m x z

which three axes determine and more axes check (eqs 3, 4 and 25 for any number).
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from analysis.uncertainty.estimate import Estimate, joint
from analysis.uncertainty.redundancy import Redundancy, best_fit
from analysis.uncertainty.values import UncertainValues, stacked
from hardware.description.errors import DataError


@dataclass(frozen=True)
class PlaneInertia:
    """Inertia in the centre plane.

    Attributes
    ----------
    uncertain
        Ixx, Izz, Ixz (``sum m x z``), kg m2, shape ``(3,)``.
    redundancy
        How more than three axes agree. Where they do not, the scatter is in ``uncertain``.
    """

    uncertain: UncertainValues
    redundancy: Redundancy

    def estimate(self, index: int) -> Estimate:
        """Return Ixx (0), Izz (1) or Ixz (2)."""
        return Estimate(self.uncertain.select([index]), "kg m2")

    @property
    def principal_angle(self) -> Estimate:
        """Angle ``psi`` of the principal x axis, from body x towards body z, rad."""
        xx, zz, xz = self.uncertain.values
        slope = np.array([[xz, -xz, zz - xx]]) / ((zz - xx) ** 2 + 4.0 * xz**2)
        angle = np.array([0.5 * np.arctan(2.0 * xz / (zz - xx))])
        return Estimate(self.uncertain.carried(angle, slope), "rad")

    def scaled(self, factor: Estimate) -> "PlaneInertia":
        """Return the inertia times a factor that all axes share."""
        values = self.uncertain.values
        slope = np.hstack([factor.value * np.eye(3), values[:, None]])
        inputs = stacked([self.uncertain, factor.uncertain])
        return replace(self, uncertain=inputs.carried(factor.value * values, slope))


IN_PLANE = ("ixx_kg_m2", "izz_kg_m2", "ixz_kg_m2")


def plane_inertia(
    about: Sequence[Estimate], angles: Sequence[Estimate], *, results: Sequence[str] = IN_PLANE
) -> PlaneInertia:
    """Fit the plane's inertia to that about several axes in it.

    Parameters
    ----------
    about
        Inertia about each axis through the centre of gravity, kg m2.
    angles
        Of each axis, from body z towards body x, rad; 0 is yaw, a quarter turn roll.
    results
        Names of what is fitted.

    Raises
    ------
    DataError
        For fewer than three axes, or axes too near to each other.
    """
    if len(about) < 3 or len(about) != len(angles):
        raise DataError(
            f"plane inertia: {len(about)} inertias about {len(angles)} axes; three or more of "
            "each are needed"
        )
    inputs = stacked([joint(about), joint(angles)])
    measured, phi = np.split(inputs.values, 2)
    s, c = np.sin(phi), np.cos(phi)
    matrix = np.column_stack([s * s, c * c, -2.0 * s * c])
    if np.linalg.cond(matrix) > 1e3:
        degrees = ", ".join(f"{angle:.3g}" for angle in np.degrees(phi))
        raise DataError(
            f"plane inertia: axes at {degrees} deg are too near to each other; spread them over "
            "the half turn"
        )
    rough = np.linalg.lstsq(matrix, measured, rcond=None)[0]
    slope = 2.0 * s * c * (rough[0] - rough[1]) - 2.0 * rough[2] * (c * c - s * s)
    about_axes = inputs.carried(measured, np.hstack([np.eye(phi.size), -np.diag(slope)]))
    names = [f"axis at {angle:.4g} deg" for angle in np.degrees(phi)]
    fitted, redundancy = best_fit(
        matrix, about_axes, subject="inertia in the centre plane", results=results, data=names
    )
    return PlaneInertia(fitted, redundancy)


def inertias_at(xx: float, zz: float, xz: float, angle_rad: float) -> tuple[float, float]:
    """Return the inertias about the axes that lie at an angle to body x and body z."""
    s, c = math.sin(angle_rad), math.cos(angle_rad)
    product = 2.0 * xz * s * c
    return xx * c * c + zz * s * s - product, xx * s * s + zz * c * c + product
