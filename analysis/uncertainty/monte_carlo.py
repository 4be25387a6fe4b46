"""GUM Supplement 1: distributions through a formula, and whether the linear budget holds."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.random import Generator

from analysis.uncertainty.budget import Budget, Formula, linear_budget
from analysis.uncertainty.estimate import Estimate, joint
from analysis.uncertainty.freedom import student_factor
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
    end_uncertainty
        Standard uncertainty of the less certain end, by the trials' own order statistics.
    """

    trials: int
    mean: float
    uncertainty: float
    low: float
    high: float
    end_uncertainty: float


@dataclass(frozen=True)
class Assessment:
    """A linear budget and the Monte Carlo beside it.

    Attributes
    ----------
    linear_good_enough
        Whether both ends of the linear interval lie near the Monte Carlo's: within half a unit of
        the second significant digit of the linear uncertainty (GUM-S1, 8.1.3), or four times what
        the trials themselves leave open, whichever is larger.
    """

    budget: Budget
    monte_carlo: MonteCarlo
    linear_good_enough: bool

    @cached_property
    def result(self) -> Estimate:
        """The budget's result, or, where it is not good enough, the Monte Carlo's.

        The Monte Carlo's uncertainty is what its 95 % interval stands for: with two runs of a kind
        an input is so heavy in its tails that the trials' own deviation has no limit. It comes from
        the budget's inputs, in the budget's proportions.
        """
        linear, mc = self.budget.result, self.monte_carlo
        if self.linear_good_enough:
            return linear
        half = (mc.high - mc.low) / 2.0
        if linear.uncertainty > 0.0:
            return linear.following(mc.mean, half / linear.half_width())
        return Estimate.of(mc.mean, half / float(student_factor(math.inf)), linear.unit)

    @property
    def interval(self) -> tuple[float, float]:
        """The interval of 95 % of whichever holds."""
        if self.linear_good_enough:
            return self.budget.result.interval()
        return self.monte_carlo.low, self.monte_carlo.high


def draw(
    inputs: Mapping[str, Estimate], trials: int, generator: Generator
) -> dict[str, FloatArray]:
    """Draw a formula's arguments jointly, each of shape ``(trials,)``."""
    drawn = joint(inputs.values()).draw(trials, generator)
    return dict(zip(inputs, drawn, strict=True))


def monte_carlo(
    name: str,
    formula: Formula,
    inputs: Mapping[str, Estimate],
    *,
    seed: int,
    trials: int = DEFAULT_TRIALS,
) -> MonteCarlo:
    """Propagate distributions through a formula in one vectorised call.

    Raises
    ------
    DataError
        If more than 1 % of the trials have no finite value.
    """
    drawn = draw(inputs, trials, np.random.default_rng(seed))
    with np.errstate(all="ignore"):
        outcome = np.broadcast_to(np.asarray(formula(**drawn), dtype=np.float64), (trials,))
    good = outcome[np.isfinite(outcome)]
    lost = 1.0 - good.size / trials
    if lost > _MOST_LOST:
        raise DataError(
            f"{name}: {100 * lost:.1f} % of the trials have no value (limit {100 * _MOST_LOST:g} "
            "%): the inputs' uncertainties reach where the formula ends; measure them better"
        )
    ends, spread_of_share = np.array([0.025, 0.975]), math.sqrt(0.025 * 0.975 / good.size)
    low, high = np.quantile(good, ends)
    # A share of the trials is binomial, whatever their distribution: no density need be assumed.
    above, below = (
        np.clip(ends + spread_of_share, 0.0, 1.0),
        np.clip(ends - spread_of_share, 0.0, 1.0),
    )
    spread = np.quantile(good, above) - np.quantile(good, below)
    mean, deviation = float(good.mean()), float(good.std(ddof=1))
    return MonteCarlo(trials, mean, deviation, float(low), float(high), float(spread.max() / 2.0))


def assess(
    name: str,
    formula: Formula,
    inputs: Mapping[str, Estimate],
    *,
    unit: str = "1",
    seed: int = 0,
    trials: int = DEFAULT_TRIALS,
) -> Assessment:
    """Return the linear budget with a Monte Carlo beside it, and say whether the linear one holds.

    Raises
    ------
    ConfigurationError, DataError
        As :func:`analysis.uncertainty.budget.linear_budget` and :func:`monte_carlo` do.
    """
    budget = linear_budget(name, formula, inputs, unit=unit)
    trial = monte_carlo(name, formula, inputs, seed=seed, trials=trials)
    linear = budget.result
    tolerance = max(_rounding(linear.uncertainty), 4.0 * trial.end_uncertainty)
    low, high = linear.interval()
    worst = max(abs(low - trial.low), abs(high - trial.high))
    return Assessment(budget, trial, worst <= tolerance)


def _rounding(uncertainty: float) -> float:
    """Half a unit of the second significant digit."""
    if uncertainty <= 0.0:
        return 0.0
    return float(0.5 * 10.0 ** (math.floor(math.log10(uncertainty)) - 1))
