"""Values with correlated uncertainties, kept as each input's contribution to every value.

A budget of one number forgets what it shares with the next. Here every input (a run's scatter, the
mass, the speed) keeps its own columns through all that follows, so that a difference of two
coefficients, or a curve through many, knows what cancels. All is linear (GUM); the same inputs are
drawn for the Monte Carlo beside it.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.random import Generator

from analysis.uncertainty.distribution import Distribution, shaped
from analysis.uncertainty.freedom import effective_freedom, student_factor
from hardware.description.arrays import FloatArray, IntArray
from hardware.description.errors import ConfigurationError


@dataclass(frozen=True, eq=False)
class Contribution:
    """Contribution of one input to some of the values.

    Attributes
    ----------
    label
        The input. Contributions with the same label are of the same deviates, wherever they stand.
    degrees_of_freedom
        Of the input's standard uncertainty; infinite where it is stated.
    rows
        Which values, shape ``(r,)``, each once.
    parts
        Change of these values per standard deviation of each of k independent deviates, shape
        ``(r, k)``, in the values' units.
    distribution
        Of the deviates.
    """

    label: str
    degrees_of_freedom: float
    rows: IntArray
    parts: FloatArray
    distribution: Distribution = Distribution.NORMAL

    def dense(self, size: int) -> FloatArray:
        """Return the parts of all values, shape ``(size, k)``."""
        parts = np.zeros((size, self.parts.shape[1]))
        parts[self.rows] = self.parts
        return parts

    def deviates(self, normal: FloatArray, generator: Generator) -> FloatArray:
        """Return the deviates in trials, made of normal ones, shape ``(k, trials)``."""
        return shaped(normal, self.distribution, self.degrees_of_freedom, generator)


@dataclass(frozen=True, eq=False)
class UncertainValues:
    """Values with the contributions of all uncertain inputs.

    Attributes
    ----------
    values
        Shape ``(n,)``.
    contributions
        One per input, with labels that differ.
    """

    values: FloatArray
    contributions: tuple[Contribution, ...] = ()

    def __len__(self) -> int:
        """Return the number of values."""
        return len(self.values)

    def covariance(self, rows: Sequence[int] | None = None) -> FloatArray:
        """Return the covariance of all values, or of some, shape ``(n, n)``."""
        chosen = self if rows is None else self.select(rows)
        size = len(chosen)
        total = np.zeros((size, size))
        for contribution in chosen.contributions:
            total[np.ix_(contribution.rows, contribution.rows)] += (
                contribution.parts @ contribution.parts.T
            )
        return total

    def correlation(self) -> FloatArray:
        """Return the correlation coefficients, shape ``(n, n)``; 0 where one has no uncertainty."""
        covariance = self.covariance()
        spread = np.sqrt(np.diag(covariance))
        scale = np.divide(1.0, spread, out=np.zeros_like(spread), where=spread > 0.0)
        return np.asarray(covariance * np.outer(scale, scale))

    def variances(self) -> FloatArray:
        """Return each input's part of each variance, shape ``(inputs, n)``, not to be changed."""
        return self._variances

    @cached_property
    def _variances(self) -> FloatArray:
        variances = np.zeros((len(self.contributions), len(self)))
        for k, contribution in enumerate(self.contributions):
            variances[k, contribution.rows] = (contribution.parts**2).sum(axis=1)
        variances.flags.writeable = False
        return variances

    @property
    def standard_uncertainty(self) -> FloatArray:
        """One standard deviation of each, shape ``(n,)``."""
        return np.asarray(np.sqrt(self.variances().sum(axis=0)))

    @property
    def degrees_of_freedom(self) -> FloatArray:
        """Effective degrees of freedom (Welch and Satterthwaite), shape ``(n,)``."""
        freedom = np.array([contribution.degrees_of_freedom for contribution in self.contributions])
        return effective_freedom(self.variances(), freedom)

    def half_width(self, level: float = 0.95) -> FloatArray:
        """Return the half-width of each one's interval (Student's t), shape ``(n,)``."""
        return student_factor(self.degrees_of_freedom, level) * self.standard_uncertainty

    def shares(self, row: int) -> Mapping[str, float]:
        """Return what part of one value's variance each input has, largest first."""
        parts = self.variances()[:, row]
        total = parts.sum()
        named = {
            contribution.label: float(part / total) if total > 0.0 else 0.0
            for contribution, part in zip(self.contributions, parts, strict=True)
            if part > 0.0
        }
        return dict(sorted(named.items(), key=lambda item: -item[1]))

    def select(self, rows: Sequence[int]) -> "UncertainValues":
        """Return some of the values, in this order."""
        chosen = np.asarray(rows, dtype=np.int64)
        place = np.full(len(self), -1)
        place[chosen] = np.arange(len(chosen))
        if len(np.unique(chosen)) != len(chosen):
            return self.mapped(np.eye(len(self))[chosen])
        acting = sorted({k for row in chosen for k in self._inputs_of[row]})
        contributions = []
        for contribution in (self.contributions[k] for k in acting):
            keep = place[contribution.rows] >= 0
            contributions.append(
                replace(
                    contribution,
                    rows=place[contribution.rows[keep]],
                    parts=contribution.parts[keep],
                )
            )
        return UncertainValues(self.values[chosen], tuple(contributions))

    @cached_property
    def _inputs_of(self) -> list[list[int]]:
        """Which inputs act on each value."""
        inputs: list[list[int]] = [[] for _ in range(len(self))]
        for k, contribution in enumerate(self.contributions):
            for row in contribution.rows:
                inputs[row].append(k)
        return inputs

    def scaled(self, factors: FloatArray) -> "UncertainValues":
        """Return each value times its factor, shape ``(n,)``, uncertainties and all."""
        contributions = tuple(
            replace(contribution, parts=contribution.parts * factors[contribution.rows][:, None])
            for contribution in self.contributions
        )
        return UncertainValues(self.values * factors, contributions)

    def mapped(self, matrix: FloatArray) -> "UncertainValues":
        """Return ``matrix @ values``, uncertainties and all; ``matrix`` has the shape (m, n)."""
        return self.carried(matrix @ self.values, matrix)

    def carried(self, values: FloatArray, slope: FloatArray) -> "UncertainValues":
        """Return ``m`` values that follow these with a slope, shape ``(m, n)``, to first order."""
        all_rows = np.arange(len(slope))
        carried_contributions = (
            replace(
                contribution,
                rows=all_rows,
                parts=slope[:, contribution.rows] @ contribution.parts,
            )
            for contribution in self.contributions
        )
        return UncertainValues(values, tuple(carried_contributions))

    def draw(self, trials: int, generator: Generator) -> FloatArray:
        """Draw all values jointly, shape ``(n, trials)``."""
        normal = [
            generator.standard_normal((contribution.parts.shape[1], trials))
            for contribution in self.contributions
        ]
        drawn = np.repeat(self.values[:, None], trials, axis=1)
        for contribution, deviates in zip(self.contributions, normal, strict=True):
            drawn[contribution.rows] += contribution.parts @ contribution.deviates(
                deviates, generator
            )
        return drawn

    def plus(self, label: str, parts: FloatArray, freedom: float = np.inf) -> "UncertainValues":
        """Return the values with one more input, or with more of one that is there.

        Parameters
        ----------
        parts
            Change of each value per standard deviation of the input, shape ``(n,)``.

        Raises
        ------
        ConfigurationError
            If the label is that of an input with several deviates.
        """
        column = np.asarray(parts, dtype=np.float64)[:, None]
        contributions = [
            contribution for contribution in self.contributions if contribution.label != label
        ]
        for contribution in self.contributions:
            if contribution.label != label:
                continue
            if contribution.parts.shape[1] != 1:
                raise ConfigurationError(
                    f"{label!r} has {contribution.parts.shape[1]} deviates, not one"
                )
            column = column + contribution.dense(len(self))
        contributions.append(Contribution(label, freedom, np.arange(len(self)), column))
        return replace(self, contributions=tuple(contributions))


