"""How well a classifier tells training campaigns that it was not fitted to: no board is touched."""

import math
from collections.abc import Iterator, Mapping, Sequence
from statistics import fmean
from typing import Final

import numpy as np

from analysis.gap.inference.answers import NAMELESS, NONE, ConsideredHypotheses
from analysis.gap.inference.constants import ODDS
from analysis.gap.search.hypotheses import COEFFICIENTS
from sim.effects.catalogue import catalogue
from tests.sealed.learning.boosted import SEED, Classifier
from tests.sealed.learning.training import Example

FOLDS: Final = 2
_LEAST: Final = 1e-9  # share, for its logarithm


def validated(found: Sequence[Example], look: str) -> Iterator[str]:
    """Yield lines on a look's classifier, each campaign told by that of the others, and on ours.

    Of all campaigns first, then of those of each kind. Ours is how probable the diagnosis held each
    answer to be. Raises as :meth:`Classifier.fitted`.
    """
    fold = np.random.default_rng(SEED).permutation(len(found)) % FOLDS
    said: dict[int, Mapping[str, float]] = {}
    for number in range(FOLDS):
        kept = [one for one, at in zip(found, fold, strict=True) if at != number]
        model = Classifier.fitted(kept, look)
        for place in np.flatnonzero(fold == number):
            said[int(place)] = model.shares(found[place].features[look])[0]
    rows = {
        f"boosted-{look}": [said[place] for place in range(len(found))],
        "diagnosis": [by_effect(ours(one)) for one in found],
    }
    kinds = [kind(one) for one in found]
    for chosen in ("", *sorted(set(kinds))):
        places = [place for place, each in enumerate(kinds) if chosen in ("", each)]
        for row, shares in rows.items():
            said_of = scored([found[at] for at in places], [shares[at] for at in places])
            yield f"{chosen or 'all'}, {row}: {said_of}"


def kind(one: Example) -> str:
    """Return what a campaign was: a verdict without a name, "one effect" or "two effects"."""
    named = [name for name in one.right if name not in NAMELESS]
    return ("one effect", "two effects")[len(named) - 1] if named else one.right[0]


def scored(found: Sequence[Example], said: Sequence[Mapping[str, float]]) -> str:
    """Return the share of campaigns whose most probable answer is right, and the mean log loss."""
    pairs = list(zip(found, said, strict=True))
    named = fmean(max(shares, key=shares.__getitem__) in one.right for one, shares in pairs)
    given = [sum(shares.get(name, 0.0) for name in one.right) for one, shares in pairs]
    loss = fmean(-math.log(max(share, _LEAST)) for share in given)
    return f"right in {named:.3f} of {len(pairs)}, mean log loss {loss:.3f}"


def by_effect(shares: Mapping[str, float]) -> dict[str, float]:
    """Return our shares as a classifier states its own: those of pairs spread over their effects.

    An effect that has no share, since these runs do not show it, has its part of that of "none".
    """
    found = dict.fromkeys([*shares, *catalogue()], 0.0)
    for answer, share in shares.items():
        names = answer.split("+")
        for name in names:
            found[name] += share / len(names)
    hidden = catalogue().keys() - {*COEFFICIENTS, *shares}
    odds = ConsideredHypotheses((), len(catalogue()) - len(COEFFICIENTS), len(hidden)).prior_of_none
    each = (odds - ODDS.none) / odds / max(len(hidden), 1)
    found |= {name: found[NONE] * each + found[name] for name in hidden}
    found[NONE] *= ODDS.none / odds
    return {name: share for name, share in found.items() if share > 0.0}


def ours(one: Example) -> dict[str, float]:
    """Return how probable the diagnosis held each answer to be."""
    of_answers = one.features["hypotheses"].items()
    return {key.removesuffix("|share"): share for key, share in of_answers if "|share" in key}
