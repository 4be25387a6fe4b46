"""Which sets of causes are worth fitting: one, then more as long as each pays for itself."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from analysis.gap.gaussian import Nuisances, misfit
from analysis.gap.pendulum.causes import Cause
from analysis.gap.pendulum.hypothesis import Hypothesis, fit, linearised, null
from analysis.gap.pendulum.problem import Problem
from hardware.description.arrays import BoolArray, FloatArray
from hardware.description.errors import PmmError

MOST_CAUSES: Final = 3
_BEAM = 3
_REFINED = 5
_PRIOR: Final = {0: 0.35, 1: 0.30, 2: 0.15, 3: 0.10}
_UNKNOWN = 0.10
SIZES: Final = (3.0, 10.0, 30.0, 100.0, 300.0, 1000.0, 3000.0)  # of a deviation, in sigma
_CHOICE = 3.0  # log odds against any size of it


@dataclass(frozen=True, eq=False)
class Searched:
    """All hypotheses that were fitted, and that of a deviation without a cause.

    Attributes
    ----------
    sets
        By their causes' names; the null under ``()``.
    unknown
        Log evidence of a smooth deviation that no cause is assumed for.
    count
        How many causes there were to choose from.
    """

    sets: dict[tuple[str, ...], Hypothesis]
    unknown: float
    count: int

    def log_weight(self, names: tuple[str, ...], wide: float = 1.0) -> float:
        """Return log evidence and prior odds of one set.

        Parameters
        ----------
        wide
            Chi-square per degree of freedom by which the evidence is weakened.
        """
        size = len(names)
        odds = _PRIOR[size] / max(math.comb(self.count, size), 1)
        return self.sets[names].log_evidence / wide + math.log(odds)

    def log_weight_unknown(self, wide: float = 1.0) -> float:
        """Return log evidence and prior odds of what is unknown."""
        return self.unknown / wide + math.log(_UNKNOWN)

    def best(self, wide: float = 1.0) -> Hypothesis:
        """Return the most probable set."""
        return self.sets[max(self.sets, key=lambda names: self.log_weight(names, wide))]


def search(
    problem: Problem,
    causes: Sequence[Cause],
    most: int = MOST_CAUSES,
    progress: Callable[[str], None] = lambda _: None,
) -> Searched:
    """Fit sets of causes, from none up to ``most``, along the most probable ones."""
    found: dict[tuple[str, ...], Hypothesis] = {(): null(problem)}
    searched = Searched(found, unknown_evidence(problem), len(causes))
    frontier = [found[()]]
    for size in range(1, min(most, len(causes)) + 1):
        progress(f"sets of {size}")
        level = _level(problem, frontier, causes, found, everything=size == 1)
        if not level:
            break
        found |= level
        ranked = sorted(level, key=searched.log_weight, reverse=True)
        before = max(searched.log_weight(one.names) for one in frontier)
        if size > 2 and searched.log_weight(ranked[0]) < before:
            break
        frontier = [level[names] for names in ranked[:_BEAM]]
    return searched


def _level(
    problem: Problem,
    frontier: Sequence[Hypothesis],
    causes: Sequence[Cause],
    known: dict[tuple[str, ...], Hypothesis],
    *,
    everything: bool,
) -> dict[tuple[str, ...], Hypothesis]:
    """Return the sets of one cause more, the most promising of them fitted in full."""
    promising: dict[tuple[str, ...], Hypothesis] = {}
    for base in frontier:
        for one in causes:
            names = tuple(sorted((*base.names, one.name)))
            if one.name in base.names or names in known:
                continue
            rough = _tried(problem, base, one)
            best = promising.get(names)
            if rough and (best is None or rough.log_evidence > best.log_evidence):
                promising[names] = rough
    ranked = sorted(promising.items(), key=lambda row: -row[1].log_evidence)
    kept = ranked if everything else ranked[:_REFINED]
    return {names: fit(problem, rough.causes, rough.units) for names, rough in kept}


def _tried(problem: Problem, base: Hypothesis, one: Cause) -> Hypothesis | None:
    try:
        return linearised(problem, base, one)
    except PmmError:  # cannot act on these tests
        return None


def unknown_evidence(problem: Problem) -> float:
    """Return the log evidence of a smooth deviation in any one kind of observable, or in all."""
    smooth = smooth_columns(problem)
    kinds: list[BoolArray] = [np.isin(problem.kind, [k]) for k in np.unique(problem.kind)]
    kinds.append(np.ones(problem.kind.size, dtype=bool))
    scores = []
    for rows in kinds:
        columns = np.where(rows[:, None], smooth, 0.0)
        for size in SIZES:
            wider = Nuisances(np.hstack([problem.nuisances.columns, size * columns]))
            cost = misfit(problem.residual, wider) + wider.log_determinant
            scores.append(-0.5 * cost - _CHOICE)
    return max(scores)


def smooth_columns(problem: Problem) -> FloatArray:
    """Return columns of smooth curves over each trial's windows, of one sigma each time."""
    pairs = sorted(set(zip(problem.trial.tolist(), problem.kind.tolist(), strict=True)))
    parts = [problem.smooth((problem.trial == t) & (problem.kind == k)) for t, k in pairs]
    return np.hstack(parts)
