"""The answers that a further run has to tell apart."""

from typing import Final

from analysis.gap.design.beside import (
    NO_GAP,
    OTHER_COEFFICIENTS,
    SOMETHING_UNKNOWN,
    Unnamed,
    odd,
)
from analysis.gap.forward.problem import Problem
from analysis.gap.inference.answers import COEFFICIENTS, NONE, ODD_RUN, UNKNOWN
from analysis.gap.search.fit import Fit
from analysis.gap.search.weighed import WeighedHypotheses

_MOST: Final = 4
_DOUBTED: Final = 0.05  # least share of a rival: odds are overconfident


def leading(weighed: WeighedHypotheses[Problem]) -> list[tuple[Fit | Unnamed, float]]:
    """Return the best named answer, those that share no effect with it, and all unnamed ones.

    Each has its probability beside it.
    """
    shares, fits = weighed.answers.by_answer, weighed.ranked
    unrelated = [fit for fit in fits[1:] if not {*fit.names} & {*fits[0].names}]
    named = [(fit, max(shares[fit.answer], _DOUBTED)) for fit in [*fits[:1], *unrelated][:_MOST]]
    runs = weighed.answers.odd_runs
    oddest = max(runs, key=lambda run: runs[run], default="")
    unnamed = [
        (NO_GAP, max(shares[NONE], _DOUBTED)),
        (SOMETHING_UNKNOWN, max(shares[UNKNOWN], _DOUBTED)),
        (OTHER_COEFFICIENTS, shares[COEFFICIENTS]),
        *([(odd(oddest), shares[ODD_RUN])] if oddest else []),
    ]
    return [*named, *unnamed]
