"""Propeller and rudder of the MMG standard method: Yasukawa and Yoshimura 2015, equations 13 to 25.

J Mar Sci Technol 20, 37-52. Behind a hull of the length L, with the drift angle ``beta`` of the
reference point and ``r' = r L / U``.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError


class Flow(NamedTuple):
    """How the ship moves: u and v in m/s, speed U in m/s, drift beta in rad, and r'."""

    u: FloatArray
    v: FloatArray
    speed: FloatArray
    drift: FloatArray
    turning: FloatArray


@dataclass(frozen=True)
class Propeller:
    """One propeller at constant revolutions.

    Attributes
    ----------
    diameter_m
        D_P.
    thrust
        k_0, k_1, k_2 of the open-water thrust ``K_T = k_0 + k_1 J + k_2 J^2``.
    thrust_deduction, wake
        t_P, and w_P0 of straight course.
    x_relative
        x_P / L, of the drift angle at the propeller.
    wake_c1, wake_c2_plus, wake_c2_minus
        C_1 and C_2 of ``(1 - w_P)/(1 - w_P0) = 1 + (1 - exp(-C_1 |beta_P|))(C_2 - 1)``, the latter
        by the sign of beta_P; without C_1 the wake stays.
    """

    diameter_m: float
    thrust: tuple[float, float, float]
    thrust_deduction: float
    wake: float
    x_relative: float = -0.5
    wake_c1: float = 0.0
    wake_c2_plus: float = 1.0
    wake_c2_minus: float = 1.0

    def inflow(self, flow: Flow) -> FloatArray:
        """Return u_P, the speed of the water at the propeller, m/s."""
        angle = flow.drift - self.x_relative * flow.turning
        c2 = np.where(angle > 0.0, self.wake_c2_plus, self.wake_c2_minus)
        share = 1.0 + (1.0 - np.exp(-self.wake_c1 * np.abs(angle))) * (c2 - 1.0)
        return np.asarray(flow.u * (1.0 - self.wake) * share)

    def coefficient(self, advance: FloatArray) -> FloatArray:
        """Return K_T at an advance ratio J."""
        k0, k1, k2 = self.thrust
        return k0 + advance * (k1 + k2 * advance)

    def force(self, inflow: FloatArray, rate_hz: FloatArray, density_kg_m3: float) -> FloatArray:
        """Return X_P = (1 - t_P) rho n^2 D^4 K_T, N."""
        coefficient = self.coefficient(inflow / (rate_hz * self.diameter_m))
        thrust = density_kg_m3 * rate_hz**2 * self.diameter_m**4 * coefficient
        return np.asarray((1.0 - self.thrust_deduction) * thrust)

    def balancing_rate(
        self, resistance_n: FloatArray, speed_m_s: float, density_kg_m3: float
    ) -> FloatArray:
        """Return the revolutions, 1/s, whose thrust balances a resistance on straight course.

        Raises
        ------
        ConfigurationError
            If none do: the resistance is not positive, or beyond what the propeller can.
        """
        k0, k1, k2 = self.thrust
        inflow = speed_m_s * (1.0 - self.wake)
        wanted = resistance_n / (1.0 - self.thrust_deduction) / density_kg_m3 / self.diameter_m**4
        slope, rest = k1 * inflow / self.diameter_m, k2 * (inflow / self.diameter_m) ** 2 - wanted
        under = slope**2 - 4.0 * k0 * rest
        if not (np.all(resistance_n > 0.0) and k0 > 0.0 and np.all(under > 0.0)):
            raise ConfigurationError(
                f"no revolutions balance a resistance of {float(np.mean(resistance_n)):.4g} N at "
                f"{speed_m_s:g} m/s: X_0 should be below 0 and propeller.thrust that of its K_T"
            )
        return np.asarray((-slope + np.sqrt(under)) / (2.0 * k0))


@dataclass(frozen=True)
class Rudder:
    """One rudder behind the propeller.

    Attributes
    ----------
    area_m2, height_m
        A_R and H_R.
    slope
        f_alpha, lift gradient of the normal force.
    rate_deg_s
        How fast it is laid.
    resistance_deduction, force_increase, x_increase_relative
        t_R, a_H and x_H / L.
    wake_ratio, acceleration
        epsilon and kappa.
    straightening_plus, straightening_minus, lever_relative
        gamma_R for positive and for negative beta_R, and l_R / L.
    x_relative
        x_R / L.
    """

    area_m2: float
    height_m: float
    slope: float
    rate_deg_s: float
    resistance_deduction: float
    force_increase: float
    x_increase_relative: float
    wake_ratio: float
    acceleration: float
    straightening_plus: float
    straightening_minus: float
    lever_relative: float
    x_relative: float = -0.5

    def loads(
        self,
        flow: Flow,
        angle_rad: FloatArray,
        propeller: Propeller,
        rate_hz: FloatArray,
        length_m: float,
        density_kg_m3: float,
    ) -> FloatArray:
        """Return X_R, Y_R and N_R, shape ``(3, n)``; a positive angle turns to starboard."""
        behind = propeller.inflow(flow)
        advance = behind / (rate_hz * propeller.diameter_m)
        loading = 1.0 + 8.0 * propeller.coefficient(advance) / (math.pi * advance**2)
        jet = 1.0 + self.acceleration * (np.sqrt(np.maximum(loading, 0.0)) - 1.0)
        covered = propeller.diameter_m / self.height_m
        along = self.wake_ratio * behind * np.sqrt(covered * jet**2 + 1.0 - covered)
        beta = flow.drift - self.lever_relative * flow.turning
        gamma = np.where(beta > 0.0, self.straightening_plus, self.straightening_minus)
        across = flow.speed * gamma * beta
        attack = angle_rad - np.arctan2(across, along)
        squared = along**2 + across**2
        normal = 0.5 * density_kg_m3 * self.area_m2 * self.slope * squared * np.sin(attack)
        arm = length_m * (self.x_relative + self.force_increase * self.x_increase_relative)
        return np.stack(
            (
                -(1.0 - self.resistance_deduction) * normal * np.sin(angle_rad),
                -(1.0 + self.force_increase) * normal * np.cos(angle_rad),
                -arm * normal * np.cos(angle_rad),
            )
        )
