"""Fit what could explain the gap of a pendulum test, and weigh it: nothing, causes, anything."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from analysis.gap.forward.candidate import Candidate
from analysis.gap.inference.answers import (
    UNKNOWN,
    Answers,
    ConsideredHypotheses,
    answers,
    effects_in,
    prior,
    weight,
)
from analysis.gap.inference.constants import ODDS
from analysis.gap.inference.evidence import Background
from analysis.gap.inference.gaussian import null_evidence
from analysis.gap.pendulum.causes import starts_of
from analysis.gap.pendulum.deviation import background
from analysis.gap.pendulum.problem import PendulumProblem
from analysis.gap.search.engine import Engine, fit_leading, fit_pairs, widened
from analysis.gap.search.first_look import HIDDEN, FirstLook, best_look
from analysis.gap.search.fit import Fit, linearised_at, no_effect
from analysis.gap.search.linear_hypothesis import hypothesis, settled_fit
from analysis.gap.search.refinement import refine
from analysis.gap.search.slopes import into_range
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError

MOST_CAUSES: Final = 3
_TINY: Final = 1e-300


@dataclass(frozen=True, eq=False)
class WeighedCauses:
    """All hypotheses, and how probable each is.

    Attributes
    ----------
    sets
        The fitted sets of causes by their answers.
    first_looks
        First looks at every cause.
    background
        What stands beside every hypothesis.
    """

    problem: PendulumProblem
    sets: Mapping[str, Fit]
    first_looks: tuple[FirstLook, ...]
    background: Background
    answers: Answers

    @property
    def ranked(self) -> list[Fit]:
        """The sets of causes, most probable first."""
        shares = self.answers.by_answer
        return sorted(self.sets.values(), key=lambda cause_set: -shares[cause_set.answer])

    @property
    def strangeness(self) -> float:
        """Log of how much better something unknown does than any set, prior odds left out."""
        shares, count = self.answers.by_answer, len(self.first_looks)
        named = (
            shares[cause_set.answer] / prior(len(cause_set.names), count)
            for cause_set in self.sets.values()
        )
        best, unknown = max(named, default=0.0), shares[UNKNOWN] / ODDS.unknown
        return math.log(max(unknown, _TINY)) - math.log(max(best, _TINY))

    def weight(self, cause_set: Fit) -> float:
        """Return the log weight of a set beside any deviation, prior odds included."""
        odds = math.log(prior(len(cause_set.names), len(self.first_looks)))
        return (
            weight(self.background.effect_evidence([hypothesis(self.problem, cause_set)])[0]) + odds
        )


def weigh(
    problem: PendulumProblem,
    causes: Sequence[Candidate],
    most: int = MOST_CAUSES,
    progress: Callable[[str], None] = lambda _: None,
) -> WeighedCauses:
    """Fit sets of causes, from one up to ``most``, and weigh every answer.

    Raises
    ------
    DataError
        If the evidence is no number.
    """
    engine = Engine(None, progress)
    progress("looking at causes")
    looked = tuple(best_look(problem, candidate.name, starts_of(candidate)) for candidate in causes)
    none = null_evidence(problem.residual, problem.nuisances)
    looks = [look for look in looked if look.fit and look.visible >= HIDDEN]
    singles = fit_leading(problem, looks, none, engine)
    pairs = fit_pairs(problem, singles, looks, none, engine) if most > 1 else []
    partners = [*(fit for look in looks for fit in look.fits), *singles]
    triples = widened(problem, pairs, partners, engine) if most > 2 else []
    progress("weighing")
    beside = background(problem, looked)
    hypotheses = [
        [hypothesis(problem, cause_set) for cause_set in cause_sets]
        for cause_sets in (singles, pairs, triples)
    ]
    considered = ConsideredHypotheses(
        hypotheses[0], hypotheses[1], len(causes), len(causes) - len(looks), hypotheses[2]
    )
    answer_set = answers(considered, beside)
    if not all(math.isfinite(share) for share in answer_set.by_answer.values()):
        raise DataError("the simulation cannot follow these records: their evidence is no number")
    sets = {
        cause_set.answer: settled_fit(cause_set, answer_set.settled[cause_set.answer])
        for cause_set in (*singles, *pairs, *triples)
    }
    return WeighedCauses(problem, sets, looked, beside, answer_set)


def fit(
    problem: PendulumProblem, causes: Sequence[Candidate], start: FloatArray | None = None
) -> Fit:
    """Fit some causes together.

    Parameters
    ----------
    start
        Parameters in prior units; typical values where left out.
    """
    parts = tuple(causes)
    if not parts:
        return no_effect(problem)
    units = np.concatenate([part.start for part in parts]) if start is None else start
    return refine(problem, linearised_at(problem, parts, into_range(parts, units)))


def cause_names(cause_set: Fit) -> tuple[str, ...]:
    """Return a set's causes in alphabetical order."""
    return effects_in(cause_set.answer) if cause_set.candidates else ()
