"""The whole diagnosis of a pendulum test or a free decay."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from analysis.gap.pendulum.causes import DAMPING, Cause, causes_for
from analysis.gap.pendulum.further import Proposal, Reach, propose
from analysis.gap.pendulum.hypothesis import Hypothesis
from analysis.gap.pendulum.problem import Problem
from analysis.gap.pendulum.search import MOST_CAUSES, Searched, search
from analysis.gap.pendulum.settle import Settled, settle
from analysis.gap.pendulum.verdict import (
    TOLD_APART,
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
from analysis.inertia.spread import SURE


@dataclass(frozen=True, eq=False)
class Diagnosis:
    """Where, which, how far, and what to do next.

    Attributes
    ----------
    best
        The most probable set of causes; of no causes where there is no gap.
    settled
        The best set, its parameters fitted about itself.
    laws
        Laws of damping beside the best set's other causes; empty where no damping is missing.
    alternatives
        What could stand in the place of each cause.
    regimes
        Withheld swings, foretold.
    rivals
        The two leading answers that cannot be told apart; none where all is told.
    proposals
        Further records that tell them apart, best first.
    """

    problem: Problem
    searched: Searched
    verdict: Verdict
    best: Hypothesis
    settled: Settled
    where: tuple[KindOfGap, ...]
    laws: tuple[Law, ...]
    alternatives: tuple[Alternative, ...]
    regimes: tuple[Regime, ...]
    rivals: tuple[Hypothesis, Hypothesis] | None = None
    proposals: tuple[Proposal, ...] = ()

    @property
    def foretells(self) -> float:
        """Share of the gap, where it is least, that the best set foretells; NaN if not asked."""
        shares = [one.shrinkage for regime in self.regimes for one in regime.foretold[:1]]
        return min(shares, default=math.nan)

    @property
    def told(self) -> bool:
        """Whether the best set is the answer, and foretells enough to be called the cause."""
        return self.verdict.best == self.best.names and self.foretells >= SURE

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
    reach: Reach | None = None,
    progress: Callable[[str], None] = lambda _: None,
) -> Diagnosis:
    """Say what separates measured releases from their simulation.

    Parameters
    ----------
    causes
        To be tried; every one that these tests can have where left out.
    most
        How many causes may act together.
    reach
        Within which a further suspension is proposed.
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
    progress("how large")
    after = settle(problem, best)
    gap = where(problem, after)
    found = Diagnosis(problem, searched, verdict, best, after, gap, laws, others, regimes)
    progress("the next run")
    rivals = leading(found)
    proposals = propose(problem, *rivals, verdict.inflation, reach) if rivals else ()
    return replace(found, rivals=rivals, proposals=proposals)


def leading(found: Diagnosis) -> tuple[Hypothesis, Hypothesis] | None:
    """Return the two answers that a further record should tell apart; none where all is told."""
    laws, wide = found.laws, found.verdict.inflation
    left = [law.hypothesis for law in laws[1:] if not told_apart(laws[0], law)]
    if left:
        best = laws[0].hypothesis
        return best, next((one for one in left if not _nested(best, one)), left[0])
    if not found.best.causes:
        return None
    others = [one for one in found.searched.sets.values() if not _nested(found.best, one)]
    weights = {one.names: found.searched.log_weight(one.names, wide) for one in others}
    second = max(others, key=lambda one: weights[one.names], default=None)
    if second is None:
        return None
    ahead = found.searched.log_weight(found.best.names, wide) - weights[second.names]
    return None if found.told and ahead > math.log(TOLD_APART) else (found.best, second)


def _nested(one: Hypothesis, other: Hypothesis) -> bool:
    """Whether either has all causes of the other."""
    return set(one.names) <= set(other.names) or set(other.names) <= set(one.names)


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
