"""The whole diagnosis of a pendulum test or a free decay."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from analysis.gap.pendulum.causes import DAMPING, Cause, causes_for
from analysis.gap.pendulum.further import Proposal, propose
from analysis.gap.pendulum.hypothesis import Hypothesis
from analysis.gap.pendulum.search import MOST_CAUSES, Searched, search
from analysis.gap.pendulum.trial import Problem
from analysis.gap.pendulum.verdict import (
    Alternative,
    KindOfGap,
    Law,
    Verdict,
    alternatives,
    damping_laws,
    judge,
    where,
)
from analysis.gap.pendulum.withheld import Regime, foretell


@dataclass(frozen=True, eq=False)
class Diagnosis:
    """Where, which, how far, and what to do next.

    Attributes
    ----------
    best
        The most probable set of causes; of no causes where there is no gap.
    laws
        Laws of damping beside the best set's other causes; empty where no damping is missing.
    alternatives
        What could stand in the place of each cause.
    regimes
        Withheld swings, foretold.
    proposals
        Further releases that tell the two best laws apart, best first.
    """

    problem: Problem
    searched: Searched
    verdict: Verdict
    best: Hypothesis
    where: tuple[KindOfGap, ...]
    laws: tuple[Law, ...]
    alternatives: tuple[Alternative, ...]
    regimes: tuple[Regime, ...]
    proposals: tuple[Proposal, ...]


def diagnose_trials(
    problem: Problem,
    causes: Sequence[Cause] | None = None,
    *,
    most: int = MOST_CAUSES,
    progress: Callable[[str], None] = lambda _: None,
) -> Diagnosis:
    """Say what separates measured releases from their simulation.

    Parameters
    ----------
    causes
        To be tried; every one that these tests can have where left out.
    most
        How many causes may act together.
    """
    tried = tuple(causes_for(problem.trials) if causes is None else causes)
    searched = search(problem, tried, most, progress)
    verdict = judge(problem, searched)
    best = searched.best(verdict.inflation)
    damped = any(name in DAMPING for name in best.names)
    progress("laws of damping")
    laws = damping_laws(problem, best, verdict.inflation) if damped else ()
    progress("what else it could be")
    others = alternatives(problem, best, tried, verdict.inflation)
    progress("withheld swings")
    regimes = foretell(problem, _rivals(searched, best, laws)) if best.causes else ()
    rival = _rival(laws)
    proposals = propose(problem, *rival, verdict.inflation) if rival else ()
    return Diagnosis(
        problem, searched, verdict, best, where(problem, best), laws, others, regimes, proposals
    )


def _rival(laws: Sequence[Law]) -> tuple[Hypothesis, Hypothesis] | None:
    """Return the best law and the best one of another kind, if neither can be ruled out."""
    possible = [law for law in laws if law.possible]
    return (possible[0].hypothesis, possible[1].hypothesis) if len(possible) > 1 else None


_ALWAYS = ("quadratic", "linear and quadratic", "linear and cubic")


def _rivals(searched: Searched, best: Hypothesis, laws: Sequence[Law]) -> tuple[Hypothesis, ...]:
    """Return what to foretell with: the best set, the usual laws, the best single wrong cause."""
    sets = {best.names: best}
    for law in laws:
        if law.name in _ALWAYS:
            sets.setdefault(law.hypothesis.names, law.hypothesis)
    wrong = [
        one
        for one in searched.sets.values()
        if len(one.names) == 1 and not set(one.names) & {*best.names, *DAMPING}
    ]
    if wrong:
        control = max(wrong, key=lambda one: one.log_evidence)
        sets.setdefault(control.names, control)
    return tuple(sets.values())
