"""Systems without dimensions, each with its inverse; every result names its own.

A coefficient is divided by its system's mass (A) or mass per time (B), and by one length for each
moment and each rotation: the force per rate of rotation has one length, the moment per rate two.

====================  ==================  ====================
system                A is divided by     B is divided by
====================  ==================  ====================
prime                 rho/2 L^3           rho/2 L^2 U
MMG                   rho/2 L^2 d         rho/2 L d U
seakeeping, bis       rho V               rho V sqrt(g/L)
====================  ==================  ====================

Seakeeping and Norrbin's bis system are the same where the model's own mass is rho V (mu = 1).
"""

import math
from dataclasses import dataclass

from analysis.coefficients.names import MatrixElement
from analysis.coefficients.terms import Term
from hardware.description.errors import ConfigurationError
from hardware.description.units import STANDARD_GRAVITY_M_S2

DIMENSIONAL = "dimensional"


@dataclass(frozen=True)
class Normalisation:
    """A system without dimensions.

    Attributes
    ----------
    name
        With what it is built on, for the head of a table.
    length_m
        Of levers.
    mass_kg, mass_per_second
        What force per acceleration and force per velocity are divided by.
    speed_m_s
        That the system is built on; 0 where it is built on gravity.
    """

    name: str
    length_m: float
    mass_kg: float
    mass_per_second: float
    speed_m_s: float = 0.0

    @property
    def velocity(self) -> float:
        """What velocities are divided by, m/s: U, or sqrt(g L)."""
        return self.length_m * self.mass_per_second / self.mass_kg

    def term_factor(self, term: Term) -> float:
        """Return what a manoeuvring term's coefficient is divided by, cubic ones and X alike.

        A force is divided by ``mass_per_second * velocity``, each v by the velocity, each r by
        velocity over length, their rates once more by velocity over length.
        """
        force = self.mass_per_second * self.velocity
        lengths = term.lengths + term.rates
        return float(force * self.length_m**lengths / self.velocity ** (term.degree + term.rates))

    def place_factor(self, place: MatrixElement) -> float:
        """Return what the linear coefficient at a place is divided by, in either form."""
        unit = self.mass_kg if place.inertial else self.mass_per_second
        return float(unit * self.length_m ** (place.row + place.column))


def prime(length_m: float, speed_m_s: float, density_kg_m3: float) -> Normalisation:
    """Return the prime system of SNAME: rho/2, L and U.

    Raises
    ------
    ConfigurationError
        If a quantity is not positive: at rest the system has no meaning.
    """
    _positive(length_m=length_m, speed_m_s=speed_m_s, density_kg_m3=density_kg_m3)
    area = 0.5 * density_kg_m3 * length_m**2
    name = f"prime (rho/2, L = {length_m:g} m, U = {speed_m_s:g} m/s)"
    return Normalisation(name, length_m, area * length_m, area * speed_m_s, speed_m_s)


def mmg(length_m: float, draught_m: float, speed_m_s: float, density_kg_m3: float) -> Normalisation:
    """Return the MMG system: the prime one with L d in place of L^2.

    Raises
    ------
    ConfigurationError
        If a quantity is not positive.
    """
    _positive(
        length_m=length_m,
        draught_m=draught_m,
        speed_m_s=speed_m_s,
        density_kg_m3=density_kg_m3,
    )
    area = 0.5 * density_kg_m3 * length_m * draught_m
    name = f"MMG (rho/2, L = {length_m:g} m, d = {draught_m:g} m, U = {speed_m_s:g} m/s)"
    return Normalisation(name, length_m, area * length_m, area * speed_m_s, speed_m_s)


def seakeeping(
    length_m: float,
    volume_m3: float,
    density_kg_m3: float,
    gravity_m_s2: float = STANDARD_GRAVITY_M_S2,
    name: str = "seakeeping",
) -> Normalisation:
    """Return the seakeeping system: a/(rho V) and b sqrt(L/g)/(rho V); by another name, bis.

    Raises
    ------
    ConfigurationError
        If a quantity is not positive.
    """
    _positive(
        length_m=length_m,
        volume_m3=volume_m3,
        density_kg_m3=density_kg_m3,
        gravity_m_s2=gravity_m_s2,
    )
    mass = density_kg_m3 * volume_m3
    label = f"{name} (rho V, V = {volume_m3:g} m3, L = {length_m:g} m)"
    return Normalisation(label, length_m, mass, mass * math.sqrt(gravity_m_s2 / length_m))


def _positive(**values: float) -> None:
    faults = [f"{name} = {value:g}" for name, value in values.items() if not value > 0.0]
    if faults:
        raise ConfigurationError(
            f"{', '.join(faults)} must be above 0 for coefficients without dimensions"
        )
