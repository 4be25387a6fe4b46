"""Inertia in a plane from any number of axes in it: roll, yaw and their product.

About an axis at an angle phi to the z axis, in the x-z plane,

    I(phi) = Ixx sin^2 phi + Izz cos^2 phi - 2 Ixz sin phi cos phi,      Ixz = sum m x z

which three axes determine and more axes check (eqs 3, 4 and 25 for any number).
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from analysis.uncertainty.estimate import Estimate
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError


@dataclass(frozen=True)
class PlaneInertia:
    """Inertia in the centre plane.

    Attributes
    ----------
    values
        Ixx, Izz, Ixz (``sum m x z``), kg m2, shape ``(3,)``.
    covariance
        Of these, shape ``(3, 3)``.
    chi_squared, degrees_of_freedom
        How well more than three axes agree; 0 over 0 for three.
    """

    values: FloatArray
    covariance: FloatArray
    chi_squared: float
    degrees_of_freedom: int

    def estimate(self, index: int) -> Estimate:
        """Return Ixx (0), Izz (1) or Ixz (2)."""
        spread = float(np.sqrt(self.covariance[index, index]))
        return Estimate(float(self.values[index]), spread, "kg m2")

    @property
    def principal_angle_rad(self) -> float:
        """Angle ``psi`` of the principal x axis, from body x towards body z."""
        return self.principal_angle.value

    @property
    def principal_angle(self) -> Estimate:
        """The same with its standard uncertainty."""
        xx, zz, xz = self.values
        slope = np.array([xz, -xz, zz - xx]) / ((zz - xx) ** 2 + 4.0 * xz**2)
        spread = float(np.sqrt(slope @ self.covariance @ slope))
        return Estimate(float(0.5 * np.arctan(2.0 * xz / (zz - xx))), spread, "rad")


def plane_inertia(
    about: Sequence[Estimate], angle_rad: Sequence[float], *, angle_uncertainty_rad: float = 0.0
) -> PlaneInertia:
    """Fit the plane's inertia to that about several axes in it.

    Parameters
    ----------
    about
        Inertia about each axis through the centre of gravity, kg m2.
    angle_rad
        Of each axis, from body z towards body x; 0 is yaw, a quarter turn roll.
    angle_uncertainty_rad
        Standard uncertainty of each angle, independent of the others.

    Raises
    ------
    DataError
        For fewer than three axes, or axes too near to each other.
    """
    if len(about) < 3 or len(about) != len(angle_rad):
        raise DataError(
            f"plane inertia: {len(about)} inertias about {len(angle_rad)} axes; three or more of "
            "each are needed"
        )
    phi = np.asarray(angle_rad, dtype=np.float64)
    s, c = np.sin(phi), np.cos(phi)
    matrix = np.column_stack([s * s, c * c, -2.0 * s * c])
    if np.linalg.cond(matrix) > 1e3:
        degrees = ", ".join(f"{angle:.3g}" for angle in np.degrees(phi))
        raise DataError(
            f"plane inertia: axes at {degrees} deg are too near to each other; spread them over "
            "the half turn"
        )
    measured = np.array([estimate.value for estimate in about])
    rough = np.linalg.lstsq(matrix, measured, rcond=None)[0]
    slope = 2.0 * s * c * (rough[0] - rough[1]) - 2.0 * rough[2] * (c * c - s * s)
    spread = np.hypot([estimate.uncertainty for estimate in about], slope * angle_uncertainty_rad)
    weight = 1.0 / np.maximum(spread, 1e-12 * np.abs(measured))
    covariance = np.linalg.inv((matrix * weight[:, None] ** 2).T @ matrix)
    values = covariance @ (matrix.T @ (weight**2 * measured))
    left = weight * (measured - matrix @ values)
    return PlaneInertia(values, covariance, float(left @ left), phi.size - 3)


def inertias_at(xx: float, zz: float, xz: float, angle_rad: float) -> tuple[float, float]:
    """Return the inertias about the axes that lie at an angle to body x and body z."""
    s, c = math.sin(angle_rad), math.cos(angle_rad)
    product = 2.0 * xz * s * c
    return xx * c * c + zz * s * s - product, xx * s * s + zz * c * c + product
