"""How well a classifier tells training campaigns that it was not fitted to: no board is touched."""

import math
from collections.abc import Iterator, Mapping, Sequence
from statistics import fmean
from typing import Final

import numpy as np

from analysis.gap.inference.answers import NAMELESS, NONE, ConsideredHypotheses
from analysis.gap.inference.constants import ODDS
from analysis.gap.search.hypotheses import COEFFICIENTS
from hardware.description.arrays import FloatArray
from sim.effects.catalogue import catalogue
from tests.sealed.learning.boosted import SEED, Classifier, importance
from tests.sealed.learning.features import as_matrix
from tests.sealed.learning.training import Example

FOLDS: Final = 2
_SHOWN: Final = 4  # kinds of features
_LEAST: Final = 1e-9  # share, for its logarithm


def validated(found: Sequence[Example], look: str) -> Iterator[str]:
    """Yield lines on a look's classifier, each campaign told by that of the others, and on ours.

    Of all campaigns first, then of those of each kind: how well both tell them, and without which
    features the classifier is right less often. Raises as :meth:`Classifier.fitted`.
    """
    said, falls = _told(found, look)
    rows = {f"boosted-{look}": said, "diagnosis": [by_effect(ours(one)) for one in found]}
    kinds = [kind(one) for one in found]
    for chosen in ("", *sorted(set(kinds))):
        places = [place for place, each in enumerate(kinds) if chosen in ("", each)]
        for row, shares in rows.items():
            line = scored([found[at] for at in places], [shares[at] for at in places])
            yield f"{chosen or 'all'}, {row}: {line}"
        mean = {name: float(fall[places].mean()) for name, fall in falls.items()}
        most = sorted(mean, key=lambda name: -mean[name])[:_SHOWN]
        yield f"  right less often without {', '.join(f'{one} ({mean[one]:.2f})' for one in most)}"


def _told(
    found: Sequence[Example], look: str
) -> tuple[list[dict[str, float]], dict[str, FloatArray]]:
    """Return of each campaign what a classifier of the others says, and what it loses without."""
    fold = np.random.default_rng(SEED).permutation(len(found)) % FOLDS
    said: list[dict[str, float]] = [{} for _ in found]
    falls: dict[str, FloatArray] = {}
    for number in range(FOLDS):
        kept = [one for one, at in zip(found, fold, strict=True) if at != number]
        model, asked = Classifier.fitted(kept, look), np.flatnonzero(fold == number)
        for place in asked:
            said[place] = model.shares(found[place].features[look])[0]
        for name, fall in _falls(model, [found[place] for place in asked]).items():
            falls.setdefault(name, np.zeros(len(found)))[asked] = fall
    return said, falls


def _falls(model: Classifier, asked: Sequence[Example]) -> dict[str, FloatArray]:
    """Return of each campaign what the classifier loses without a kind of its features."""
    groups: dict[str, list[int]] = {}
    for place, name in enumerate(model.names):
        groups.setdefault(name.rpartition("|")[2], []).append(place)
    matrix = as_matrix([one.features[model.look] for one in asked], model.names)
    rng = np.random.default_rng(SEED)
    return importance(model.answers, matrix, [one.right for one in asked], groups, rng)


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
