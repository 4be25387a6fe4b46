"""What was fitted, and how probable each answer is, of whatever was tested."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

from analysis.gap.forward.problem import ComparedProblem
from analysis.gap.inference.answers import (
    Answers,
    ConsideredHypotheses,
    answers,
    prior,
    weight,
)
from analysis.gap.inference.evidence import Background
from analysis.gap.search.first_look import FirstLook
from analysis.gap.search.fit import Fit
from analysis.gap.search.linear_hypothesis import hypothesis, settled_fit
from hardware.description.errors import DataError

P = TypeVar("P", bound=ComparedProblem)


@dataclass(frozen=True, eq=False)
class WeighedHypotheses(Generic[P]):
    """All hypotheses, and how probable each is.

    Attributes
    ----------
    ranked
        Named ones, most probable first, each beside the deviation that suits it best.
    first_looks
        At every effect that was looked at.
    background
        What stands beside every hypothesis.
    count, concealed
        How many effects were considered, and how many of them these records cannot show, or do not.
    """

    problem: P
    ranked: tuple[Fit, ...]
    first_looks: tuple[FirstLook, ...]
    background: Background
    answers: Answers
    count: int
    concealed: int

    @property
    def singles(self) -> tuple[Fit, ...]:
        """Those of one effect."""
        return tuple(fit for fit in self.ranked if len(fit.candidates) == 1)

    @property
    def hidden(self) -> tuple[str, ...]:
        """Effects that cannot be seen, in alphabetical order."""
        return tuple(sorted(look.name for look in self.first_looks if look.is_hidden))

    @property
    def refused(self) -> Mapping[str, str]:
        """Effects that this test cannot have, with the reason, by name."""
        return {look.name: look.reason for look in self.first_looks if look.fit is None}

    def log_prior(self, fit: Fit) -> float:
        """Return the log of a hypothesis's prior probability."""
        return math.log(prior(len(fit.names), self.count))

    def log_weight(self, fit: Fit) -> float:
        """Return the log weight of one beside any deviation, prior odds included."""
        (evidences,) = self.background.effect_evidence([hypothesis(self.problem, fit)])
        return weight(evidences) + self.log_prior(fit)


def weighed(
    problem: P,
    fits: Sequence[Fit],
    looked: Sequence[FirstLook],
    background: Background,
    count: int,
    concealed: int,
) -> WeighedHypotheses[P]:
    """Weigh what was fitted.

    Raises
    ------
    DataError
        If an evidence is no number.
    """
    hypotheses = [hypothesis(problem, fit) for fit in fits]
    answer_set = answers(ConsideredHypotheses(hypotheses, count, concealed), background)
    shares = answer_set.by_answer
    if not all(math.isfinite(share) for share in shares.values()):
        raise DataError("the simulation cannot follow these records: their evidence is no number")
    settled = [settled_fit(fit, answer_set.settled[fit.answer]) for fit in fits]
    ranked = tuple(sorted(settled, key=lambda fit: -shares[fit.answer]))
    return WeighedHypotheses(
        problem, ranked, tuple(looked), background, answer_set, count, concealed
    )
