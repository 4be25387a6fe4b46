"""Coefficients with covariance, conditions, shares and what was noticed."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from analysis.coefficients.names import Form, Place, place_of
from analysis.coefficients.phasors import FloatArray
from hardware.description.errors import DataError
from hardware.description.flags import Flag
from hardware.description.oscillator import Plane


@dataclass(frozen=True)
class Conditions:
    """What coefficients hold for.

    Attributes
    ----------
    translation_amplitude_m, rotation_amplitude_rad
        Largest of the runs (amplitudes, not strokes).
    frequency_hz
        Of the harmonic that was used: the fundamental's times its order.
    point_ahead_m
        The coefficients are about this point, ahead of the midpoint.
    """

    plane: Plane
    frequency_hz: float
    speed_m_s: float
    translation_amplitude_m: float
    rotation_amplitude_rad: float
    point_ahead_m: float
    runs: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Share:
    """What one source adds to each coefficient's variance, shape ``(n,)``."""

    label: str
    variance: FloatArray
    degrees_of_freedom: float


@dataclass(frozen=True, eq=False)
class Coefficients:
    """Coefficients of one plane at one frequency and speed.

    Attributes
    ----------
    values
        Shape ``(n,)``; SI units where ``normalisation`` is ``"dimensional"``.
    covariance
        Shape ``(n, n)``; NaN where no interval can be given.
    degrees_of_freedom
        Shape ``(n,)``, by Welch and Satterthwaite.
    shares
        Where the variance comes from.
    retained
        What a coefficient's part of the load is of the largest part it is the remainder of, shape
        ``(n,)``: 0.1 loses one digit.
    misfit
        Root mean square residual of the runs over what their scatter leads to expect; NaN where
        the runs determine the coefficients without one left over.
    normalisation
        The system of the values; every table has to name it.
    """

    form: Form
    conditions: Conditions
    names: tuple[str, ...]
    units: tuple[str, ...]
    values: FloatArray
    covariance: FloatArray
    degrees_of_freedom: FloatArray
    shares: tuple[Share, ...]
    retained: FloatArray
    misfit: float
    normalisation: str = "dimensional"
    flags: tuple[Flag, ...] = ()

    def __getitem__(self, name: str) -> float:
        """Return one value.

        Raises
        ------
        ConfigurationError, DataError
            As :meth:`index`.
        """
        return float(self.values[self.index(name)])

    def index(self, name: str) -> int:
        """Return the place of a coefficient.

        Raises
        ------
        ConfigurationError
            If there is no such coefficient.
        DataError
            If these runs did not determine it.
        """
        if name in self.names:
            return self.names.index(name)
        place_of(name, self.conditions.plane, self.form)
        raise DataError(
            f"{name} was not determined by {', '.join(self.conditions.runs)} "
            f"(determined: {', '.join(self.names)})"
        )

    def places(self) -> tuple[Place, ...]:
        """Where each coefficient stands."""
        return tuple(place_of(name, self.conditions.plane, self.form) for name in self.names)

    @property
    def standard_uncertainty(self) -> FloatArray:
        """One standard deviation of each, shape ``(n,)``."""
        return np.sqrt(np.diagonal(self.covariance))

    def half_width(self, level: float = 0.95) -> FloatArray:
        """Return the half-width of each one's interval (Student's t), shape ``(n,)``."""
        from scipy.special import ndtri, stdtrit

        place = 0.5 + level / 2.0
        finite = np.where(np.isfinite(self.degrees_of_freedom), self.degrees_of_freedom, 1.0)
        factor = np.where(
            np.isfinite(self.degrees_of_freedom), stdtrit(finite, place), ndtri(place)
        )
        return np.asarray(factor * self.standard_uncertainty)

    def share_of(self, name: str) -> Mapping[str, float]:
        """Return what part of a coefficient's variance each source has, largest first."""
        k = self.index(name)
        total = sum(float(share.variance[k]) for share in self.shares)
        parts = {s.label: float(s.variance[k]) / total if total else 0.0 for s in self.shares}
        return dict(sorted(parts.items(), key=lambda item: -item[1]))

    def matrix(self, *, inertial: bool) -> FloatArray:
        """Return the coefficients per acceleration or per velocity, shape ``(2, 2)``, NaN if none.

        With the signs that the form gives them.
        """
        found = np.full((2, 2), np.nan)
        for value, place in zip(self.values, self.places(), strict=True):
            if place.inertial == inertial:
                found[place.row, place.column] = value
        return found
