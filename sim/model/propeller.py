"""A propeller behind the hull, from its open-water table.

Inflow, wake and deduction are those of the MMG standard method (Yasukawa and Yoshimura 2015,
J Mar Sci Technol 20, 37-52, equations 13 to 17).
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError
from hardware.description.motor import UNKNOWN_KEYS_REFUSED

if TYPE_CHECKING:
    from scipy.interpolate import PchipInterpolator


@dataclass(frozen=True)
class OpenWater:
    """A propeller in open water: table of K_T and K_Q over the advance ratio J = u / (n D).

    Attributes
    ----------
    diameter_m
        D.
    advance
        J, rising.
    thrust, torque
        ``K_T = T / (rho n^2 D^4)`` and ``K_Q = Q / (rho n^2 D^5)`` there.

    Raises
    ------
    ConfigurationError
        If the table has fewer than three lines, does not rise, or its columns differ in length.
    """

    diameter_m: float
    advance: tuple[float, ...]
    thrust: tuple[float, ...]
    torque: tuple[float, ...]

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED

    def __post_init__(self) -> None:
        faults = []
        if not self.diameter_m > 0.0:
            faults.append(f"diameter_m = {self.diameter_m:g} must be above 0")
        lengths = [len(column) for column in (self.advance, self.thrust, self.torque)]
        if len(set(lengths)) > 1 or lengths[0] < 3:
            faults.append(
                f"advance, thrust and torque have {lengths[0]}, {lengths[1]} and {lengths[2]} "
                "numbers; give as many of each, 3 or more"
            )
        elif not np.all(np.diff(self.advance) > 0.0):
            faults.append("advance must rise from number to number")
        if faults:
            raise ConfigurationError("; ".join(faults))

    def coefficients(self, advance: FloatArray) -> FloatArray:
        """Return K_T and K_Q, shape ``(2, n)``: monotone cubics through the table.

        Raises
        ------
        ConfigurationError
            If an advance ratio lies outside the table.
        """
        low, high = self.advance[0], self.advance[-1]
        beyond = (advance < low) | (advance > high)
        if np.any(beyond):
            raise ConfigurationError(
                f"the propeller would run at J = {float(advance[beyond][0]):.3g}, outside its "
                f"open-water table from {low:g} to {high:g}: extend the table, or change "
                "carriage speed or revolutions"
            )
        return np.asarray(_interpolator(self)(advance)).T


@lru_cache(maxsize=16)
def _interpolator(table: OpenWater) -> "PchipInterpolator":
    from scipy.interpolate import PchipInterpolator

    columns = np.stack((table.thrust, table.torque), axis=1)
    return PchipInterpolator(np.array(table.advance), columns)


@dataclass(frozen=True)
class PropellerBehind:
    """A propeller behind the hull.

    Attributes
    ----------
    thrust_deduction, wake
        t_P, and w_P0 of straight course.
    x_m
        Place ahead of the midpoint between the struts.
    wake_c1, wake_c2_plus, wake_c2_minus
        C_1 and C_2 of ``(1 - w_P)/(1 - w_P0) = 1 + (1 - exp(-C_1 |beta_P|))(C_2 - 1)``, the latter
        by the sign of beta_P.
    """

    open_water: OpenWater
    thrust_deduction: float
    wake: float
    x_m: float
    wake_c1: float = 0.0
    wake_c2_plus: float = 1.0
    wake_c2_minus: float = 1.0

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED

    def inflow(self, u: FloatArray, v: FloatArray, r: FloatArray) -> FloatArray:
        """Return the speed of the water at the propeller, m/s."""
        speed = np.hypot(u, v)
        turned = np.divide(self.x_m * r, speed, out=np.zeros_like(speed), where=speed > 0.0)
        angle = np.arctan2(-v, u) - turned
        c2 = np.where(angle > 0.0, self.wake_c2_plus, self.wake_c2_minus)
        grown = 1.0 + (1.0 - np.exp(-self.wake_c1 * np.abs(angle))) * (c2 - 1.0)
        return np.asarray(u * (1.0 - self.wake) * grown)

    def loads(self, inflow: FloatArray, rate_hz: float, density_kg_m3: float) -> FloatArray:
        """Return thrust (N) and torque (N m), shape ``(2, n)``; none where it stands.

        Raises
        ------
        ConfigurationError
            As :meth:`OpenWater.coefficients` does.
        """
        if rate_hz == 0.0:
            return np.zeros((2, len(inflow)))
        diameter = self.open_water.diameter_m
        unit = density_kg_m3 * rate_hz**2 * diameter**4 * np.array([[1.0], [diameter]])
        return unit * self.open_water.coefficients(inflow / (rate_hz * diameter))
