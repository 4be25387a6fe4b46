"""How far the gap shrinks: fitted on some regimes, judged on those that were withheld.

For each regime the coefficients and the effect's parameters are fitted to all other runs, in the
model linearised where the whole campaign fitted it, and predict the withheld ones. The gap is the
root mean square of measured minus predicted in units of u, with the noise's own 1 taken off.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from analysis.gap.forward.problem import Problem
from analysis.gap.inference.gaussian import posterior
from analysis.gap.observe.components import STEADY_PARTS
from analysis.gap.observe.regimes import Regime
from analysis.gap.search.fit import Fit
from hardware.description.arrays import BoolArray, FloatArray

_DRAWS = 400
_SEED = 4711


@dataclass(frozen=True, eq=False)
class Predicted:
    """One regime, withheld and predicted.

    Attributes
    ----------
    rows
        Which observations were withheld and are compared, shape ``(observations,)``.
    remainder
        Measured minus predicted in u, shape ``(withheld,)``: u holds the measurement's uncertainty
        and that of what was fitted to the other runs.
    """

    regime: Regime
    rows: BoolArray
    remainder: FloatArray


@dataclass(frozen=True)
class Shrinkage:
    """Gap before and after on the withheld regimes, in u, noise floor taken off.

    Attributes
    ----------
    share, low, high
        Part of the gap that went away, and its 95 % interval.
    """

    before: float
    after: float
    share: float
    low: float
    high: float


def predict_withheld(
    problem: Problem, fit: Fit | None, withheld: Sequence[Regime]
) -> tuple[Predicted, ...]:
    """Predict each regime from all others; without an effect for ``None``."""
    return tuple(_predicted(problem, fit, regime) for regime in withheld)


def _predicted(problem: Problem, fit: Fit | None, regime: Regime) -> Predicted:
    stack = problem.simulator.stack
    out = np.isin(stack.run, regime.runs)
    residual, columns = linear_model(problem, fit)
    nuisances = problem.nuisances.among(~out)
    estimate = posterior(residual[~out], columns[~out], nuisances)
    rest = residual - columns @ estimate.mean
    rest = rest - problem.nuisances.columns @ nuisances.fitted(rest[~out])
    steady = np.array([component.part in STEADY_PARTS for component in stack.components])
    rows = out & steady
    all_columns = np.hstack((problem.nuisances.columns, columns))
    inverse = np.linalg.inv(np.eye(all_columns.shape[1]) + all_columns[~out].T @ all_columns[~out])
    spread = np.sqrt(1.0 + np.einsum("ij,jk,ik->i", all_columns[rows], inverse, all_columns[rows]))
    return Predicted(regime, rows, rest[rows] / spread)


def linear_model(problem: Problem, fit: Fit | None) -> tuple[FloatArray, FloatArray]:
    """Return residual and columns of a hypothesis, linear about where it was fitted."""
    residual = problem.residual
    if fit is None:
        return residual, np.zeros((len(residual), 0))
    return fit.linearised(residual), fit.columns


def gap_of(remainder: FloatArray, noise: float = 0.0) -> float:
    """Return a gap in u: the root mean square with the noise's own 1 taken off.

    Parameters
    ----------
    noise
        What the mean square may be off by.
    """
    return math.sqrt(max(float(np.mean(remainder**2)) - 1.0 + noise, 0.0))


def shrinkage(before: Sequence[Predicted], after: Sequence[Predicted]) -> Shrinkage:
    """Return how far the gap shrinks, with an interval from drawing the withheld runs anew.

    What repeats is the run: all components of a run are drawn together. A mean square of n numbers
    is known to its own noise only, so that a gap of 0 is 0 within that.
    """
    pairs = [(plain.remainder, cured.remainder) for plain, cured in zip(before, after, strict=True)]
    first, second = (np.concatenate([pair[at] for pair in pairs]) for at in (0, 1))
    generator = np.random.default_rng(_SEED)
    shares = []
    for _ in range(_DRAWS):
        chosen = generator.integers(0, len(pairs), len(pairs))
        old = np.concatenate([pairs[at][0] for at in chosen])
        new = np.concatenate([pairs[at][1] for at in chosen])
        noise = generator.standard_normal() * math.sqrt(2.0 / len(new))
        shares.append(share_gone(gap_of(old), gap_of(new, noise)))
    low, high = np.quantile(shares, (0.025, 0.975))
    old_gap, new_gap = gap_of(first), gap_of(second)
    return Shrinkage(old_gap, new_gap, share_gone(old_gap, new_gap), float(low), float(high))


def share_gone(before: float, after: float) -> float:
    """Return the part of a gap that goes away; negative where it grows, 0 where there is none."""
    return 1.0 - after / before if before > 0.0 else 0.0
