"""From weighed hypotheses to what is said: the verdict, classes, laws of damping, shares."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Final

import numpy as np

from analysis.gap.forward.candidate import Candidate
from analysis.gap.inference.answers import COEFFICIENTS, NONE, ODD_RUN, UNKNOWN, effects_in
from analysis.gap.inference.gaussian import Nuisances
from analysis.gap.pendulum.causes import BEYOND_LINEAR, DAMPING, STIFFNESS
from analysis.gap.pendulum.problem import PendulumProblem
from analysis.gap.pendulum.search import WeighedCauses, fit, named
from analysis.gap.pendulum.settle import Settled
from analysis.gap.pendulum.swings import KINDS
from analysis.gap.search.fit import Fit, expected_evidence, joined, nothing
from hardware.description.arrays import FloatArray
from hardware.description.errors import PmmError

CAUSE: Final = "cause"
UNTOLD: Final = "untold"
TOLD_APART: Final = 20.0  # ratio of weights from which one answer is preferred to another
_LIKELY: Final = 0.8  # probability from which an answer is said
_BEYOND: Final = 4.0
_SIGN_RAD: Final = 0.54  # from half a turn, within which a sign is reversed: as in a campaign
_HOPELESS = 60.0  # log evidence to first order that a full fit does not make up for
_GROWS: Final[Mapping[str, str]] = {
    "bearing_friction": "dry friction",
    "viscous_damping": "linear",
    "damping": "linear",
    "quadratic_drag": "quadratic",
    "cubic_damping": "cubic",
    "power_drag": "any power",
}
LAWS: Final = (
    ("bearing_friction",),
    ("viscous_damping",),
    ("quadratic_drag",),
    ("cubic_damping",),
    ("viscous_damping", "quadratic_drag"),
    ("viscous_damping", "cubic_damping"),
    ("quadratic_drag", "cubic_damping"),
    ("bearing_friction", "quadratic_drag"),
    ("power_drag",),
)


@dataclass(frozen=True, eq=False)
class Verdict:
    """What is said of the records.

    Attributes
    ----------
    said
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

    said: str
    best: Fit
    probability: float
    by_cause: Mapping[str, float]
    by_class: Mapping[str, float]


def judge(weighed: WeighedCauses) -> Verdict:
    """Return what is said: what is the most probable, where it is probable enough.

    Something unknown is said only where the records prefer it to every set of causes; where its
    prior odds alone do, the cause cannot be told.
    """
    shares = weighed.answers.by_answer
    first = weighed.ranked[0] if weighed.sets else nothing(weighed.problem)
    found = {
        NONE: shares[NONE] + shares[COEFFICIENTS],
        UNKNOWN: shares[UNKNOWN],
        ODD_RUN: shares[ODD_RUN],
        CAUSE: _with_any(shares, [alike(weighed, name) for name in named(first)]),
    }
    said = max(found, key=lambda name: found[name])
    probability = found[said]
    unfounded = said == UNKNOWN and weighed.strangeness < math.log(TOLD_APART)
    if said != NONE and (probability < _LIKELY or unfounded):
        said = UNTOLD
    causes = sorted({name for answer in shares for name in effects_in(answer)})
    return Verdict(
        said,
        nothing(weighed.problem) if said == NONE else first,
        probability,
        {name: _with_any(shares, [(name,)]) for name in causes},
        _classes(shares),
    )


def alike(weighed: WeighedCauses, name: str) -> tuple[str, ...]:
    """Return the causes that pass for one: laws of damping of its kind, and its twins."""
    twins = weighed.beside.shapes.alike.get(name, frozenset((name,)))
    kin = next((kind for kind in (BEYOND_LINEAR, DAMPING) if name in kind), ())
    return tuple(sorted({name, *twins, *kin}))


