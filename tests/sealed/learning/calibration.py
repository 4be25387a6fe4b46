"""Answers calibrated on boards with keys: isotonic shares, and split-conformal sets of answers.

Conformal sets hold what is right as often as promised for cases exchangeable with those that they
were fitted to: for boards of worlds A and B here, and not for others.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import isotonic_regression

from hardware.description.arrays import FloatArray
from tests.sealed.scoring.answers import VERDICTS, Answer
from tests.sealed.scoring.keys import Truth
from tests.sealed.scoring.right import by_class

Pair = tuple[Answer, Truth]
LEAST = 20
"""Cases that a class needs for conformal scores of its own; below, all cases are its class."""
ANY, EFFECT = "any", "effect"
_TIE = 1e-9  # keeps the order of answers that isotonic regression gives the same share


@dataclass(frozen=True, eq=False)
class Isotonic:
    """A non-decreasing map of shares, one for all answers: Zadrozny and Elkan (2002).

    Attributes
    ----------
    said, right
        Shares as they were said, increasing, and how often these were right.
    """

    said: FloatArray
    right: FloatArray

    @classmethod
    def fitted(cls, said: Sequence[float], hits: Sequence[float]) -> "Isotonic":
        """Pool adjacent violators; shares that are the same are one point of their mean."""
        points, at, counts = np.unique(np.asarray(said), return_inverse=True, return_counts=True)
        means = np.bincount(at, np.asarray(hits, float)) / counts
        return cls(points, np.asarray(isotonic_regression(means, weights=counts).x))

    @classmethod
    def of(cls, pairs: Sequence[Pair]) -> "Isotonic":
        """Fit to every share of some answers beside whether it was right."""
        rows = [
            (share, float(name in by_class(truth)))
            for answer, truth in pairs
            for name, share in answer.probabilities.items()
        ]
        return cls.fitted([said for said, _ in rows], [hit for _, hit in rows])

    def shares(self, said: Mapping[str, float]) -> dict[str, float]:
        """Return calibrated shares; they sum to 1."""
        mapped = np.interp(list(said.values()), self.said, self.right) + _TIE * np.array(
            list(said.values())
        )
        total = float(mapped.sum())
        return {name: float(share) / total for name, share in zip(said, mapped, strict=True)}


@dataclass(frozen=True, eq=False)
class Conformal:
    """Split conformal prediction, by class where a class has enough cases: Vovk et al. (2005).

    Attributes
    ----------
    strange
        Of the fitted cases, by class, one minus the share of what was right; sorted.
    """

    strange: Mapping[str, FloatArray]

    @classmethod
    def of(cls, pairs: Sequence[Pair], least: int = LEAST) -> "Conformal":
        """Fit to answers beside their keys."""
        found: dict[str, list[float]] = {}
        for answer, truth in pairs:
            name, share = _best_right(answer, truth)
            for group in (ANY, _group(name)):
                found.setdefault(group, []).append(1.0 - share)
        return cls({group: np.sort(values) for group, values in found.items()
                    if group == ANY or len(values) >= least})  # fmt: skip

    def credibility(self, name: str, share: float) -> float:
        """Return an answer's p-value: how usual its share is for one that is right."""
        own = self.strange.get(_group(name), self.strange[ANY])
        below = int(np.searchsorted(own, 1.0 - share, side="left"))
        return (1.0 + len(own) - below) / (1.0 + len(own))

    def within(self, said: Mapping[str, float], miss: float) -> list[str]:
        """Return the named answers of the set that holds what is right in ``1 - miss`` of cases."""
        return [name for name, share in said.items() if self.credibility(name, share) > miss]

    def shares(self, said: Mapping[str, float]) -> dict[str, float]:
        """Return p-values made to sum to 1: what the board scores as shares.

        An answer with a share of 0 is not among the candidates.
        """
        usual = {name: self.credibility(name, share) for name, share in said.items() if share > 0.0}
        total = sum(usual.values())
        return {name: value / total for name, value in usual.items()}


def _best_right(answer: Answer, truth: Truth) -> tuple[str, float]:
    """Return what is right and has the largest share; a failed answer has none."""
    right = sorted(by_class(truth))
    best = max(right, key=lambda name: answer.probabilities.get(name, 0.0))
    return best, answer.probabilities.get(best, 0.0)


def _group(name: str) -> str:
    return name if name in VERDICTS else EFFECT


def covered(fit: Conformal, pairs: Sequence[Pair], miss: float) -> Iterator[tuple[bool, int]]:
    """Yield for each case whether its set holds what is right, and how many that it named.

    What an answer does not name has a share of 0; where that is usual for what is right, the set
    holds all such answers too, and they are not counted.
    """
    for answer, truth in pairs:
        holds = fit.credibility(*_best_right(answer, truth)) > miss
        yield holds, len(fit.within(answer.probabilities, miss))
