"""Weigh what could explain a gap: nothing, each effect, pairs, or something unknown."""

import math
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from analysis.gap.fit import Fit, Problem, most_probable
from analysis.gap.free import Free
from analysis.gap.gaussian import Nuisances, left_over, misfit, null_evidence, posterior
from analysis.gap.look import Looked
from analysis.gap.screen import shown, worth_a_look
from analysis.gap.search import Engine, fitted, looked_at, paired
from analysis.gap.together import together
from analysis.gap.unknown import Deviation, find_deviation
from hardware.description.errors import PmmError
from sim.effects.effect import Effect

# What these change are the coefficients, and those are free in every hypothesis.
COEFFICIENTS: Final = ("added-mass-error", "damping-error")

_NAMED = 4  # hypotheses of each kind that are given a remainder
_HOPELESS = 50.0
FORMS: Final = (0.0, 0.03, 0.1, 0.2, 0.3)  # by how much of itself a signature may be off
HIDDEN: Final = (
    2.0  # sigma of a typical signature below which an effect cannot be seen in these runs
)


@dataclass(frozen=True)
class Odds:
    """Prior probabilities; the catalogue's share is spread evenly over its effects.

    Whoever asks has a reason to: one campaign in eight has no gap. Of the gaps one in five is such
    that no catalogue knows it, one in ten is two effects.
    """

    none: float = 0.12
    single: float = 0.61
    pair: float = 0.09
    unknown: float = 0.18


_NOTHING = Deviation({}, np.zeros(0), 0.0)


@dataclass(frozen=True, eq=False)
class Named:
    """A named hypothesis with what it leaves.

    No rig has an effect in the very form of a catalogue. So beside each leading hypothesis a
    remainder of no particular form is allowed (:mod:`analysis.gap.unknown`); how large it is
    against what the effect explains tells whether the name is deserved.

    Attributes
    ----------
    log_evidence
        With the remainder.
    remainder
        Its size over that of the effect's own signature, after the nuisances have taken their part.
    balance
        Of a pair: the smaller effect's signature over the larger one's; 1 for a single effect.
    """

    fit: Fit
    log_evidence: float
    remainder: float
    deviation: Deviation
    balance: float = 1.0


@dataclass(frozen=True, eq=False)
class Weighed:
    """All hypotheses with their log evidence.

    Attributes
    ----------
    singles, pairs
        The refined ones, most probable first.
    hidden
        Effects that these runs and sensors cannot show, with the typical signature's size in sigma
        after the free coefficients have taken their part.
    refused
        Effects that this rig cannot have, with the reason.
    skipped
        Effects of whose traces the recordings show nothing, so that they were not simulated.
    """

    problem: Problem
    none: float
    singles: tuple[Named, ...]
    pairs: tuple[Named, ...]
    unknown: Deviation
    looked: tuple[Looked, ...]
    odds: Odds
    skipped: tuple[str, ...] = ()

    @property
    def hidden(self) -> Mapping[str, float]:
        """Effects that cannot be seen, by name."""
        return {one.name: one.visible for one in self.looked if one.fit and one.visible < HIDDEN}

    @property
    def refused(self) -> Mapping[str, str]:
        """Effects that cannot act here, by name."""
        return {one.name: one.reason for one in self.looked if one.fit is None}


