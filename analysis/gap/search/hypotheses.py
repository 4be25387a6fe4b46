"""Search what could explain a gap, and weigh it: nothing, each effect, pairs, or something else."""

import math
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from typing import Final

import numpy as np

from analysis.gap.forward.free_numbers import Free
from analysis.gap.forward.problem import Problem
from analysis.gap.inference.gaussian import null_evidence
from analysis.gap.locate.traces import deviating_traces, worth_a_look
from analysis.gap.search.deviation import background
from analysis.gap.search.engine import (
    LEADERS,
    Engine,
    alone_again,
    fit_leading,
    fit_pairs,
    looked_at,
)
from analysis.gap.search.first_look import HIDDEN, FirstLook
from analysis.gap.search.fit import Fit
from analysis.gap.search.joint import fit_jointly
from analysis.gap.search.linear_hypothesis import in_form, with_forms
from analysis.gap.search.weighed import WeighedHypotheses, weighed
from sim.effects.effect import Effect

# What these change are the coefficients, and those are free in every hypothesis.
COEFFICIENTS: Final = ("added-mass-error", "damping-error")


def weigh(
    problem: Problem,
    catalogue: Mapping[str, type[Effect]],
    executor: Executor | None = None,
    progress: Callable[[str], None] = lambda _: None,
    free: Sequence[Free] = (),
) -> WeighedHypotheses[Problem]:
    """Fit and weigh every hypothesis.

    It raises what :func:`~analysis.gap.search.weighed.weighed` does.

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
    traces = deviating_traces(problem)
    worth = [kind for kind in kinds if worth_a_look(kind, traces)]
    engine = Engine(executor, progress)
    looked = looked_at(problem, worth, engine)
    none = null_evidence(problem.residual, problem.nuisances)
    looks = [look for look in looked if look.fit and look.visible >= HIDDEN]
    singles = fit_leading(problem, looks, none, engine)
    pairs = _complete_forms(problem, free, fit_pairs(problem, singles, looks, none, engine))
    least = min((fit.cost for fit in pairs), default=math.inf)
    singles = _complete_forms(problem, free, alone_again(problem, singles, pairs), least)
    singles += _unfitted(looks, singles)
    progress("weighing")
    sought = np.array([number.is_sought for number in free], dtype=bool)
    beside = background(problem, looked, sought)
    concealed = sum(look.is_hidden for look in looked) + len(kinds) - len(worth)
    return weighed(problem, [*singles, *pairs], looked, beside, len(kinds), concealed)


def _complete_forms(
    problem: Problem, free: Sequence[Free], fits: Sequence[Fit], least: float = math.inf
) -> list[Fit]:
    """Give each fit its other forms; fit the leading ones in them, and with the coefficients."""
    formed = [with_forms(problem, fit) for fit in fits]
    moved: list[Fit] = []
    for fit in formed[:LEADERS]:
        moved.append(fit_jointly(problem, free, in_form(problem, fit, least), least))
        least = min(least, moved[-1].cost)
    all_fits = [*(with_forms(problem, fit) for fit in moved), *formed[LEADERS:]]
    return sorted(all_fits, key=lambda fit: -fit.log_evidence)


def _unfitted(looks: Sequence[FirstLook], fits: Sequence[Fit]) -> list[Fit]:
    """Return the effects that did not promise enough to be fitted, as they were looked at.

    They are less probable for that, and not impossible.
    """
    names = {fit.names[0] for fit in fits}
    return [look.fit for look in looks if look.fit is not None and look.name not in names]
