"""What the diagnosis makes of each hypothesis: evidence, size, overlap and share, by effect."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from analysis.gap.forward.problem import Problem
from hardware.description.arrays import FloatArray

if TYPE_CHECKING:
    from analysis.gap.search.weighed import WeighedHypotheses


def weighed_of(case: Path) -> dict[str, Any]:
    """Return numbers of a case's hypotheses by name, as :func:`numbers_of` has them."""
    return numbers_of(weighed_hypotheses(case))


def numbers_of(weighed: "WeighedHypotheses[Problem]") -> dict[str, Any]:
    """Return numbers of hypotheses by name; an effect that was not fitted has fewer.

    Of each effect: ``evidence``, by how much the log evidence that its first look promises is above
    that of no effect, in which the number of runs cancels; ``size`` of its signature, in sigma;
    ``overlap``, the cosine between what the recordings leave and its signature; and of each answer
    its ``share``, how probable the diagnosis holds it to be.
    """
    from analysis.gap.search.fit import no_effect

    problem = weighed.problem
    found: dict[str, Any] = {
        f"{name}|share": share for name, share in weighed.answers.by_answer.items()
    }
    left, none = _left(problem, problem.residual), no_effect(problem).log_evidence
    for one in weighed.first_looks:
        if one.fit is not None and np.isfinite(one.expected):
            found[f"{one.name}|evidence"] = float(one.expected) - none
            found[f"{one.name}|size"] = float(one.visible)
            found[f"{one.name}|overlap"] = cosine(left, _left(problem, one.fit.signature))
    return found


def weighed_hypotheses(case: Path) -> "WeighedHypotheses[Problem]":
    """Return a case's hypotheses, with how probable the diagnosis holds each to be."""
    from analysis.gap.judge.diagnosis import problem_of
    from analysis.gap.search.hypotheses import weigh
    from pmm.gap.preparation import prepare
    from sim.effects.catalogue import catalogue

    ready = prepare(case, catalogue())
    free = ready.recentred.free
    problem = problem_of(ready.recentred.rig, ready.fitted, ready.settings, free)
    return weigh(problem, catalogue(), free=free)


def cosine(one: FloatArray, other: FloatArray) -> float:
    """Return the cosine between two vectors; 0 where one of them is nothing."""
    norms = float(np.linalg.norm(one) * np.linalg.norm(other))
    return float(one @ other) / norms if norms > 0.0 else 0.0


def _left(problem: Problem, values: FloatArray) -> FloatArray:
    return values - problem.nuisances.columns @ problem.nuisances.fitted(values)