def open_causes(weighed: WeighedCauses, verdict: Verdict) -> dict[str, dict[str, float]]:
    """Return by cause of the best set what these records cannot tell from it, with probabilities.

    The cause itself comes first, the others by their probability. A cause that is probable enough
    by itself is left out, and so is damping that is said to be a cause: its laws are weighed by
    themselves.
    """
    found, shares = {}, verdict.by_cause
    for name in verdict.best.names if verdict.said in (CAUSE, UNTOLD) else ():
        told = verdict.said == CAUSE
        if shares[name] >= _LIKELY or (told and name in DAMPING):
            continue
        others = [
            one
            for one in (alike(weighed, name) if told else shares)
            if one not in verdict.best.names and shares.get(one, 0.0) * TOLD_APART > shares[name]
        ]
        if others:
            ranked = sorted(others, key=lambda one: -shares[one])
            found[name] = {one: shares[one] for one in (name, *ranked)}
    return found


def _with_any(shares: Mapping[str, float], groups: Sequence[Sequence[str]]) -> float:
    """Return the probability of the answers that have a cause of each group; 0 of no group."""
    return sum(
        share
        for answer, share in shares.items()
        if groups and all(set(effects_in(answer)) & set(one) for one in groups)
    )


def _classes(shares: Mapping[str, float]) -> dict[str, float]:
    # dry friction beside linear damping is not "beyond linear": it grows more slowly
    return {
        "damping": _with_any(shares, [DAMPING]),
        "damping beyond linear": _with_any(shares, [BEYOND_LINEAR]),
        "inertia or stiffness": _with_any(shares, [STIFFNESS]),
        "only inertia or stiffness": sum(
            share
            for answer, share in shares.items()
            if effects_in(answer) and set(effects_in(answer)) <= set(STIFFNESS)
        ),
        NONE: shares[NONE],
        UNKNOWN: shares[UNKNOWN],
    }


@dataclass(frozen=True, eq=False)
class DampingLaw:
    """A law of damping beside what else the best set holds.

    Attributes
    ----------
    log_ratio
        Natural log of its weight over the best law's.
    withheld
        The gap that it leaves on withheld swings, in u, one for each regime; empty where it was
        not asked.
    """

    name: str
    hypothesis: Fit
    log_ratio: float
    withheld: tuple[float, ...] = ()

    @property
    def told_apart(self) -> bool:
        """Whether the records tell it from the best law, by a factor of 20."""
        return self.log_ratio < -math.log(TOLD_APART)


def open_laws(laws: Sequence[DampingLaw]) -> tuple[DampingLaw, ...]:
    """Return the laws of damping that cannot be told from the best one."""
    return tuple(law for law in laws[1:] if not law.told_apart)


def damping_laws(
    weighed: WeighedCauses, best: Fit, causes: Sequence[Candidate]
) -> tuple[DampingLaw, ...]:
    """Fit every law of damping that the causes make beside the best set's others; best first.

    The best set's own law is among them. Linear damping that is stated is more or less of that.
    """
    others = [one for one in best.candidates if one.name not in DAMPING]
    possible = {one.name: one for one in causes}
    own = tuple(one.name for one in best.candidates if one.name in DAMPING)
    tried = {_law(names): names for names in (*map(partial(_linear_as, possible), LAWS), own)}
    fitted = {
        name: fit(weighed.problem, [*others, *(possible[one] for one in names)])
        for name, names in tried.items()
        if set(names) <= set(possible)
    }
    mine = _law(own)  # from its typical size a fit may go astray, where the search did not
    fitted[mine] = max((best, fitted.get(mine, best)), key=weighed.weight)
    weights = {name: weighed.weight(one) for name, one in fitted.items()}
    top = max(weights.values(), default=0.0)
    laws = [DampingLaw(name, one, weights[name] - top) for name, one in fitted.items()]
    return tuple(sorted(laws, key=lambda law: -law.log_ratio))


def _linear_as(possible: Mapping[str, Candidate], names: tuple[str, ...]) -> tuple[str, ...]:
    """Return a law with the linear damping that these records can have."""
    linear = "damping" if "damping" in possible else "viscous_damping"
    return tuple(linear if one == "viscous_damping" else one for one in names)


def _law(names: Sequence[str]) -> str:
    """Return what a law is called."""
    return " and ".join(dict.fromkeys(one for name, one in _GROWS.items() if name in names))


@dataclass(frozen=True)
class Alternative:
    """Another cause in the place of one of the best set's."""

    instead_of: str
    name: str
    log_ratio: float


