"""One value with its unit and all that is uncertain in it."""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import count

import numpy as np

from analysis.uncertainty.distribution import Distribution
from analysis.uncertainty.values import Contribution, UncertainValues, stacked
from hardware.description.errors import ConfigurationError

_NUMBERS = count(1)


def fresh_label() -> str:
    """Return the name of an input that no other has."""
    return f"input {next(_NUMBERS)}"


@dataclass(frozen=True, eq=False)
class Estimate:
    """One value with its unit.

    Attributes
    ----------
    uncertain
        The value, with the contributions of its inputs: estimates that come from the same inputs
        are correlated by them. One entry.
    unit
        Of the value and its uncertainty.
    """

    uncertain: UncertainValues
    unit: str = "1"

    @classmethod
    def of(
        cls,
        value: float,
        uncertainty: float,
        unit: str = "1",
        degrees_of_freedom: float = math.inf,
        distribution: Distribution = Distribution.NORMAL,
        label: str | None = None,
    ) -> "Estimate":
        """Return a value that rests on one input.

        Parameters
        ----------
        uncertainty
            One standard deviation of the value itself, not of a single reading.
        degrees_of_freedom
            Infinite where the uncertainty is known otherwise than by repeats (a data sheet).
        label
            Of the input, where the same one is stated again; otherwise it is independent of all
            others.

        Raises
        ------
        ConfigurationError
            For a value or an uncertainty that cannot be, or no degrees of freedom.
        """
        if not math.isfinite(value):
            raise ConfigurationError(f"a value of {value} {unit}; it must be finite")
        if not (math.isfinite(uncertainty) and uncertainty >= 0.0):
            raise ConfigurationError(
                f"a standard uncertainty of {uncertainty} {unit} for {value:g}; "
                "it must be finite and not negative"
            )
        if not degrees_of_freedom > 0.0:
            raise ConfigurationError(
                f"{degrees_of_freedom:g} degrees of freedom for {value:g} {unit}; "
                "they must be above 0 (repeat the reading, or state an uncertainty from elsewhere)"
            )
        contribution = Contribution(
            label or fresh_label(),
            degrees_of_freedom,
            np.zeros(1, dtype=np.int64),
            np.array([[float(uncertainty)]]),
            distribution,
        )
        return cls(UncertainValues(np.array([float(value)]), (contribution,)), unit)

    @property
    def value(self) -> float:
        """In :attr:`unit`."""
        return float(self.uncertain.values[0])

    @property
    def uncertainty(self) -> float:
        """One standard deviation, in :attr:`unit`."""
        return float(self.uncertain.standard_uncertainty[0])

    @property
    def degrees_of_freedom(self) -> float:
        """Effective, by Welch and Satterthwaite."""
        return float(self.uncertain.degrees_of_freedom[0])

    @property
    def relative(self) -> float:
        """Standard uncertainty over the value's magnitude; infinite at zero."""
        return self.uncertainty / abs(self.value) if self.value else math.inf

    def half_width(self, level: float = 0.95) -> float:
        """Return the half-width of the two-sided interval of this level (Student's t)."""
        return float(self.uncertain.half_width(level)[0])

    def interval(self, level: float = 0.95) -> tuple[float, float]:
        """Return the ends of the two-sided interval of this level."""
        half = self.half_width(level)
        return self.value - half, self.value + half

    def following(self, value: float, slope: float) -> "Estimate":
        """Return a value in the same unit that follows this one with a slope."""
        return Estimate(self.uncertain.carried(np.array([value]), np.array([[slope]])), self.unit)

    def widened(
        self, uncertainty: float, degrees_of_freedom: float = math.inf, label: str | None = None
    ) -> "Estimate":
        """Return the same value with one more standard uncertainty, in ``unit``.

        Parameters
        ----------
        label
            Of the input that it comes from; by default it is independent of all others.
        """
        part = np.array([uncertainty])
        wider = self.uncertain.plus(label or fresh_label(), part, degrees_of_freedom)
        return Estimate(wider, self.unit)


def within(value: float, half_width: float, unit: str = "1") -> Estimate:
    """Return an estimate known to lie within ``value +- half_width``, evenly (a ruler, a limit)."""
    return Estimate.of(value, half_width / math.sqrt(3.0), unit, distribution=Distribution.UNIFORM)


def exactly(value: float, unit: str = "1") -> Estimate:
    """Return a value without uncertainty (a definition, a chosen reference)."""
    return Estimate.of(value, 0.0, unit)


def joint(estimates: Iterable[Estimate]) -> UncertainValues:
    """Return estimates below each other, correlated by the inputs that they share."""
    return stacked([estimate.uncertain for estimate in estimates])


def difference(first: Estimate, second: Estimate) -> Estimate:
    """Return the first less the second; what they share cancels."""
    return Estimate(joint((first, second)).mapped(np.array([[1.0, -1.0]])), first.unit)


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