def weigh(
    problem: Problem,
    catalogue: Mapping[str, type[Effect]],
    executor: Executor | None = None,
    odds: Odds = Odds(),
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
    singles = _together(problem, free, fitted(problem, seen, none, engine))
    pairs = _together(problem, free, paired(problem, singles, seen, none, engine))
    progress("weighing")
    unknown = find_deviation(problem.simulator.stack, problem.residual, problem.nuisances)
    ones, twos = (_named_all(problem, fits, none) for fits in (singles, pairs))
    skipped = tuple(kind.name for kind in kinds if kind not in worth)
    return Weighed(problem, none, ones, twos, unknown, tuple(looked), odds, skipped)


def _together(problem: Problem, free: Sequence[Free], fits: Sequence[Fit]) -> list[Fit]:
    """Let the leading fits move together with the coefficients; the most probable comes first."""
    moved = [together(problem, free, one) for one in fits[:_NAMED]]
    return sorted([*moved, *fits[_NAMED:]], key=lambda one: -one.log_evidence)


def _named_all(problem: Problem, fits: Sequence[Fit], none: float) -> tuple[Named, ...]:
    """Allow the leading hypotheses a remainder; the others are worth what they are without."""
    floor = none - _HOPELESS
    found = [
        replace(with_remainder(problem, fit), balance=balance(problem, fit))
        if number < _NAMED
        else Named(fit, max(fit.log_evidence, floor), 0.0, _NOTHING)
        for number, fit in enumerate(fits)
    ]
    return tuple(sorted(found, key=lambda one: -one.log_evidence))


def balance(problem: Problem, fit: Fit) -> float:
    """Return the smaller effect's signature over the larger one's, each by itself.

    1 for a single effect, and where one does not repeat with the shaft, or cannot be simulated by
    itself: it cannot pass for the other's form.
    """
    if len(fit.candidates) < 2 or not fit.repeats:
        return 1.0
    nominal = problem.simulator.nominal
    try:
        alone = [problem.simulator.predict((one,)) - nominal for one in fit.effects]
    except PmmError:
        return 1.0
    sizes = [left_over(problem.whitened(one), problem.nuisances) for one in alone]
    return min(sizes) / max(*sizes, 1e-12)


def with_remainder(problem: Problem, fit: Fit) -> Named:
    """Return a hypothesis as nature may have it: in a form of its own, or with something beside.

    Its own form is a signature that is off by some share of itself, component by component;
    something beside is a deviation of no particular form. The better of the two counts.
    """
    formed = max((_in_own_form(problem, fit, share) for share in FORMS), key=_by_evidence)
    return max((formed, _beside(problem, fit)), key=_by_evidence)


def _beside(problem: Problem, fit: Fit) -> Named:
    """Return a hypothesis with a deviation of no particular form beside it.

    The parameters are free about where they were fitted, as widely as the prior that suits their
    sizes; what they are there costs what that prior says of it. So a fit that went astray is worth
    no more than the deviation alone, whatever its slopes promise elsewhere.
    """
    widths, share = fit.suited
    left = problem.residual - fit.signature
    wider = Nuisances(np.hstack((problem.nuisances.columns, fit.columns * widths)))
    deviation = find_deviation(problem.simulator.stack, left, wider)
    cost = 0.5 * float(np.sum((fit.units / widths) ** 2))
    own = left_over(fit.signature, problem.nuisances)
    size = left_over(deviation.mean, problem.nuisances)
    log_evidence = deviation.log_evidence - cost + share
    return Named(fit, log_evidence, size / max(own, 1.0), deviation)


def _by_evidence(one: Named) -> float:
    return one.log_evidence


def _in_own_form(problem: Problem, fit: Fit, share: float) -> Named:
    """Return a hypothesis whose signature is off by a share of itself, at random.

    Of what the nuisances leave of it: what passes for a coefficient has no form of its own.
    """
    own = problem.nuisances.whiten(fit.signature)
    weight = 1.0 / np.sqrt(1.0 + (share * own) ** 2)
    nuisances = Nuisances(problem.nuisances.columns * weight[:, None])
    columns = fit.columns * weight[:, None]
    target = fit.linearised(problem.residual) * weight
    best, shared = posterior(target, columns, nuisances), nuisances.log_determinant
    found = replace(fit, columns=columns, posterior=best, shared=shared)
    units = most_probable(found)
    cost = misfit(target - columns @ units, nuisances) + float(units @ units)
    log_density = replace(found, cost=cost).log_evidence
    log_density += float(np.sum(np.log(weight))) - (math.log(len(FORMS)) if share else 0.0)
    return Named(replace(fit, form=share), log_density, share, _NOTHING)
