"""From weighed hypotheses to what is said: the verdict, classes, what cannot be told apart."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from analysis.gap.inference.answers import (
    COEFFICIENTS,
    NONE,
    ODD_RUN,
    UNKNOWN,
    by_effect,
    effects_in,
    of_any,
)
from analysis.gap.inference.constants import ODDS
from analysis.gap.pendulum.causes import BEYOND_LINEAR, DAMPING, LINEAR_PERIOD, STIFFNESS
from analysis.gap.pendulum.search import Weighed, cause_names
from analysis.gap.search.fit import Fit, no_effect

CAUSE: Final = "cause"
UNTOLD: Final = "untold"
TOLD_APART: Final = 20.0  # ratio of weights from which one answer is preferred to another
_TINY: Final = 1e-300  # least share, for its logarithm
_LIKELY: Final = 0.8  # probability from which an answer is said


@dataclass(frozen=True, eq=False)
class Verdict:
    """What is said of the records.

    Attributes
    ----------
    outcome
        ``"none"``, ``"unknown"``, ``"odd-run"``, ``"cause"``, or ``"untold"`` where nothing is
        probable enough.
    best
        The most probable set of causes; of no causes where there is no gap.
    probability
        Of what is the most probable: of a cause with all that these records cannot tell from it.
    by_cause
        Of each cause, whatever else is there too.
    by_class
        Of any damping, of damping beyond linear, of inertia or stiffness, of none and unknown.
    """

    outcome: str
    best: Fit
    probability: float
    by_cause: Mapping[str, float]
    by_class: Mapping[str, float]


def judge(weighed: Weighed) -> Verdict:
    """Return what is said: what is the most probable, where it is probable enough.

    Something unknown is said only where the records prefer it to every set of causes; where its
    prior odds alone do, the cause cannot be told.
    """
    shares = weighed.answers.by_answer
    first = weighed.ranked[0] if weighed.ranked else no_effect(weighed.problem)
    chances = {
        NONE: shares[NONE] + shares[COEFFICIENTS],
        UNKNOWN: shares[UNKNOWN],
        ODD_RUN: shares[ODD_RUN],
        CAUSE: of_any(shares, *(alike(weighed, name) for name in cause_names(first))),
    }
    said = max(chances, key=lambda name: chances[name])
    probability = chances[said]
    unfounded = said == UNKNOWN and _strangeness(weighed) < math.log(TOLD_APART)
    if said != NONE and (probability < _LIKELY or unfounded):
        said = UNTOLD
    return Verdict(
        said,
        no_effect(weighed.problem) if said == NONE else first,
        probability,
        by_effect(shares),
        _classes(shares),
    )


def alike(weighed: Weighed, name: str) -> tuple[str, ...]:
    """Return the causes that pass for one: laws of its kind, and its twins in these records."""
    twins = weighed.background.shapes.alike.get(name, frozenset((name,)))
    kin = next((kind for kind in (BEYOND_LINEAR, DAMPING, LINEAR_PERIOD) if name in kind), ())
    return tuple(sorted({name, *twins, *kin}))


def open_causes(weighed: Weighed, verdict: Verdict) -> dict[str, dict[str, float]]:
    """Return by cause of the best set what these records cannot tell from it, with probabilities.

    The cause itself comes first, the others by their probability. A cause that is probable enough
    by itself is left out, and so is damping that is said to be a cause: its laws are weighed by
    themselves.
    """
    groups, shares = {}, verdict.by_cause
    for name in verdict.best.names if verdict.outcome in (CAUSE, UNTOLD) else ():
        is_cause = verdict.outcome == CAUSE
        if shares[name] >= _LIKELY or (is_cause and name in DAMPING):
            continue
        rivals = [
            rival
            for rival in (alike(weighed, name) if is_cause else shares)
            if rival not in verdict.best.names
            and shares.get(rival, 0.0) * TOLD_APART > shares[name]
        ]
        if rivals:
            ranked = sorted(rivals, key=lambda rival: -shares[rival])
            groups[name] = {member: shares[member] for member in (name, *ranked)}
    return groups


def _strangeness(weighed: Weighed) -> float:
    """Return the log of how much better something unknown does than any set, priors left out."""
    shares = weighed.answers.by_answer
    unknown = math.log(max(shares[UNKNOWN] / ODDS.unknown, _TINY))
    named = (
        math.log(max(shares[fit.answer], _TINY)) - weighed.log_prior(fit) for fit in weighed.ranked
    )
    return unknown - max(named, default=math.log(_TINY))


def _classes(shares: Mapping[str, float]) -> dict[str, float]:
    # dry friction beside linear damping is not "beyond linear": it grows more slowly
    return {
        "damping": of_any(shares, DAMPING),
        "damping beyond linear": of_any(shares, BEYOND_LINEAR),
        "inertia or stiffness": of_any(shares, STIFFNESS),
        "only inertia or stiffness": sum(
            share
            for answer, share in shares.items()
            if effects_in(answer) and set(effects_in(answer)) <= set(STIFFNESS)
        ),
        NONE: shares[NONE],
        UNKNOWN: shares[UNKNOWN],
    }
