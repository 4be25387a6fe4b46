"""The whole diagnosis of a pendulum test or a free decay."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Final

from analysis.gap.forward.candidate import Candidate
from analysis.gap.pendulum.causes import DAMPING, causes_for
from analysis.gap.pendulum.further import FurtherRecord, Reach, propose
from analysis.gap.pendulum.laws import (
    Alternative,
    DampingLaw,
    alternatives,
    damping_laws,
    open_laws,
)
from analysis.gap.pendulum.problem import PendulumProblem
from analysis.gap.pendulum.remainder import KindOfGap, gap_by_kind
from analysis.gap.pendulum.search import MOST_CAUSES, Weighed, cause_names, weigh
from analysis.gap.pendulum.settle import Settled, settle
from analysis.gap.pendulum.verdict import CAUSE, TOLD_APART, Verdict, judge
from analysis.gap.pendulum.withheld import WithheldSwings, predict_withheld
from analysis.gap.search.fit import Fit

_ASKED: Final = 10.0  # ln weight behind the best law within which the withheld swings are asked too


@dataclass(frozen=True, eq=False)
class PendulumDiagnosis:
    """Where, which, how far, and what to do next.

    Attributes
    ----------
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

    weighed: Weighed
    verdict: Verdict
    settled: Settled
    gap_by_kind: tuple[KindOfGap, ...]
    laws: tuple[DampingLaw, ...]
    alternatives: tuple[Alternative, ...]
    regimes: tuple[WithheldSwings, ...]
    rivals: tuple[Fit, Fit] | None = None
    proposals: tuple[FurtherRecord, ...] = ()

    @property
    def problem(self) -> PendulumProblem:
        """What was diagnosed."""
        return self.weighed.problem

    @property
    def best(self) -> Fit:
        """The most probable set of causes; of no causes where there is no gap."""
        return self.verdict.best

    @property
    def foretells(self) -> float:
        """Share of the gap, where it is least, that the best set foretells.

        NaN where there is no gap, or where what was fitted leaves open whether it shrinks at all.
        """
        gaps = (regime for regime in self.regimes if regime.gap)
        best = [forecast for regime in gaps for forecast in regime.foretold[:1]]
        told = (forecast.shrinkage for forecast in best if forecast.low > 0.0)
        return min(told, default=math.nan)

    @property
    def control(self) -> tuple[str, ...]:
        """The wrong cause that is asked to foretell too; empty where there is none."""
        wrong = _wrong_cause(self.weighed, self.best)
        return () if wrong is None else wrong.names


def diagnose_trials(
    problem: PendulumProblem,
    causes: Sequence[Candidate] | None = None,
    *,
    most: int = MOST_CAUSES,
    reach: Reach | None = None,
    progress: Callable[[str], None] = lambda _: None,
) -> PendulumDiagnosis:
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
    weighed = weigh(problem, tried, most, progress)
    verdict = judge(weighed)
    best = verdict.best
    progress("laws of damping")
    laws = damping_laws(weighed, best, tried) if set(best.names) & set(DAMPING) else ()
    progress("what else it could be")
    replacements = alternatives(weighed, best)
    progress("withheld swings")
    regimes = (
        predict_withheld(problem, _prediction_sets(weighed, best, laws)) if best.candidates else ()
    )
    laws = _with_withheld(laws, regimes)
    progress("how large")
    after = settle(problem, best)
    diagnosis = PendulumDiagnosis(
        weighed, verdict, after, gap_by_kind(problem, after), laws, replacements, regimes
    )
    progress("the next run")
    rivals = leading(diagnosis)
    proposals = propose(problem, *rivals, reach) if rivals else ()
    return replace(diagnosis, rivals=rivals, proposals=proposals)


def leading(diagnosis: PendulumDiagnosis) -> tuple[Fit, Fit] | None:
    """Return the two answers that a further record should tell apart; none where all is told."""
    open_fits = [law.hypothesis for law in open_laws(diagnosis.laws)]
    if open_fits:
        best = diagnosis.laws[0].hypothesis
        return best, next((fit for fit in open_fits if not _nested(best, fit)), open_fits[0])
    if not diagnosis.best.candidates:
        return None
    second = next((fit for fit in diagnosis.weighed.ranked if _is_rival(diagnosis.best, fit)), None)
    if second is None:
        return None
    shares = diagnosis.weighed.answers.by_answer
    ahead = shares[diagnosis.best.answer] > TOLD_APART * shares[second.answer]
    return None if diagnosis.verdict.outcome == CAUSE and ahead else (diagnosis.best, second)


def _is_rival(best: Fit, fit: Fit) -> bool:
    """Whether a set is another one: laws of damping beside the same causes are told elsewhere."""
    rest, others = ({*one.names} - {*DAMPING} for one in (best, fit))
    damped = len(rest) < len(best.names) and len(others) < len(fit.names)
    return not _nested(best, fit) and not (damped and rest == others)


def _nested(first: Fit, second: Fit) -> bool:
    """Whether either has all causes of the other."""
    return set(first.names) <= set(second.names) or set(second.names) <= set(first.names)


def _with_withheld(
    laws: Sequence[DampingLaw], regimes: Sequence[WithheldSwings]
) -> tuple[DampingLaw, ...]:
    """Return the laws with what each leaves of the withheld swings."""
    tested_laws = []
    for law in laws:
        names = cause_names(law.hypothesis)
        gaps = [
            forecast.gap
            for regime in regimes
            for forecast in regime.foretold
            if forecast.causes == names
        ]
        tested_laws.append(replace(law, withheld=tuple(gaps)))
    return tuple(tested_laws)


def _prediction_sets(weighed: Weighed, best: Fit, laws: Sequence[DampingLaw]) -> tuple[Fit, ...]:
    """Return what to foretell with: the best set, laws not far behind, the best wrong cause."""
    sets = {best.answer: best}
    for law in laws:
        if law.log_ratio > -_ASKED:
            sets.setdefault(law.hypothesis.answer, law.hypothesis)
    control = _wrong_cause(weighed, best)
    if control is not None:
        sets.setdefault(control.answer, control)
    return tuple(sets.values())


def _wrong_cause(weighed: Weighed, best: Fit) -> Fit | None:
    """Return the best single cause among those that the best set has nothing to do with."""
    wrong = [fit for fit in weighed.singles if fit.answer not in (*best.names, *DAMPING)]
    return max(wrong, key=lambda fit: fit.log_evidence, default=None)
