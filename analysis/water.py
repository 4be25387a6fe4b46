"""Density and viscosity of fresh and salt water, and the numbers without dimensions built on them.

Density is that of the international one-atmosphere equation of state (Millero and Poisson 1981,
UNESCO EOS-80); viscosity of fresh water that of IAPWS SR6-08 at 0.1 MPa, times the factor of salt
of Sharqawy, Lienhard and Zubair 2010, equation 22. Both lie within 1e-4 of the tables of ITTC
7.5-02-01-03.
"""

import math
from dataclasses import dataclass
from typing import Final

from hardware.description.errors import ConfigurationError
from hardware.description.units import STANDARD_GRAVITY_M_S2

SEA_WATER_G_KG: Final = 35.16504
"""Absolute salinity of standard sea water."""
_WARMEST_DEG_C: Final = 40.0
_SALTIEST_G_KG: Final = 42.0
_FRESHEST_G_KG: Final = 0.05  # of tap water; below it stands sea water in kg/kg, which has 0.035
_PRACTICAL: Final = 35.0 / SEA_WATER_G_KG  # practical salinity per absolute salinity
_IPTS_68: Final = 1.00024  # degrees of 1968, which EOS-80 takes, per degree of today
_ZERO_K: Final = 273.15


@dataclass(frozen=True)
class Water:
    """Water of one temperature and salinity at the surface.

    Attributes
    ----------
    temperature_deg_c
        0 to 40 degrees Celsius (ITS-90).
    salinity_g_kg
        Absolute salinity: 0 for fresh water, 35.16504 for standard sea water, at most 42.

    Raises
    ------
    ConfigurationError
        If either is outside of what the equations hold for, or salinity is given in kg/kg.
    """

    temperature_deg_c: float
    salinity_g_kg: float = 0.0

    def __post_init__(self) -> None:
        for key, value, most, unit in (
            ("temperature_deg_c", self.temperature_deg_c, _WARMEST_DEG_C, "degrees Celsius"),
            ("salinity_g_kg", self.salinity_g_kg, _SALTIEST_G_KG, "g/kg"),
        ):
            if not 0.0 <= value <= most:
                raise ConfigurationError(
                    f"water: {key} = {value:g} is outside 0 to {most:g} {unit}, for which density "
                    "and viscosity are known; give the water's own"
                )
        if 0.0 < self.salinity_g_kg < _FRESHEST_G_KG:
            raise ConfigurationError(
                f"water: salinity_g_kg = {self.salinity_g_kg:g} is less than tap water has; give "
                "it in g/kg: 35 for sea water, 0 for fresh water"
            )

    @property
    def density_kg_m3(self) -> float:
        """Mass per volume, kg/m3."""
        t, s = self.temperature_deg_c * _IPTS_68, self.salinity_g_kg * _PRACTICAL
        fresh = _polynomial(
            t, 999.842594, 6.793952e-2, -9.095290e-3, 1.001685e-4, -1.120083e-6, 6.536332e-9
        )
        linear = _polynomial(t, 8.24493e-1, -4.0899e-3, 7.6438e-5, -8.2467e-7, 5.3875e-9)
        root = _polynomial(t, -5.72466e-3, 1.0227e-4, -1.6546e-6)
        return float(fresh + linear * s + root * s**1.5 + 4.8314e-4 * s**2)

    @property
    def viscosity_pa_s(self) -> float:
        """Dynamic viscosity, Pa s."""
        t, s = self.temperature_deg_c, 1e-3 * self.salinity_g_kg
        kelvin = (t + _ZERO_K) / 300.0
        terms = ((280.68, -1.9), (511.45, -7.7), (61.131, -19.6), (0.45903, -40.0))
        fresh = 1e-6 * sum(factor * kelvin**power for factor, power in terms)
        linear = _polynomial(t, 1.541, 1.998e-2, -9.52e-5)
        square = _polynomial(t, 7.974, -7.561e-2, 4.724e-4)
        return float(fresh * (1.0 + linear * s + square * s**2))

    @property
    def kinematic_viscosity_m2_s(self) -> float:
        """Viscosity over density, m2/s."""
        return self.viscosity_pa_s / self.density_kg_m3


def _polynomial(x: float, *coefficients: float) -> float:
    return sum(coefficient * x**power for power, coefficient in enumerate(coefficients))


def froude_number(
    speed_m_s: float, length_m: float, gravity_m_s2: float = STANDARD_GRAVITY_M_S2
) -> float:
    """Return speed over sqrt(g length): by the model's length Fn, by the water's depth F_nh."""
    return speed_m_s / math.sqrt(gravity_m_s2 * length_m)


def reynolds_number(speed_m_s: float, length_m: float, water: Water) -> float:
    """Return the Reynolds number U L / nu."""
    return speed_m_s * length_m / water.kinematic_viscosity_m2_s
