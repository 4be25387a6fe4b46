"""A value with its standard uncertainty, as all results of this package are given."""

import math
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np

from analysis.uncertainty.freedom import effective_freedom, student_factor
from hardware.description.errors import ConfigurationError


class Distribution(StrEnum):
    """What is known about where a value lies, for the Monte Carlo."""

    NORMAL = "normal"  # Student's t where the degrees of freedom are finite
    UNIFORM = "uniform"
    TRIANGULAR = "triangular"


@dataclass(frozen=True)
class Estimate:
    """A value, its standard uncertainty (one sigma) and the degrees of freedom behind it.

    Attributes
    ----------
    value, uncertainty
        In ``unit``. The uncertainty is that of the value itself, not of a single reading.
    degrees_of_freedom
        Infinite where the uncertainty is known otherwise than by repeats (a data sheet).
    distribution
        Shape that the Monte Carlo draws from.
    """

    value: float
    uncertainty: float
    unit: str = "1"
    degrees_of_freedom: float = math.inf
    distribution: Distribution = Distribution.NORMAL

    def __post_init__(self) -> None:
        if not math.isfinite(self.value):
            raise ConfigurationError(f"a value of {self.value} {self.unit}; it must be finite")
        if not (math.isfinite(self.uncertainty) and self.uncertainty >= 0.0):
            raise ConfigurationError(
                f"a standard uncertainty of {self.uncertainty} {self.unit} for {self.value:g}; "
                "it must be finite and not negative"
            )
        if not self.degrees_of_freedom > 0.0:
            raise ConfigurationError(
                f"{self.degrees_of_freedom:g} degrees of freedom for {self.value:g} {self.unit}; "
                "they must be above 0 (repeat the reading, or state an uncertainty from elsewhere)"
            )

    def coverage_factor(self, level: float = 0.95) -> float:
        """Return Student's t for a two-sided interval of this level."""
        return float(student_factor(self.degrees_of_freedom, level))

    def interval(self, level: float = 0.95) -> tuple[float, float]:
        """Return the ends of the two-sided interval of this level."""
        half = self.coverage_factor(level) * self.uncertainty
        return self.value - half, self.value + half

    def widened(self, uncertainty: float, degrees_of_freedom: float = math.inf) -> "Estimate":
        """Return the same value with one more independent standard uncertainty, in ``unit``."""
        variances = np.array([[self.uncertainty**2], [uncertainty**2]])
        freedom = np.array([self.degrees_of_freedom, degrees_of_freedom])
        return replace(
            self,
            uncertainty=math.hypot(self.uncertainty, uncertainty),
            degrees_of_freedom=float(effective_freedom(variances, freedom)[0]),
        )

    @property
    def relative(self) -> float:
        """Standard uncertainty over the value's magnitude; infinite at zero."""
        return self.uncertainty / abs(self.value) if self.value else math.inf


def within(value: float, half_width: float, unit: str = "1") -> Estimate:
    """Return an estimate known to lie within ``value +- half_width``, evenly (a ruler, a limit)."""
    return Estimate(value, half_width / math.sqrt(3.0), unit, distribution=Distribution.UNIFORM)


def exactly(value: float, unit: str = "1") -> Estimate:
    """Return a value without uncertainty (a definition, a chosen reference)."""
    return Estimate(value, 0.0, unit)


def require_positive(where: str, **values: float | Estimate) -> None:
    """Refuse values that must be above zero; of estimates, their values.

    Raises
    ------
    ConfigurationError
        Naming each key and its value.
    """
    plain = {k: v.value if isinstance(v, Estimate) else v for k, v in values.items()}
    faults = [f"{key} = {value:g}" for key, value in plain.items() if not value > 0.0]
    if faults:
        raise ConfigurationError(
            f"{where}: {', '.join(faults)} must be above 0; check the value and its unit"
        )