def alternatives(weighed: WeighedCauses, best: Fit) -> tuple[Alternative, ...]:
    """Return which causes could stand in the place of each one, weights within a factor of 20."""
    found = [
        Alternative(one.name, name, ratio)
        for at, one in enumerate(best.candidates)
        for name, ratio in _in_place(weighed, best, at)
        if ratio > -math.log(TOLD_APART)
    ]
    return tuple(sorted(found, key=lambda row: (row.instead_of, -row.log_ratio)))


def _in_place(weighed: WeighedCauses, best: Fit, at: int) -> Iterator[tuple[str, float]]:
    """Yield the causes in the place of one of a set's, and their weight over the set's."""
    problem, reference = weighed.problem, weighed.weight(best)
    base = fit(problem, [one for number, one in enumerate(best.candidates) if number != at])
    for seen in weighed.looked:
        if seen.fit is None or seen.name in best.names:
            continue
        rough = joined(problem, base, seen.fit)
        if expected_evidence(problem, rough) < best.log_evidence - _HOPELESS:
            continue
        try:
            one = fit(problem, rough.candidates, rough.units)
        except PmmError:  # cannot act on these tests
            continue
        yield seen.name, weighed.weight(one) - reference


@dataclass(frozen=True)
class KindOfGap:
    """One kind of observable, over all records.

    Attributes
    ----------
    stated
        Root mean square of measured less simulated in u, releases fitted.
    before, after
        The same with what is known within tolerances fitted too: without a cause, and with the
        best set.
    """

    kind: str
    count: int
    stated: float
    before: float
    after: float

    @property
    def beyond(self) -> bool:
        """Whether what is left is more than noise, by four standard deviations of its square."""
        return self._shows(self.after)

    @property
    def gap(self) -> bool:
        """The same of the simulation as it is stated."""
        return self._shows(self.stated)

    @property
    def out_of_tolerance(self) -> bool:
        """The same without a cause, what is known within tolerances fitted."""
        return self._shows(self.before)

    def _shows(self, rms: float) -> bool:
        return rms**2 > 1.0 + _BEYOND * math.sqrt(2.0 / self.count)


def where(problem: PendulumProblem, after: Settled) -> tuple[KindOfGap, ...]:
    """Return the gap by kind of observable, before and after."""
    left = remainder(after.problem, after.best)
    lefts = (as_stated(problem), remainder(problem, nothing(problem)), left)
    found = []
    for kind in np.unique(problem.kind):
        rows = problem.kind == kind
        sizes = [float(np.sqrt(np.mean(left[rows] ** 2))) for left in lefts]
        found.append(KindOfGap(problem.names[kind], int(rows.sum()), *sizes))
    return tuple(found)


def remainder(problem: PendulumProblem, one: Fit) -> FloatArray:
    """Return what a hypothesis leaves of the gap with its nuisances at their best, in sigma."""
    left = problem.residual - one.signature
    return left - problem.nuisances.columns @ problem.nuisances.fitted(left)


def turned_runs(problem: PendulumProblem, after: Settled) -> tuple[str, ...]:
    """Return the runs under a known force that are half a turn off, which no cause explains.

    Parameters
    ----------
    after
        The best set of causes; no tolerance is fitted, for it would be torn towards such runs.
    """
    if not problem.driven:
        return ()
    stated = np.abs(problem.residual * problem.uncertainty)
    left = np.abs((after.problem.residual - after.best.signature) * problem.uncertainty)
    off = (np.abs(stated - math.pi) < _SIGN_RAD) & (left > _SIGN_RAD)
    phase, names = (
        problem.kind == KINDS.index("period"),
        [one.run or one.name for one in problem.trials],
    )
    wrong = {one for at, one in enumerate(names) if off[phase & (problem.trial == at)].all()}
    return tuple(one for one in dict.fromkeys(names) if one in wrong)


def as_stated(problem: PendulumProblem) -> FloatArray:
    """Return the gap to the simulation as it is stated, releases at their best, in sigma."""
    release = Nuisances(problem.releases)
    return problem.residual - release.columns @ release.fitted(problem.residual)
