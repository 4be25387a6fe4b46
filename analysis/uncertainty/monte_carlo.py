"""GUM Supplement 1: distributions through a formula, and whether the linear budget holds."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from analysis.uncertainty.budget import (
    Budget,
    Correlations,
    Formula,
    correlation_matrix,
    linear_budget,
)
from analysis.uncertainty.estimate import Distribution, Estimate
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError

DEFAULT_TRIALS = 200_000
_MOST_LOST = 0.01


@dataclass(frozen=True)
class MonteCarlo:
    """Statistics of the trials.

    Attributes
    ----------
    mean, uncertainty
        Mean and standard deviation of the trials.
    low, high
        Ends of the probabilistically symmetric interval of 95 %.
    lost
        Part of the trials in which the formula had no finite value.
    """

    trials: int
    mean: float
    uncertainty: float
    low: float
    high: float
    lost: float


@dataclass(frozen=True)
class Assessment:
    """A linear budget and the Monte Carlo beside it.

    Attributes
    ----------
    linear_good_enough
        Whether both ends of the linear interval lie within ``tolerance`` of the Monte Carlo's.
    tolerance
        Half a unit of the second significant digit of the linear uncertainty (GUM-S1, 8.1.3), or
        four times what the trials themselves leave open, whichever is larger.
    message
        Says so in words.
    """

    budget: Budget
    monte_carlo: MonteCarlo
    linear_good_enough: bool
    tolerance: float
    message: str

    @property
    def result(self) -> Estimate:
        """The budget's result, or, where it is not good enough, the Monte Carlo's.

        The Monte Carlo's uncertainty is what its 95 % interval stands for: with two runs of a kind
        an input is so heavy in its tails that the trials' own deviation has no limit.
        """
        linear = self.budget.result
        if self.linear_good_enough:
            return linear
        mc = self.monte_carlo
        uncertainty = (mc.high - mc.low) / 2.0 / linear.coverage_factor()
        return Estimate(mc.mean, uncertainty, linear.unit, linear.degrees_of_freedom)

    @property
    def interval(self) -> tuple[float, float]:
        """The interval of 95 % of whichever holds."""
        if self.linear_good_enough:
            return self.budget.result.interval()
        return self.monte_carlo.low, self.monte_carlo.high


def draw(
    inputs: Mapping[str, Estimate],
    correlations: Correlations,
    trials: int,
    generator: Generator,
) -> dict[str, FloatArray]:
    """Draw the inputs, each of shape ``(trials,)``.

    Correlated inputs are jointly normal; a finite number of degrees of freedom widens them to
    Student's t (by the group's fewest, where they are tied to each other).
    """
    names = tuple(inputs)
    matrix = correlation_matrix(names, correlations)
    values, vectors = np.linalg.eigh(matrix)
    root = vectors * np.sqrt(np.clip(values, 0.0, None))
    normal = root @ generator.standard_normal((len(names), trials))
    tied = (np.abs(matrix) > 0.0).sum(axis=1) > 1
    fewest = min(
        (
            inputs[name].degrees_of_freedom
            for name, is_tied in zip(names, tied, strict=True)
            if is_tied
        ),
        default=math.inf,
    )
    common = _student_scale(fewest, trials, generator)
    drawn = {}
    for k, name in enumerate(names):
        estimate = inputs[name]
        if tied[k]:
            unit = normal[k] * common
        elif estimate.distribution is Distribution.NORMAL:
            unit = normal[k] * _student_scale(estimate.degrees_of_freedom, trials, generator)
        else:
            unit = _bounded(estimate.distribution, trials, generator)
        drawn[name] = estimate.value + estimate.uncertainty * unit
    return drawn


def _student_scale(freedom: float, trials: int, generator: Generator) -> FloatArray:
    if math.isinf(freedom):
        return np.ones(trials)
    return np.asarray(np.sqrt(freedom / generator.chisquare(freedom, trials)))


def _bounded(distribution: Distribution, trials: int, generator: Generator) -> FloatArray:
    if distribution is Distribution.UNIFORM:
        return math.sqrt(3.0) * generator.uniform(-1.0, 1.0, trials)
    return math.sqrt(6.0) * generator.triangular(-1.0, 0.0, 1.0, trials)


def monte_carlo(
    name: str,
    formula: Formula,
    inputs: Mapping[str, Estimate],
    *,
    seed: int,
    correlations: Correlations | None = None,
    trials: int = DEFAULT_TRIALS,
) -> MonteCarlo:
    """Propagate distributions through a formula in one vectorised call.

    Raises
    ------
    DataError
        If more than 1 % of the trials have no finite value.
    """
    drawn = draw(inputs, correlations or {}, trials, np.random.default_rng(seed))
    with np.errstate(all="ignore"):
        outcome = np.broadcast_to(np.asarray(formula(**drawn), dtype=np.float64), (trials,))
    good = outcome[np.isfinite(outcome)]
    lost = 1.0 - good.size / trials
    if lost > _MOST_LOST:
        raise DataError(
            f"{name}: {100 * lost:.1f} % of the trials have no value (limit {100 * _MOST_LOST:g} "
            "%): the inputs' uncertainties reach where the formula ends; measure them better"
        )
    low, high = np.quantile(good, (0.025, 0.975))
    return MonteCarlo(
        trials, float(good.mean()), float(good.std(ddof=1)), float(low), float(high), lost
    )


def assess(
    name: str,
    formula: Formula,
    inputs: Mapping[str, Estimate],
    *,
    unit: str = "1",
    correlations: Correlations | None = None,
    seed: int = 0,
    trials: int = DEFAULT_TRIALS,
) -> Assessment:
    """Return the linear budget with a Monte Carlo beside it, and say whether the linear one holds.

    Raises
    ------
    ConfigurationError, DataError
        As :func:`analysis.uncertainty.budget.linear_budget` and :func:`monte_carlo` do.
    """
    budget = linear_budget(name, formula, inputs, unit=unit, correlations=correlations)
    trial = monte_carlo(name, formula, inputs, seed=seed, correlations=correlations, trials=trials)
    linear = budget.result
    tolerance = max(_rounding(linear.uncertainty), 4.0 * _end_error(trial))
    low, high = linear.interval()
    worst = max(abs(low - trial.low), abs(high - trial.high))
    good = worst <= tolerance
    verdict = "holds" if good else "does not hold; the Monte Carlo's interval is the result"
    message = (
        f"{name}: the ends of the linear interval are within {worst:.2g} {unit} of the Monte "
        f"Carlo's (limit {tolerance:.2g}): the linear budget {verdict}"
    )
    return Assessment(budget, trial, good, tolerance, message)


def _rounding(uncertainty: float) -> float:
    """Half a unit of the second significant digit."""
    if uncertainty <= 0.0:
        return 0.0
    return float(0.5 * 10.0 ** (math.floor(math.log10(uncertainty)) - 1))


def _end_error(trial: MonteCarlo) -> float:
    """Standard error of a quantile at 2.5 %, for a near-normal outcome."""
    density = 0.0584 / trial.uncertainty if trial.uncertainty > 0.0 else math.inf
    return math.sqrt(0.025 * 0.975 / trial.trials) / density
