"""Fit what could explain the gap of a pendulum test, and weigh it: nothing, causes, anything."""

from collections.abc import Callable, Sequence
from typing import Final, TypeAlias

import numpy as np

from analysis.gap.forward.candidate import Candidate
from analysis.gap.inference.answers import effects_in
from analysis.gap.inference.gaussian import null_evidence
from analysis.gap.pendulum.causes import starts_of
from analysis.gap.pendulum.deviation import background
from analysis.gap.pendulum.problem import PendulumProblem
from analysis.gap.search.engine import Engine, fit_leading, fit_pairs, widened
from analysis.gap.search.first_look import HIDDEN, best_look
from analysis.gap.search.fit import Fit, linearised_at, no_effect
from analysis.gap.search.refinement import refine
from analysis.gap.search.slopes import into_range
from analysis.gap.search.weighed import WeighedHypotheses, weighed
from hardware.description.arrays import FloatArray

MOST_CAUSES: Final = 3
Weighed: TypeAlias = WeighedHypotheses[PendulumProblem]


def weigh(
    problem: PendulumProblem,
    causes: Sequence[Candidate],
    most: int = MOST_CAUSES,
    progress: Callable[[str], None] = lambda _: None,
) -> Weighed:
    """Fit sets of causes, from one up to ``most``, and weigh every answer.

    It raises what :func:`~analysis.gap.search.weighed.weighed` does.
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
    concealed = len(causes) - len(looks)
    sets = [*singles, *pairs, *triples]
    return weighed(problem, sets, looked, background(problem, looked), len(causes), concealed)


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
