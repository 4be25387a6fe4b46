"""What a further run is worth: the log odds that the right answer gains over all others."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Final

import numpy as np

from analysis.gap.design.beside import Unnamed
from analysis.gap.forward.problem import Problem
from analysis.gap.search.fit import Fit
from hardware.description.arrays import FloatArray

Leading = Sequence[tuple[Fit | Unnamed, float]]
"""The leading answers with their probabilities."""

ENOUGH: Final = 20.0  # log odds beyond which more is worth no more
_NEVER: Final = 1e-300  # least share, for its logarithm


@dataclass(frozen=True)
class Worth:
    """What a run gains.

    Attributes
    ----------
    gain
        Expected log odds that the right answer gains over all others, at most ``ENOUGH``.
    uncapped
        The same where more than enough counts.
    """

    gain: float
    uncapped: float

    @classmethod
    def of(cls, shares: Sequence[float], odds: FloatArray) -> "Worth":
        """Return the worth of a run; see :func:`expected_gain`."""
        return cls(expected_gain(shares, odds), expected_gain(shares, odds, np.inf))

    def beyond(self, other: "Worth") -> "Worth":
        """Return what it is worth more than another one."""
        return Worth(self.gain - other.gain, self.uncapped - other.uncapped)

    @property
    def order(self) -> tuple[float, float]:
        """To sort by, best first: as it is said, and what is said alike by how clearly it tells."""
        return -round(self.gain, 1), -round(self.uncapped, 1)


def expected_gain(shares: Sequence[float], odds: FloatArray, enough: float = ENOUGH) -> float:
    """Return the log odds that the right answer gains over all others, over which it may be.

    Parameters
    ----------
    shares
        How probable each answer is, shape ``(answers,)``; they need not sum to 1.
    odds
        Expected log odds between each two of the answers after a run, ``(answers, answers)``.
    enough
        Log odds between two answers beyond which more is worth no more.
    """
    if len(shares) < 2:
        return 0.0
    prior_logs = np.tile(np.log(np.maximum(shares, _NEVER)), (len(shares), 1))
    np.fill_diagonal(prior_logs, -np.inf)
    posterior_logs = prior_logs - np.minimum(odds, enough)
    # As logarithms: of what is thrown far, no number would be left.
    gain = np.logaddexp.reduce(prior_logs, axis=1) - np.logaddexp.reduce(posterior_logs, axis=1)
    return float(np.average(gain, weights=shares))


def expected_log_odds(means: FloatArray, covariances: Sequence[FloatArray]) -> FloatArray:
    """Return the log odds that each answer, where it is right, is expected to gain over each other.

    That is the Kullback-Leibler divergence of what the two predict, shape ``(answers, answers)``; a
    row is of the right answer.

    Parameters
    ----------
    means
        What each answer predicts, shape ``(observations, answers)``.
    covariances
        Of that, the noise in it, each ``(observations, observations)``.
    """
    count = means.shape[1]
    roots = [np.linalg.cholesky(covariance) for covariance in covariances]
    volumes = [2.0 * float(np.log(np.diagonal(root)).sum()) for root in roots]
    odds = np.zeros((count, count))
    for rival, root in enumerate(roots):
        white = np.linalg.solve(root, np.hstack((means - means[:, rival, None], *roots)))
        away = np.sum(white[:, :count] ** 2, axis=0)
        spread = np.sum(white[:, count:].reshape(len(root), count, len(root)) ** 2, axis=(0, 2))
        odds[:, rival] = 0.5 * (away + spread - len(root) + volumes[rival] - volumes)
    return odds


def by_itself(problem: Problem, kind: str, leading: Leading) -> FloatArray:
    """Return the log odds between answers by what does not repeat and shows in a measurement.

    It shows there as it does in a run of the campaign, at mean: in the scatter, the trends and what
    lies between the harmonics, beside the noise levels that are free.
    """
    stack = problem.simulator.stack
    rows = ~stack.steady
    effect_sets = [_shown_effects(fit, kind) for fit, _ in leading]
    shown = [
        fit.signature[rows] if isinstance(fit, Fit) and names else np.zeros(int(rows.sum()))
        for (fit, _), names in zip(leading, effect_sets, strict=True)
    ]
    free = problem.nuisances.among(rows)
    odds = np.zeros((len(effect_sets), len(effect_sets)))
    for i, j in combinations(range(len(effect_sets)), 2):
        if effect_sets[i] != effect_sets[j]:
            away = shown[i] - shown[j]
            odds[i, j] = odds[j, i] = 0.5 * away @ free.whiten(away) / len(stack.turning)
    return np.minimum(odds, ENOUGH)


def _shown_effects(answer: Fit | Unnamed, kind: str) -> set[str]:
    """Return the effects of an answer that do not repeat and show in a measurement."""
    parts = answer.candidates if isinstance(answer, Fit) else ()
    return {candidate.name for candidate in parts if kind in candidate.kind.shown_by}
