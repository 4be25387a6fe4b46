"""GUM budgets: sensitivities, shares, degrees of freedom and correlations.

A formula is any function of keyword arguments that takes floats and arrays alike. Its sensitivities
are central differences of a hundredth of each uncertainty. Correlated inputs count as one input of
several deviates, with the fewest degrees of freedom of the group.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from analysis.uncertainty.estimate import Estimate
from analysis.uncertainty.values import Contribution, UncertainValues
from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError, DataError

Formula = Callable[..., Any]
Correlations = Mapping[tuple[str, str], float]

_STEP = 0.01  # of the standard uncertainty: nonlinearity is the Monte Carlo's to find


@dataclass(frozen=True)
class BudgetShare:
    """One line of a budget.

    Attributes
    ----------
    sensitivity
        Change of the result per unit of the input.
    contribution
        ``sensitivity * u(input)`` in the result's unit, with its sign.
    share
        Part of the result's variance: its own and half of every covariance it has part in, so that
        the shares add up to 1; a correlation may make one negative.
    """

    name: str
    input: Estimate
    sensitivity: float
    contribution: float
    share: float


@dataclass(frozen=True)
class Budget:
    """A result with the lines it comes from, largest share first.

    Attributes
    ----------
    correlations
        Those that were taken into account, by pairs of input names.
    """

    name: str
    result: Estimate
    shares: tuple[BudgetShare, ...]
    correlations: Correlations

    def table(self) -> list[dict[str, float | str]]:
        """Return the lines as rows: input, value, uncertainty, unit, contribution, share in %."""
        return [
            {
                "input": line.name,
                "value": line.input.value,
                "uncertainty": line.input.uncertainty,
                "unit": line.input.unit,
                "degrees_of_freedom": line.input.degrees_of_freedom,
                "contribution": line.contribution,
                "share_percent": 100.0 * line.share,
            }
            for line in self.shares
        ]


def linear_budget(
    name: str,
    formula: Formula,
    inputs: Mapping[str, Estimate],
    *,
    unit: str = "1",
    correlations: Correlations | None = None,
) -> Budget:
    """Propagate uncertainties through a formula to first order.

    Parameters
    ----------
    formula
        Called with the inputs' names as keywords.
    correlations
        Correlation coefficients by pairs of input names.

    Raises
    ------
    ConfigurationError
        If a correlation names no input, lies outside -1 to 1, or all together cannot be.
    DataError
        If the formula gives no finite value at the inputs.
    """
    correlations = dict(correlations or {})
    matrix = correlation_matrix(tuple(inputs), correlations)
    value, slopes = sensitivities(name, formula, inputs)
    contributions = slopes * np.array([estimate.uncertainty for estimate in inputs.values()])
    combined = UncertainValues(np.array([value]), _by_group(contributions, matrix, inputs))
    freedom, spread = float(combined.degrees_of_freedom[0]), float(combined.standard_uncertainty[0])
    result = Estimate(value, spread, unit, freedom)
    return Budget(name, result, _shares(inputs, slopes, contributions, matrix), correlations)


def sensitivities(
    name: str, formula: Formula, inputs: Mapping[str, Estimate]
) -> tuple[float, FloatArray]:
    """Return the formula's value at the inputs and its slope in each of them.

    Raises
    ------
    DataError
        If the formula gives no finite value there.
    """
    centre = {key: estimate.value for key, estimate in inputs.items()}
    value = float(formula(**centre))
    slopes = np.zeros(len(inputs))
    for k, (key, estimate) in enumerate(inputs.items()):
        if estimate.uncertainty > 0.0:
            step = _STEP * estimate.uncertainty
            high = float(formula(**{**centre, key: estimate.value + step}))
            low = float(formula(**{**centre, key: estimate.value - step}))
            slopes[k] = (high - low) / (2.0 * step)
    if not (math.isfinite(value) and np.isfinite(slopes).all()):
        values = ", ".join(f"{key} = {number:g}" for key, number in centre.items())
        raise DataError(f"{name}: no finite value at {values}; these inputs contradict each other")
    return value, slopes


def correlation_matrix(names: tuple[str, ...], correlations: Correlations) -> FloatArray:
    """Return the inputs' correlation matrix.

    Raises
    ------
    ConfigurationError
        If a name is unknown, a coefficient is outside -1 to 1, or they cannot hold together.
    """
    matrix = np.eye(len(names))
    for (first, second), coefficient in correlations.items():
        unknown = [key for key in (first, second) if key not in names]
        if unknown or first == second:
            raise ConfigurationError(
                f"correlation of {first!r} and {second!r}: two different inputs of "
                f"{', '.join(names)} are needed"
            )
        if not -1.0 <= coefficient <= 1.0:
            raise ConfigurationError(
                f"correlation of {first!r} and {second!r} is {coefficient:g}; from -1 to 1 it can"
            )
        i, j = names.index(first), names.index(second)
        matrix[i, j] = matrix[j, i] = coefficient
    if names and np.linalg.eigvalsh(matrix)[0] < -1e-9:
        raise ConfigurationError(
            "the correlations contradict each other (their matrix has a negative eigenvalue); "
            "lower one of them"
        )
    return matrix


def _by_group(
    contributions: FloatArray, matrix: FloatArray, inputs: Mapping[str, Estimate]
) -> tuple[Contribution, ...]:
    names, groups = tuple(inputs), []
    for group in _groups(matrix):
        values, vectors = np.linalg.eigh(matrix[np.ix_(group, group)])
        root = vectors * np.sqrt(np.clip(values, 0.0, None))
        label = " and ".join(names[k] for k in group)
        freedom = min(inputs[names[k]].degrees_of_freedom for k in group)
        parts = (contributions[group] @ root)[None]
        groups.append(Contribution(label, freedom, np.zeros(1, dtype=np.int64), parts))
    return tuple(groups)


def _groups(matrix: FloatArray) -> list[list[int]]:
    """Return the sets of inputs that correlations tie together."""
    left, groups = set(range(len(matrix))), []
    while left:
        group, fresh = set(), {min(left)}
        while fresh:
            group |= fresh
            fresh = {int(j) for i in fresh for j in np.flatnonzero(matrix[i])} - group
        groups.append(sorted(group))
        left -= group
    return groups


def _shares(
    inputs: Mapping[str, Estimate],
    slopes: FloatArray,
    contributions: FloatArray,
    matrix: FloatArray,
) -> tuple[BudgetShare, ...]:
    parts = contributions * (matrix @ contributions)
    total = float(parts.sum())
    lines = [
        BudgetShare(
            key, estimate, float(slopes[k]), float(contributions[k]), float(parts[k]) / total
        )
        if total > 0.0
        else BudgetShare(key, estimate, float(slopes[k]), 0.0, 0.0)
        for k, (key, estimate) in enumerate(inputs.items())
    ]
    return tuple(sorted(lines, key=lambda line: -abs(line.share)))
