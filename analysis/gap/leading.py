"""The answers that a further run has to tell apart."""

from collections.abc import Mapping
from typing import Final

from analysis.gap.fit import Fit
from analysis.gap.hypotheses import Weighed
from analysis.gap.verdict import NONE, UNKNOWN, Probabilities, answer_of

_MOST: Final = 4
_DOUBTED: Final = 0.05  # least share of a rival: odds are overconfident


def leading(weighed: Weighed, found: Probabilities) -> list[tuple[Fit | None, float]]:
    """Return the most probable answer, those that share no effect with it, and no gap at last.

    Each with its probability; ``None`` stands for no gap, and for what nobody knows.
    """
    shares = found.by_answer
    ones: list[tuple[Fit | None, float]] = [
        (one, max(shares[answer_of(one)], _DOUBTED)) for one in _different(weighed, shares)[:_MOST]
    ]
    return [*ones, (None, max(shares[NONE] + shares.get(UNKNOWN, 0.0), _DOUBTED))]


def _different(weighed: Weighed, shares: Mapping[str, float]) -> list[Fit]:
    fits = [one.fit for one in (*weighed.singles, *weighed.pairs)]
    ranked = sorted(fits, key=lambda one: -shares[answer_of(one)])
    return [one for one in ranked if one is ranked[0] or not {*one.names} & {*ranked[0].names}]
