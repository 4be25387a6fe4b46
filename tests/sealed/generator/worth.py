"""What runs tell a linear matcher of the catalogue's effects, and of what is truly there.

All that matters of a run is the products of its signatures with each other, its own scatter taken
out: those of several runs are added, and what all runs share is taken out of the sum.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from scipy.special import logsumexp

from tests.sealed.generator.case import Case
from tests.sealed.generator.ceiling import SAME, VANISHES, applicable
from tests.sealed.generator.effect import Effect
from tests.sealed.generator.features import StalledError
from tests.sealed.generator.parameters import FloatArray
from tests.sealed.generator.rig import Run
from tests.sealed.generator.signatures import Projection, Situation

DRAWS = 300
Sizes = Sequence[tuple[Effect, float]]


def sizes_of(case: Case) -> Sizes:
    """Return the effects that a case's rig can have, each at a size that stalls no shaft."""
    known = [effect for effect in case.campaign.effects if applicable(effect, case.campaign)]
    return [(effect, case.situation.tamed(effect, effect.typical)[0]) for effect in known]


@dataclass(frozen=True)
class Told:
    """What some runs tell.

    Attributes
    ----------
    effects
        Of the catalogue, in the order of the products.
    given
        How many columns of priors all runs share.
    products
        Of what a prior's standard deviation changes, of what each effect does, and of what is truly
        there, ``(given + effects + 1, given + effects + 1)``.
    """

    effects: tuple[Effect, ...]
    given: int
    products: FloatArray

    @classmethod
    def by(cls, case: Case, runs: Sequence[Run], sizes: Sizes) -> Self:
        """Return what runs tell of a case."""
        situation = replace(case.situation, runs=tuple(runs))
        p = situation.parameters
        for effect in case.content.effects:
            p = effect.put(p)
        known = np.column_stack([situation.of_prior(prior) for prior in case.campaign.known])
        shown = [
            known,
            *(_signature(situation, effect, size) for effect, size in sizes),
            _gap(situation, p),
        ]
        left = Projection.out_of(situation.of_pulses()).left(np.column_stack(shown))
        return cls(tuple(effect for effect, _ in sizes), known.shape[1], left.T @ left)

    def __add__(self, other: "Told") -> "Told":
        """Return what both tell."""
        return replace(self, products=self.products + other.products)

    def classes(self) -> dict[str, tuple[str, ...]]:
        """Return for each effect that is seen what these runs cannot tell from it, and itself."""
        seen, _, gram, _ = self._units()
        names = [self.effects[at].name for at in seen]
        return {
            name: tuple(sorted(names[j] for j in np.flatnonzero(np.abs(row) > SAME)))
            for name, row in zip(names, gram, strict=True)
        }

    def log_odds(self, right: set[str], seed: Sequence[int]) -> float:
        """Return the mean log odds of the right effects, each weighed by what it explains."""
        seen, signed, gram, matched = self._units()
        root = np.linalg.cholesky(gram + 1e-9 * np.eye(len(seen)))
        noise = np.random.default_rng(list(seed)).standard_normal((DRAWS, len(seen))) @ root.T
        products = noise + matched
        scores = np.where(signed, products, np.maximum(products, 0.0)) ** 2 / 2.0
        own = np.array([self.effects[at].name in right for at in seen])
        if own.all() or not own.any():
            return 0.0
        return float(
            np.mean(logsumexp(scores[:, own], axis=1) - logsumexp(scores[:, ~own], axis=1))
        )

    def _units(self) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Return which effects are seen, their signs, products of units, and those with truth."""
        shared, mixed = self.products[: self.given, : self.given], self.products[: self.given]
        mixed = mixed[:, self.given :]
        taken = mixed.T @ np.linalg.solve(np.eye(self.given) + shared, mixed)
        left = self.products[self.given :, self.given :] - taken
        norms = np.sqrt(np.maximum(np.diagonal(left)[:-1], 0.0))
        seen = np.flatnonzero(norms > VANISHES)
        gram = left[np.ix_(seen, seen)] / np.outer(norms[seen], norms[seen])
        signed = np.array([self.effects[at].signed for at in seen])
        return seen, signed, gram, left[seen, -1] / norms[seen]


def _signature(situation: Situation, effect: Effect, size: float) -> FloatArray:
    try:
        return situation.signature(effect, size)
    except StalledError:  # the run tells nothing of an effect under which it would not end
        return np.zeros_like(situation.base(None))


def _gap(situation: Situation, p: FloatArray) -> FloatArray:
    try:
        return situation.gap(p)
    except StalledError:
        return np.zeros_like(situation.base(None))
