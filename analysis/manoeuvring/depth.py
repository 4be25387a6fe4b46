"""A body below the surface in the vertical plane: whether it keeps depth with fixed controls.

It is as heavy as the water that it displaces, and its weight rights it. About the point of its
derivatives, with w and q in body axes and the pitch angle theta, bow up:

    m (w' - U q - x_G q') = Z,  I_y q' - m x_G (w' - U q) = M - m g h theta

with h, by which the centre of gravity lies below that of buoyancy (Gertler and Hagen 1967, made
linear). The derivatives by w and q go with the speed U, so that the righting moment counts at low
speed and not at high.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError

NEEDED: Final = ("Z_wdot", "M_qdot", "Z_w", "Z_q", "M_w", "M_q")


@dataclass(frozen=True)
class SubmergedBody:
    """One body, or n that differ in their derivatives alone.

    Attributes
    ----------
    mass_kg, inertia_kg_m2, cg_x_m
        About the transverse axis through the point of the derivatives, and ahead of it.
    righting_n_m
        m g h, per radian of pitch.
    values
        Derivatives in the prime system by name, each of shape ``(n,)``.

    Raises
    ------
    ConfigurationError
        If one that the question needs is missing.
    """

    length_m: float
    density_kg_m3: float
    mass_kg: float
    inertia_kg_m2: float
    cg_x_m: float
    righting_n_m: float
    values: Mapping[str, FloatArray]

    def __post_init__(self) -> None:
        missing = [name for name in NEEDED if name not in self.values]
        if missing:
            raise ConfigurationError(
                f"no {', '.join(missing)}: stability in the vertical plane needs them; measure or "
                "state them"
            )

    def _si(self, name: str) -> FloatArray:
        """Return a linear derivative in SI units, over U where it is no added mass; 0 if absent."""
        load, factor = name.split("_")
        lengths = 2 + (load == "M") + factor.startswith("q") + factor.endswith("dot")
        unit = 0.5 * self.density_kg_m3 * self.length_m**lengths
        return np.asarray(unit * self.values.get(name, np.zeros(1)))

    @cached_property
    def _inertia(self) -> FloatArray:
        """Mass with added mass, shape ``(2, 2, n)``."""
        arm = self.mass_kg * self.cg_x_m
        return np.stack(
            np.broadcast_arrays(
                self.mass_kg - self._si("Z_wdot"),
                -arm - self._si("Z_qdot"),
                -arm - self._si("M_wdot"),
                self.inertia_kg_m2 - self._si("M_qdot"),
            )
        ).reshape(2, 2, -1)

    @cached_property
    def _slope(self) -> FloatArray:
        """Loads by w and q with the mass, over U, shape ``(2, 2, n)``."""
        arm = self.mass_kg * self.cg_x_m
        return np.stack(
            np.broadcast_arrays(
                self._si("Z_w"),
                self._si("Z_q") + self.mass_kg,
                self._si("M_w"),
                self._si("M_q") - arm,
            )
        ).reshape(2, 2, -1)

    @property
    def index(self) -> FloatArray:
        """G_v = 1 - M_w (Z_q + m) / (Z_w (M_q - m x_G)): above 0 a damped body is stable when fast.

        Damped is one with Z_w and M_q below 0.
        """
        (z_w, z_q), (m_w, m_q) = self._slope
        return np.asarray(1.0 - m_w * z_q / (z_w * m_q))

    @property
    def stable_speeds_m_s(self) -> tuple[FloatArray, FloatArray]:
        """Ends of the speeds between which a disturbance dies out; NaN where there are none.

        Routh's conditions on ``s^3 + U b s^2 + (U^2 c + k) s + U d``: b and d are not below 0 and
        ``b (U^2 c + k) > d``, which makes the term in s positive too.
        """
        (e11, e12), (e21, e22) = self._inertia
        (z_w, z_q), (m_w, m_q) = self._slope
        determinant = e11 * e22 - e12 * e21
        b = (e12 * m_w + e21 * z_q - e11 * m_q - e22 * z_w) / determinant
        c = (z_w * m_q - z_q * m_w) / determinant
        k, d = self.righting_n_m * e11 / determinant, -self.righting_n_m * z_w / determinant
        with np.errstate(divide="ignore", invalid="ignore"):
            crossing = np.sqrt((d - b * k) / (b * c))
        is_damped, at_rest, at_speed = (b > 0.0) & (d >= 0.0), b * k > d, c > 0.0
        low = np.where(at_rest, 0.0, np.where(at_speed, crossing, np.nan))
        high = np.where(at_speed, np.inf, np.where(at_rest, crossing, np.nan))
        return np.where(is_damped, low, np.nan), np.where(is_damped, high, np.nan)

    @property
    def critical_speed_m_s(self) -> FloatArray:
        """Speed at which stability begins or ends, by an oscillation; infinite without any."""
        low, high = self.stable_speeds_m_s
        return np.asarray(np.where(low > 0.0, low, np.where(np.isnan(high), np.inf, high)))

    def root(self, speed_m_s: float) -> FloatArray:
        """Return the largest real part of the roots of w, q and theta, 1/s; below 0 stable."""
        inertia, slope = np.moveaxis(self._inertia, 2, 0), np.moveaxis(self._slope, 2, 0)
        loads = np.zeros((len(inertia), 2, 3))
        loads[:, :, :2] = speed_m_s * slope
        loads[:, 1, 2] = -self.righting_n_m
        matrix = np.zeros((len(inertia), 3, 3))
        matrix[:, :2] = np.linalg.solve(inertia, loads)
        matrix[:, 2, 1] = 1.0
        return np.asarray(np.linalg.eigvals(matrix).real.max(axis=1))

    def reversal_speed_m_s(self, force: float, moment: float) -> FloatArray:
        """Return the speed at which a plane no longer changes depth; infinite without any.

        Below it the plane's force moves the body, above it the pitch that its moment makes.

        Parameters
        ----------
        force, moment
            Z_d and M_d of the plane in the prime system, per radian.
        """
        unit = 0.5 * self.density_kg_m3 * self.length_m**3
        share = force / self.values["Z_w"]
        with np.errstate(divide="ignore"):
            squared = -self.righting_n_m * share / (unit * (moment - self.values["M_w"] * share))
        return np.asarray(np.where(squared > 0.0, np.sqrt(np.maximum(squared, 0.0)), np.inf))
