"""What captive runs with propeller and rudder measured, and what is known of both."""

from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from hardware.description.arrays import FloatArray, IntArray
from hardware.description.errors import DataError

MEASURED: Final = ("X", "Y", "N", "thrust", "normal force")
"""Rows of what a run measures."""
_SAME: Final = 1e-4  # of the speed: motions that differ less are one


@dataclass(frozen=True)
class Particulars:
    """Propeller and rudder as they are drawn, in metres from the point of the loads.

    Attributes
    ----------
    diameter_m, thrust
        D_P; k_0, k_1, k_2 of the open-water ``K_T = k_0 + k_1 J + k_2 J^2``.
    area_m2, height_m, slope, rudder_x_m
        A_R, H_R, f_alpha, and where the rudder's axis is, ahead: negative.
    """

    length_m: float
    density_kg_m3: float
    diameter_m: float
    thrust: tuple[float, float, float]
    area_m2: float
    height_m: float
    slope: float
    rudder_x_m: float


@dataclass(frozen=True, eq=False)
class SteeringRuns:
    """Mean values of n steady runs, or of n instants of runs that are slow enough.

    Attributes
    ----------
    names
        Of the runs.
    motion
        u, v (m/s) and r (rad/s) of the point of the loads, shape ``(3, n)``.
    rudder_rad, rate_hz
        Rudder angle, positive to turn to starboard; the propeller's rate of revolutions.
    values, uncertainty
        :data:`MEASURED` and their standard uncertainties, shape ``(5, n)``: X, Y (N) and N (N m) of
        the water on the model without inertia, thrust ahead, normal force positive to port. The
        uncertainties are those of each run alone.
    courses
        What the hull did, a name each: runs of one share the hull's own loads. Without them it is
        told from ``motion``.
    shared
        What several runs have in common, a column for each standard deviate: the readings at rest
        that were taken off, shape ``(5, n, deviates)``.

    Raises
    ------
    DataError
        If a number is missing, an uncertainty is not above 0 or a propeller stands still.
    """

    names: tuple[str, ...]
    motion: FloatArray
    rudder_rad: FloatArray
    rate_hz: FloatArray
    values: FloatArray
    uncertainty: FloatArray
    shared: FloatArray | None = None
    courses: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        faults = []
        for k, name in enumerate(self.names):
            lacking = [
                quantity
                for quantity, value, u in zip(
                    MEASURED, self.values[:, k], self.uncertainty[:, k], strict=True
                )
                if not (np.isfinite(value) and u > 0.0)
            ]
            if lacking:
                faults.append(f"{name}: no {', '.join(lacking)} with an uncertainty above 0")
            if not self.rate_hz[k] > 0.0:
                faults.append(
                    f"{name}: its propeller has no revolutions; give revolutions_hz, or leave the "
                    "run out"
                )
        if faults:
            raise DataError("; ".join(faults))

    def following_slopes(self, slopes: FloatArray) -> FloatArray:
        """Return what follows the measured numbers by slopes, per standard deviate of their errors.

        Parameters
        ----------
        slopes
            Shape ``(k, 5, n)``; the result ``(k, deviates)``.
        """
        scaled = (slopes * self.uncertainty).reshape(len(slopes), -1)
        if self.shared is None:
            return scaled
        return np.concatenate((scaled, np.einsum("kmn,mnd->kd", slopes, self.shared)), axis=1)

    @cached_property
    def speed_m_s(self) -> FloatArray:
        """U of each run."""
        return np.asarray(np.hypot(self.motion[0], self.motion[1]))

    @cached_property
    def condition(self) -> IntArray:
        """Number of each run's course: runs of one share their hull's loads."""
        if self.courses:
            return np.unique(self.courses, return_inverse=True)[1].ravel()
        speed = self.speed_m_s.max()
        scaled = np.round(self.motion / speed / _SAME).astype(np.int64)
        return np.unique(scaled, axis=1, return_inverse=True)[1].ravel()

    @cached_property
    def motions(self) -> FloatArray:
        """u, v and r of each condition, shape ``(3, conditions)``."""
        first = [int(np.flatnonzero(self.condition == k)[0]) for k in range(self.conditions)]
        return np.asarray(self.motion[:, first])

    @property
    def conditions(self) -> int:
        """How many motions there are."""
        return int(self.condition.max()) + 1

    @cached_property
    def straight_runs(self) -> IntArray:
        """Conditions of straight course."""
        moved = np.abs(self.motions[1:]).max(axis=0)
        return np.flatnonzero(moved < 10.0 * _SAME * self.speed_m_s.max())
