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
    Considered,
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
from analysis.gap.search.engine import Engine, fitted, paired, widened
from analysis.gap.search.first_look import HIDDEN, Looked, best_look
from analysis.gap.search.fit import Fit, at, inside, nothing
from analysis.gap.search.linear_hypothesis import hypothesis, settled
from analysis.gap.search.refinement import refine
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
    looked
        First looks at every cause.
    beside
        What stands beside every hypothesis.
    """

    problem: PendulumProblem
    sets: Mapping[str, Fit]
    looked: tuple[Looked, ...]
    beside: Background
    answers: Answers

    @property
    def ranked(self) -> list[Fit]:
        """The sets of causes, most probable first."""
        shares = self.answers.by_answer
        return sorted(self.sets.values(), key=lambda one: -shares[one.answer])

    @property
    def strangeness(self) -> float:
        """Log of how much better something unknown does than any set, prior odds left out."""
        shares, count = self.answers.by_answer, len(self.looked)
        named = (shares[one.answer] / prior(len(one.names), count) for one in self.sets.values())
        best, unknown = max(named, default=0.0), shares[UNKNOWN] / ODDS.unknown
        return math.log(max(unknown, _TINY)) - math.log(max(best, _TINY))

    def weight(self, one: Fit) -> float:
        """Return the log weight of a set beside any deviation, prior odds included."""
        odds = math.log(prior(len(one.names), len(self.looked)))
        return weight(self.beside.named([hypothesis(self.problem, one)])[0]) + odds


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
    looked = tuple(best_look(problem, one.name, starts_of(one)) for one in causes)
    none = null_evidence(problem.residual, problem.nuisances)
    seen = [one for one in looked if one.fit and one.visible >= HIDDEN]
    singles = fitted(problem, seen, none, engine)
    pairs = paired(problem, singles, seen, none, engine) if most > 1 else []
    partners = [*(one.fit for one in seen if one.fit is not None), *singles]
    triples = widened(problem, pairs, partners, engine) if most > 2 else []
    progress("weighing")
    beside = background(problem, looked)
    kept = [[hypothesis(problem, one) for one in ones] for ones in (singles, pairs, triples)]
    considered = Considered(kept[0], kept[1], len(causes), len(causes) - len(seen), kept[2])
    found = answers(considered, beside)
    if not all(math.isfinite(share) for share in found.by_answer.values()):
        raise DataError("the simulation cannot follow these records: their evidence is no number")
    sets = {
        one.answer: settled(one, found.settled[one.answer]) for one in (*singles, *pairs, *triples)
    }
    return WeighedCauses(problem, sets, looked, beside, found)


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
        return nothing(problem)
    units = np.concatenate([one.start for one in parts]) if start is None else start
    return refine(problem, at(problem, parts, inside(parts, units)))


def named(one: Fit) -> tuple[str, ...]:
    """Return a set's causes in alphabetical order."""
    return effects_in(one.answer) if one.candidates else ()
