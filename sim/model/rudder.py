"""A rudder behind hull and propeller: MMG standard method, equations 18 to 25.

Yasukawa and Yoshimura 2015, J Mar Sci Technol 20, 37-52. The race is written with thrust and
speeds, which are finite where the model stands or the propeller does.
"""

import math
from dataclasses import dataclass

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.motor import UNKNOWN_KEYS_REFUSED


@dataclass(frozen=True)
class RudderBehind:
    """A rudder behind the hull; lengths are metres ahead of the midpoint between the struts.

    Attributes
    ----------
    area_m2, height_m
        A_R and H_R.
    slope
        f_alpha, lift gradient of the normal force.
    x_m, increase_x_m, inflow_x_m
        x_R, x_H and l_R.
    resistance_deduction, force_increase
        t_R and a_H.
    wake_ratio, acceleration
        epsilon and kappa.
    straightening_plus, straightening_minus
        gamma_R for positive and for negative beta_R.
    neutral_rad
        Angle at which the rudder has no load on straight course.
    """

    area_m2: float
    height_m: float
    slope: float
    x_m: float
    increase_x_m: float
    inflow_x_m: float
    resistance_deduction: float
    force_increase: float
    wake_ratio: float
    acceleration: float
    straightening_plus: float
    straightening_minus: float
    neutral_rad: float = 0.0

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED

    def normal_force(
        self,
        motion: FloatArray,
        angle_rad: float,
        behind: FloatArray,
        race: tuple[float, FloatArray],
        density_kg_m3: float,
    ) -> FloatArray:
        """Return F_N, N, shape ``(n,)``.

        Parameters
        ----------
        motion
            u, v and r, shape ``(3, n)``.
        behind
            Speed of the water at the propeller, m/s.
        race
            The propeller's diameter, and the square of the speed that its whole acceleration would
            have, u_P^2 + 8 T / (pi rho D^2).
        """
        u, v, r = motion
        diameter, squared = race
        covered = diameter / self.height_m
        jet = behind + self.acceleration * (np.sqrt(np.maximum(squared, 0.0)) - behind)
        along = self.wake_ratio * np.sqrt(covered * jet**2 + (1.0 - covered) * behind**2)
        speed = np.hypot(u, v)
        across = speed * np.arctan2(-v, u) - self.inflow_x_m * r
        gamma = np.where(across > 0.0, self.straightening_plus, self.straightening_minus)
        across = gamma * across
        attack = angle_rad - self.neutral_rad - np.arctan2(across, along)
        pressure = 0.5 * density_kg_m3 * (along**2 + across**2)
        return np.asarray(pressure * self.area_m2 * self.slope * np.sin(attack))

    def loads(self, normal_n: FloatArray, angle_rad: float) -> FloatArray:
        """Return X, Y and N of rudder and hull that a normal force brings, shape ``(3, n)``."""
        across = -normal_n * math.cos(angle_rad)
        return np.stack(
            (
                -(1.0 - self.resistance_deduction) * normal_n * math.sin(angle_rad),
                (1.0 + self.force_increase) * across,
                (self.x_m + self.force_increase * self.increase_x_m) * across,
            )
        )
