"""GUM budgets: a formula's sensitivities, and what share each of its arguments has.

A formula is any function of keyword arguments that takes floats and arrays alike. Its sensitivities
are central differences of a hundredth of each uncertainty. Arguments that come from the same inputs
are correlated by them.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from analysis.uncertainty.estimate import Estimate, joint
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError

Formula = Callable[..., Any]

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
    """A result with the lines it comes from, largest share first."""

    name: str
    result: Estimate
    shares: tuple[BudgetShare, ...]

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
    name: str, formula: Formula, inputs: Mapping[str, Estimate], *, unit: str = "1"
) -> Budget:
    """Propagate uncertainties through a formula to first order.

    Parameters
    ----------
    formula
        Called with the inputs' names as keywords.

    Raises
    ------
    DataError
        If the formula gives no finite value at the inputs.
    """
    value, slopes = sensitivities(name, formula, inputs)
    joined = joint(inputs.values())
    result = Estimate(joined.carried(np.array([value]), slopes[None]), unit)
    return Budget(name, result, _shares(inputs, slopes, joined.covariance()))


def derived(name: str, formula: Formula, unit: str = "1", **inputs: Estimate) -> Estimate:
    """Return a formula's result alone, as :func:`linear_budget` has it."""
    return linear_budget(name, formula, inputs, unit=unit).result


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


def _shares(
    inputs: Mapping[str, Estimate], slopes: FloatArray, covariance: FloatArray
) -> tuple[BudgetShare, ...]:
    parts = slopes * (covariance @ slopes)
    total = float(parts.sum())
    shares = parts / total if total > 0.0 else np.zeros_like(parts)
    lines = [
        BudgetShare(key, estimate, float(slope), float(slope) * estimate.uncertainty, float(share))
        for (key, estimate), slope, share in zip(inputs.items(), slopes, shares, strict=True)
    ]
    return tuple(sorted(lines, key=lambda line: -abs(line.share)))
