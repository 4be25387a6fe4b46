"""The whole diagnosis of a pendulum test or a free decay."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

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
    told_apart,
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

    @property
    def control(self) -> tuple[str, ...]:
        """The wrong cause that is asked to foretell too; empty where there is none."""
        wrong = _wrong(self.searched, self.best)
        return () if wrong is None else wrong.names


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
    laws = damping_laws(problem, best, tried, verdict.inflation) if damped else ()
    progress("what else it could be")
    others = alternatives(problem, best, tried, verdict.inflation)
    progress("withheld swings")
    regimes = foretell(problem, _rivals(searched, best, laws)) if best.causes else ()
    laws = _with_withheld(laws, regimes)
    rival = _rival(laws)
    proposals = propose(problem, *rival, verdict.inflation) if rival else ()
    return Diagnosis(
        problem, searched, verdict, best, where(problem, best), laws, others, regimes, proposals
    )


def _rival(laws: Sequence[Law]) -> tuple[Hypothesis, Hypothesis] | None:
    """Return the best law and the next one that cannot be told from it, if there is one."""
    left = [law for law in laws[1:] if not told_apart(laws[0], law)]
    return (laws[0].hypothesis, left[0].hypothesis) if left else None


_ASKED = 20.0  # ln evidence behind the best law within which the withheld swings are asked too


def _with_withheld(laws: Sequence[Law], regimes: Sequence[Regime]) -> tuple[Law, ...]:
    """Return the laws with what each leaves of the withheld swings."""
    found = []
    for law in laws:
        names = law.hypothesis.names
        gaps = [one.gap for regime in regimes for one in regime.foretold if one.causes == names]
        found.append(replace(law, withheld=tuple(gaps)))
    return tuple(found)


def _rivals(searched: Searched, best: Hypothesis, laws: Sequence[Law]) -> tuple[Hypothesis, ...]:
    """Return what to foretell with: the best set, laws not far behind, the best wrong cause."""
    sets = {best.names: best}
    for law in laws:
        if law.log_ratio > -_ASKED:
            sets.setdefault(law.hypothesis.names, law.hypothesis)
    control = _wrong(searched, best)
    if control is not None:
        sets.setdefault(control.names, control)
    return tuple(sets.values())


def _wrong(searched: Searched, best: Hypothesis) -> Hypothesis | None:
    """Return the best single cause among those that the best set has nothing to do with."""
    wrong = [
        one
        for one in searched.sets.values()
        if len(one.names) == 1 and not set(one.names) & {*best.names, *DAMPING}
    ]
    return max(wrong, key=lambda one: one.log_evidence, default=None)
