"""How well a classifier tells training campaigns that it was not fitted to: no board is touched."""

import math
from collections.abc import Iterator, Mapping, Sequence
from statistics import fmean
from typing import Final

import numpy as np

from tests.sealed.learning.boosted import SEED, Classifier
from tests.sealed.learning.training import Example

FOLDS: Final = 2
_LEAST: Final = 1e-9  # share, for its logarithm


def validated(found: Sequence[Example], look: str) -> Iterator[str]:
    """Yield a line on a look's classifier, each campaign told by that of the others, and on ours.

    Ours is how probable the diagnosis held each answer to be. Raises as :meth:`Classifier.fitted`.
    """
    fold = np.random.default_rng(SEED).permutation(len(found)) % FOLDS
    said: dict[int, Mapping[str, float]] = {}
    for number in range(FOLDS):
        kept = [one for one, at in zip(found, fold, strict=True) if at != number]
        model = Classifier.fitted(kept, look)
        for place in np.flatnonzero(fold == number):
            said[int(place)] = model.shares(found[place].features[look])[0]
    yield f"boosted-{look}: {scored(found, [said[place] for place in range(len(found))])}"
    yield f"diagnosis: {scored(found, [_ours(one) for one in found])}"


def scored(found: Sequence[Example], said: Sequence[Mapping[str, float]]) -> str:
    """Return the share of campaigns whose most probable answer is right, and the mean log loss."""
    pairs = list(zip(found, said, strict=True))
    named = fmean(max(shares, key=shares.__getitem__) in one.right for one, shares in pairs)
    given = [sum(shares.get(name, 0.0) for name in one.right) for one, shares in pairs]
    loss = fmean(-math.log(max(share, _LEAST)) for share in given)
    return f"right in {named:.3f} of {len(pairs)}, mean log loss {loss:.3f}"


def _ours(one: Example) -> dict[str, float]:
    of_answers = one.features["hypotheses"].items()
    return {
        key.removesuffix("|share"): value for key, value in of_answers if key.endswith("|share")
    }
