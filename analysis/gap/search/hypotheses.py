"""Search what could explain a gap, and weigh it: nothing, each effect, pairs, or something else."""

import math
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import Final

import numpy as np

from analysis.gap.forward.free_numbers import Free
from analysis.gap.forward.problem import Problem
from analysis.gap.inference.answers import Answers, Considered, answers
from analysis.gap.inference.gaussian import null_evidence
from analysis.gap.locate.traces import shown, worth_a_look
from analysis.gap.search.deviation import background
from analysis.gap.search.engine import LEADERS, Engine, alone_again, fitted, looked_at, paired
from analysis.gap.search.first_look import HIDDEN, Looked
from analysis.gap.search.fit import Fit
from analysis.gap.search.joint import together
from analysis.gap.search.linear_hypothesis import hypothesis, in_form, settled, with_forms
from sim.effects.effect import Effect

# What these change are the coefficients, and those are free in every hypothesis.
COEFFICIENTS: Final = ("added-mass-error", "damping-error")


@dataclass(frozen=True, eq=False)
class Weighed:
    """All hypotheses, and how probable each is.

    Attributes
    ----------
    singles, pairs
        The refined ones, most probable first.
    skipped
        Effects of whose traces the recordings show nothing, so that they were not simulated.
    """

    problem: Problem
    singles: tuple[Fit, ...]
    pairs: tuple[Fit, ...]
    looked: tuple[Looked, ...]
    skipped: tuple[str, ...]
    answers: Answers

    @property
    def ranked(self) -> list[Fit]:
        """The named hypotheses, most probable first."""
        shares = self.answers.by_answer
        return sorted((*self.singles, *self.pairs), key=lambda one: -shares[one.answer])

    @property
    def hidden(self) -> Mapping[str, float]:
        """Effects that cannot be seen, with the typical signature's size in sigma, by name."""
        return _hidden(self.looked)

    @property
    def refused(self) -> Mapping[str, str]:
        """Effects that this rig cannot have, with the reason, by name."""
        return {one.name: one.reason for one in self.looked if one.fit is None}


def weigh(
    problem: Problem,
    catalogue: Mapping[str, type[Effect]],
    executor: Executor | None = None,
    progress: Callable[[str], None] = lambda _: None,
    free: Sequence[Free] = (),
) -> Weighed:
    """Fit and weigh every hypothesis.

    Parameters
    ----------
    executor
        Where effects are looked at side by side; ``None`` does them one by one.
    progress
        Told what is being done.
    free
        The coefficients and settings of the problem, to be moved together with the effects.
    """
    kinds = [kind for name, kind in catalogue.items() if name not in COEFFICIENTS]
    traces = shown(problem)
    worth = [kind for kind in kinds if worth_a_look(kind, traces)]
    engine = Engine(executor, progress)
    looked = looked_at(problem, worth, engine)
    none = null_evidence(problem.residual, problem.nuisances)
    seen = [one for one in looked if one.fit and one.visible >= HIDDEN]
    singles = fitted(problem, seen, none, engine)
    pairs = _completed(problem, free, paired(problem, singles, seen, none, engine))
    least = min((one.cost for one in pairs), default=math.inf)
    singles = _completed(problem, free, alone_again(problem, singles, pairs), least)
    singles += _unfitted(seen, singles)
    progress("weighing")
    sought = np.array([one.is_sought for one in free], dtype=bool)
    considered = Considered(
        [hypothesis(problem, one) for one in singles],
        [hypothesis(problem, one) for one in pairs],
        len(kinds),
        len(_hidden(looked)) + len(kinds) - len(worth),
    )
    found = answers(considered, background(problem, looked, sought))
    singles, pairs = (
        sorted(
            (settled(one, found.settled[one.answer]) for one in ones),
            key=lambda one: -found.by_answer[one.answer],
        )
        for ones in (singles, pairs)
    )
    skipped = tuple(kind.name for kind in kinds if kind not in worth)
    return Weighed(problem, tuple(singles), tuple(pairs), tuple(looked), skipped, found)


def _completed(
    problem: Problem, free: Sequence[Free], fits: Sequence[Fit], least: float = math.inf
) -> list[Fit]:
    """Give each fit its other forms; fit the leading ones in them, and with the coefficients."""
    formed = [with_forms(problem, one) for one in fits]
    moved: list[Fit] = []
    for one in formed[:LEADERS]:
        moved.append(together(problem, free, in_form(problem, one, least), least))
        least = min(least, moved[-1].cost)
    ones = [*(with_forms(problem, one) for one in moved), *formed[LEADERS:]]
    return sorted(ones, key=lambda one: -one.log_evidence)


def _unfitted(seen: Sequence[Looked], fits: Sequence[Fit]) -> list[Fit]:
    """Return the effects that did not promise enough to be fitted, as they were looked at.

    They are less probable for that, and not impossible.
    """
    names = {one.names[0] for one in fits}
    return [one.fit for one in seen if one.fit is not None and one.name not in names]


def _hidden(looked: Sequence[Looked]) -> dict[str, float]:
    return {one.name: one.visible for one in looked if one.fit and one.visible < HIDDEN}
