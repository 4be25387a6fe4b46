"""The answers that a further run has to tell apart."""

from typing import Final

from analysis.gap.inference.answers import NAMELESS
from analysis.gap.search.fit import Fit
from analysis.gap.search.hypotheses import WeighedHypotheses

_MOST: Final = 4
_DOUBTED: Final = 0.05  # least share of a rival: odds are overconfident


def leading(weighed: WeighedHypotheses) -> list[tuple[Fit | None, float]]:
    """Return the most probable answer, those that share no effect with it, and no gap at last.

    Each with its probability; ``None`` stands for no gap, and for what nobody knows.
    """
    shares, fits = weighed.answers.by_answer, weighed.ranked
    unrelated = [fit for fit in fits[1:] if not {*fit.names} & {*fits[0].names}]
    answers: list[tuple[Fit | None, float]] = [
        (fit, max(shares[fit.answer], _DOUBTED)) for fit in [*fits[:1], *unrelated][:_MOST]
    ]
    return [*answers, (None, max(sum(shares[name] for name in NAMELESS), _DOUBTED))]
