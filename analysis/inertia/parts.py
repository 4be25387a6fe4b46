"""Bodies put together and taken apart by the parallel axis theorem, covariances and all."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from analysis.inertia.elementary_functions import jacobian
from analysis.uncertainty.estimate import Estimate, exactly, joint, require_positive
from analysis.uncertainty.values import UncertainValues, stacked
from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError, DataError

PRODUCTS = ("ixy_kg_m2", "ixz_kg_m2", "iyz_kg_m2")
NAMES = ("mass_kg", "x_m", "y_m", "z_m", "ixx_kg_m2", "iyy_kg_m2", "izz_kg_m2", *PRODUCTS)
_SIZE = len(NAMES)
# What a part is made of.
MADE_OF = ("mass_kg", "x_m", "y_m", "z_m", "k_roll_m", "k_pitch_m", "k_yaw_m", *PRODUCTS)


@dataclass(frozen=True)
class BodyPart:
    """A rigid body with its covariance.

    Attributes
    ----------
    name
        Unique among the parts put together.
    uncertain
        Mass, centre of gravity (x forward, y to starboard, z down, from a common datum) and inertia
        about the own centre of gravity: Ixx, Iyy, Izz and the products ``Ixy = sum m x y`` ...,
        shape ``(10,)``, kg, m, kg m2.
    """

    name: str
    uncertain: UncertainValues

    @property
    def parameters(self) -> FloatArray:
        """The values alone, shape ``(10,)``."""
        return self.uncertain.values

    @property
    def mass(self) -> Estimate:
        """Mass in kg."""
        return self._estimate(0, "kg")

    @property
    def centre_of_gravity(self) -> tuple[Estimate, Estimate, Estimate]:
        """Forward, to starboard and down of the datum, m."""
        x, y, z = (self._estimate(k, "m") for k in (1, 2, 3))
        return x, y, z

    @property
    def inertia(self) -> tuple[Estimate, Estimate, Estimate]:
        """Roll, pitch and yaw inertia about the own centre of gravity, kg m2."""
        roll, pitch, yaw = (self._estimate(k, "kg m2") for k in (4, 5, 6))
        return roll, pitch, yaw

    @property
    def products(self) -> tuple[Estimate, Estimate, Estimate]:
        """``Ixy``, ``Ixz``, ``Iyz`` about the own centre of gravity (sums), kg m2."""
        xy, xz, yz = (self._estimate(k, "kg m2") for k in (7, 8, 9))
        return xy, xz, yz

    @property
    def gyradii(self) -> tuple[Estimate, Estimate, Estimate]:
        """Roll, pitch and yaw gyradius, m; the covariance with the mass is in them."""
        mass, slope = float(self.parameters[0]), np.zeros((3, _SIZE))
        values = np.sqrt(np.maximum(self.parameters[4:7], 0.0) / mass)
        for k, value in enumerate(values):
            if value > 0.0:
                slope[k, [0, 4 + k]] = -0.5 * value / mass, 0.5 / (mass * value)
        gyradii = self.uncertain.carried(values, slope)
        roll, pitch, yaw = (Estimate(gyradii.select([k]), "m") for k in range(3))
        return roll, pitch, yaw

    def _estimate(self, k: int, unit: str) -> Estimate:
        return Estimate(self.uncertain.select([k]), unit)


_NO_PRODUCTS = (exactly(0.0, "kg m2"), exactly(0.0, "kg m2"), exactly(0.0, "kg m2"))


def part(
    name: str,
    mass: Estimate,
    position: tuple[Estimate, Estimate, Estimate],
    gyradii: tuple[Estimate, Estimate, Estimate],
    products: tuple[Estimate, Estimate, Estimate] = _NO_PRODUCTS,
) -> BodyPart:
    """Make a part from mass, centre of gravity and gyradii.

    Parameters
    ----------
    gyradii
        Roll, pitch, yaw; 0 for a point mass. Their products with the mass tie inertia to mass.
    products
        ``Ixy``, ``Ixz``, ``Iyz``: sums, kg m2.

    Raises
    ------
    ConfigurationError
        For a mass that is not above zero, or a negative gyradius.
    """
    require_positive(f"part {name!r}", mass_kg=mass.value)
    if any(gyradius.value < 0.0 for gyradius in gyradii):
        raise ConfigurationError(f"part {name!r}: a gyradius below 0; give its magnitude")
    inputs = joint((mass, *position, *gyradii, *products))

    def turn(numbers: FloatArray) -> FloatArray:
        return np.concatenate([numbers[:4], numbers[0] * numbers[4:7] ** 2, numbers[7:]])

    point = inputs.values
    return BodyPart(name, inputs.carried(np.asarray(turn(point)), jacobian(turn, point)))


def combine(name: str, parts: Sequence[BodyPart], *, without: Sequence[BodyPart] = ()) -> BodyPart:
    """Put parts together and take others away.

    Parameters
    ----------
    without
        Parts (frame, mount) that are in ``parts`` and shall not be.

    Raises
    ------
    ConfigurationError
        For no parts.
    DataError
        If no mass is left.
    """
    everything = [*parts, *without]
    if not parts:
        raise ConfigurationError(f"{name!r}: no parts to combine; at least one is needed")
    signs = np.array([1.0] * len(parts) + [-1.0] * len(without))
    inputs = stacked([body_part.uncertain for body_part in everything])
    at = inputs.values
    mass_kg = float(signs @ at[::_SIZE])
    if mass_kg <= 0.0:
        raise DataError(
            f"{name!r}: {mass_kg:.4g} kg would be left; the parts taken away weigh more than the "
            "whole"
        )

    def combined_parts(rows: FloatArray) -> FloatArray:
        return combined(rows.reshape(-1, _SIZE), signs)

    return BodyPart(
        name, inputs.carried(np.asarray(combined_parts(at)), jacobian(combined_parts, at))
    )


def combined(rows: FloatArray, signs: FloatArray) -> FloatArray:
    """Combine parameters by the signs of the parts; complex ones too.

    The result has the shape ``(10, ...)``.

    Parameters
    ----------
    rows
        Shape ``(parts, 10, ...)``: trials may follow.
    """
    mass = np.einsum("p,p...->p...", signs, rows[:, 0])
    total = mass.sum(axis=0)
    centre = np.einsum("p...,pk...->k...", mass, rows[:, 1:4]) / total
    own_moments = np.einsum("p,pk...->k...", signs, rows[:, 4:])
    shifted_moments = np.einsum("p...,pk...->k...", mass, _shifted(rows[:, 1:4] - centre))
    return np.concatenate([total[np.newaxis], centre, own_moments + shifted_moments])


def _shifted(place: FloatArray) -> FloatArray:
    """Inertia of unit masses at places, shape ``(parts, 6, ...)``."""
    x, y, z = place[:, 0], place[:, 1], place[:, 2]
    return np.stack([y * y + z * z, z * z + x * x, x * x + y * y, x * y, x * z, y * z], axis=1)
