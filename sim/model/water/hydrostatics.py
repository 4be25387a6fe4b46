"""Restoring coefficients of heave and pitch: what buoyancy adds when the hull moves.

About the midpoint between the struts, z down and pitch bow up, a waterplane of area A_w with its
first moment S and second moment I about the midpoint, and a displaced volume V with its centre z_B
below the midpoint, give the load that the struts exert

    C = rho g ((A_w, -S), (-S, I - V z_B))

without the weight (:func:`sim.model.numbers.weight_less_buoyancy`). Sway and yaw have none.
"""

import math
from dataclasses import dataclass
from typing import TypeAlias

from hardware.description.errors import ConfigurationError
from hardware.description.units import STANDARD_GRAVITY_M_S2

# Rows are force and moment, columns translation and rotation about the midpoint of the struts.
Matrix: TypeAlias = tuple[tuple[float, float], tuple[float, float]]


@dataclass(frozen=True)
class Waterplane:
    """Area of the hull at the water's surface, with its moments about the transverse axis.

    Attributes
    ----------
    area_m2
        A_w.
    first_moment_m3
        Integral of x, positive where more of the area lies ahead of the midpoint.
    second_moment_m4
        Integral of x^2.
    """

    area_m2: float
    first_moment_m3: float
    second_moment_m4: float

    def __post_init__(self) -> None:
        if not self.area_m2 > 0.0:
            raise ConfigurationError(f"area_m2 = {self.area_m2} must be positive")
        if not self.second_moment_m4 * self.area_m2 >= self.first_moment_m3**2:
            raise ConfigurationError(
                f"second_moment_m4 = {self.second_moment_m4:g} is less than the first moment of "
                f"{self.first_moment_m3:g} m^3 allows; take both about the midpoint"
            )

    @classmethod
    def box(cls, length_m: float, breadth_m: float) -> "Waterplane":
        """Return a rectangle's: L B, L^3 B / 12."""
        return cls(length_m * breadth_m, 0.0, length_m**3 * breadth_m / 12.0)

    @classmethod
    def ellipse(cls, length_m: float, breadth_m: float) -> "Waterplane":
        """Return an ellipse's, a circle's for equal axes: pi L B / 4, pi L^3 B / 64."""
        return cls(
            math.pi * length_m * breadth_m / 4.0, 0.0, math.pi * length_m**3 * breadth_m / 64.0
        )

    @classmethod
    def parabola(cls, length_m: float, breadth_m: float) -> "Waterplane":
        """Return that of breadth B (1 - (2 x/L)^2), a Wigley hull's: 2/3 L B, L^3 B / 30."""
        return cls(2.0 * length_m * breadth_m / 3.0, 0.0, length_m**3 * breadth_m / 30.0)

    def shifted(self, ahead_m: float) -> "Waterplane":
        """Return the same area moved ``ahead_m`` forward of where it was."""
        return Waterplane(
            self.area_m2,
            self.first_moment_m3 + ahead_m * self.area_m2,
            self.second_moment_m4
            + 2.0 * ahead_m * self.first_moment_m3
            + ahead_m**2 * self.area_m2,
        )


def restoring(
    waterplane: Waterplane,
    volume_m3: float,
    buoyancy_z_m: float,
    density_kg_m3: float = 1000.0,
    gravity_m_s2: float = STANDARD_GRAVITY_M_S2,
) -> Matrix:
    """Return the restoring matrix of heave and pitch: N/m and N; N and N m.

    Parameters
    ----------
    volume_m3
        Displaced volume.
    buoyancy_z_m
        Its centre from the midpoint between the struts, positive down.

    Raises
    ------
    ConfigurationError
        If the volume, the density or the gravity is negative.
    """
    for name, value in (("volume_m3", volume_m3), ("density_kg_m3", density_kg_m3)):
        if not value >= 0.0:
            raise ConfigurationError(f"{name} = {value} must not be negative")
    weight = density_kg_m3 * gravity_m_s2
    coupling = -weight * waterplane.first_moment_m3
    pitch = weight * (waterplane.second_moment_m4 - volume_m3 * buoyancy_z_m)
    return (weight * waterplane.area_m2, coupling), (coupling, pitch)
