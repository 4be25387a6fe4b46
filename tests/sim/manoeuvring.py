"""Manoeuvring derivatives at forward speed as added mass and damping of a plane.

The derivatives are those of the hydrodynamic load on the hull, with the velocity through the water
as their variable: v = y' - U yaw and r (sway and yaw: Y_v, Y_r, N_v, N_r), or w = z' + U pitch and
q (heave and pitch: Z_w, Z_q, M_w, M_q). The struts exert the opposite, hence

    added mass = -((Y_vdot, Y_rdot), (N_vdot, N_rdot))        damping = -((Y_v, Y_r), (N_v, N_r))

which is what :class:`sim.model.hull.Hull` multiplies with v' and v. Forces that are not linear are
in :mod:`sim.model.water.force_laws`.
"""

import math
from dataclasses import dataclass, replace
from typing import TypeAlias

from hardware.description.errors import ConfigurationError
from sim.model.parameters import Matrix

Powers: TypeAlias = tuple[tuple[int, int], tuple[int, int]]


@dataclass(frozen=True)
class Derivatives:
    """Linear derivatives of one plane, without dimensions or in SI units.

    Attributes
    ----------
    acceleration
        ((Y_vdot, Y_rdot), (N_vdot, N_rdot)), or ((Z_wdot, Z_qdot), (M_wdot, M_qdot)).
    velocity
        ((Y_v, Y_r), (N_v, N_r)), or ((Z_w, Z_q), (M_w, M_q)). Hydrodynamic alone: published values
        of Y_r and N_r often hold the model's mass, see :meth:`without_mass`.
    """

    acceleration: Matrix
    velocity: Matrix

    def without_mass(self, mass: float, cg_x: float) -> "Derivatives":
        """Return the sway and yaw derivatives where the given Y_r is Y_r - m U.

        In that habit (Stroem-Tejsen and many since) N_r is N_r - m x_G U as well.

        Parameters
        ----------
        mass, cg_x
            m and x_G in the derivatives' own system (prime: m' and x_G / L, with U' = 1).
        """
        (y_v, y_r), (n_v, n_r) = self.velocity
        return replace(self, velocity=((y_v, y_r + mass), (n_v, n_r + mass * cg_x)))


@dataclass(frozen=True)
class PrimeSystem:
    """What turns derivatives without dimensions into SI units.

    With the density rho, the length L and the reference area S the units are (rho/2) S L for
    masses, (rho/2) S U for a force per velocity, and one L more for each moment and each rate of
    rotation.

    Attributes
    ----------
    area_m2
        L^2 in the prime system (:meth:`prime`), L d in that of the MMG (:meth:`mmg`).
    """

    length_m: float
    area_m2: float
    density_kg_m3: float

    def __post_init__(self) -> None:
        for name in ("length_m", "area_m2", "density_kg_m3"):
            _check_positive(name, getattr(self, name))

    @classmethod
    def prime(cls, length_m: float, density_kg_m3: float) -> "PrimeSystem":
        """Return the prime system of SNAME: (rho/2) L^3 for masses, (rho/2) L^5 for inertias."""
        return cls(length_m, length_m**2, density_kg_m3)

    @classmethod
    def mmg(cls, length_m: float, draught_m: float, density_kg_m3: float) -> "PrimeSystem":
        """Return the MMG's: (rho/2) L^2 d for masses, (rho/2) L^4 d for moments of inertia."""
        return cls(length_m, length_m * draught_m, density_kg_m3)

    def to_si(self, derivatives: Derivatives, speed_m_s: float) -> Derivatives:
        """Return the derivatives in SI units at one speed.

        Raises
        ------
        ConfigurationError
            If the speed is not positive: these systems have no meaning at rest.
        """
        _check_positive("speed_m_s", speed_m_s)
        half = 0.5 * self.density_kg_m3 * self.area_m2
        powers: Powers = ((0, 1), (1, 2))
        return Derivatives(
            self._scaled(derivatives.acceleration, half * self.length_m, powers),
            self._scaled(derivatives.velocity, half * speed_m_s, powers),
        )

    def mass_si(self, mass: float) -> float:
        """Return a mass without dimensions in kg."""
        return mass * 0.5 * self.density_kg_m3 * self.area_m2 * self.length_m

    def inertia_si(self, inertia: float) -> float:
        """Return a moment of inertia without dimensions in kg m^2."""
        return self.mass_si(inertia) * self.length_m**2

    def _scaled(self, matrix: Matrix, factor: float, powers: Powers) -> Matrix:
        (a, b), (c, d) = (
            tuple(factor * self.length_m**n * x for x, n in zip(row, of, strict=True))
            for row, of in zip(matrix, powers, strict=True)
        )
        return (a, b), (c, d)


def added_mass_and_damping(derivatives: Derivatives) -> tuple[Matrix, Matrix]:
    """Return the matrices of the hull from derivatives in SI units: each with its sign changed."""
    return _opposite(derivatives.acceleration), _opposite(derivatives.velocity)


def from_added_mass_and_damping(added_mass: Matrix, damping: Matrix) -> Derivatives:
    """Return the derivatives in SI units from the matrices of the hull: the inverse."""
    return Derivatives(_opposite(added_mass), _opposite(damping))


def _opposite(matrix: Matrix) -> Matrix:
    (a, b), (c, d) = matrix
    return (-a, -b), (-c, -d)


def _check_positive(name: str, value: float) -> None:
    if not (math.isfinite(value) and value > 0.0):
        raise ConfigurationError(f"{name} = {value} must be a positive number")