def added(contributions: Iterable[Contribution]) -> tuple[Contribution, ...]:
    """Return what each input does in all: contributions of one label to the same rows added up."""
    by_label: dict[str, Contribution] = {}
    for contribution in contributions:
        before = by_label.get(contribution.label)
        by_label[contribution.label] = (
            contribution
            if before is None
            else replace(contribution, parts=before.parts + contribution.parts)
        )
    return tuple(by_label.values())


def stacked(blocks: Sequence[UncertainValues]) -> UncertainValues:
    """Put values below each other; inputs of the same label are the same input.

    Raises
    ------
    ConfigurationError
        If two inputs of one label differ in number of deviates or degrees of freedom.
    """
    gathered: dict[str, list[Contribution]] = {}
    first = 0
    for block in blocks:
        for part in block.contributions:
            moved = replace(part, rows=part.rows + first)
            gathered.setdefault(part.label, []).append(moved)
        first += len(block)
    values = np.concatenate([uncertain.values for uncertain in blocks]) if blocks else np.zeros(0)
    return UncertainValues(values, tuple(_one_input(parts) for parts in gathered.values()))


def _one_input(parts: Sequence[Contribution]) -> Contribution:
    first = parts[0]
    for contribution in parts[1:]:
        agreement = (
            contribution.degrees_of_freedom,
            contribution.distribution,
            contribution.parts.shape[1],
        ) == (
            first.degrees_of_freedom,
            first.distribution,
            first.parts.shape[1],
        )
        if not agreement:
            raise ConfigurationError(
                f"two inputs are called {first.label!r}, and they differ; give runs names that "
                "differ"
            )
    rows = np.concatenate([part.rows for part in parts])
    return replace(first, rows=rows, parts=np.concatenate([part.parts for part in parts]))
