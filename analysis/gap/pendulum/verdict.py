"""From fitted hypotheses to what is said: probabilities, classes, laws of damping, shares."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from analysis.gap.gaussian import Nuisances, misfit
from analysis.gap.pendulum.causes import BEYOND_LINEAR, DAMPING, STIFFNESS, Cause, cause
from analysis.gap.pendulum.hypothesis import Hypothesis, fit, linearised, null
from analysis.gap.pendulum.problem import Problem
from analysis.gap.pendulum.search import Searched
from analysis.gap.pendulum.settle import Settled
from analysis.gap.pendulum.swings import KINDS
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError, PmmError
from sim.pendulum.effects import body

UNKNOWN: Final = "unknown"
NONE: Final = "none"
TOLD_APART: Final = 20.0  # ratio of evidence from which one answer is preferred to another
TOLERATED: Final = 0.1  # remainder over gap at which a name is worth half
_STEEP: Final = 4.0
_BEYOND: Final = 4.0
_CHANCE_U: Final = 0.2  # standard deviation of the gap that noise alone leaves in a dozen windows
_HOPELESS = 60.0  # log evidence to first order that a full fit does not make up for
LAWS: Final[Mapping[str, tuple[type[Any], ...]]] = {
    "dry friction": (body.BearingFriction,),
    "linear": (body.ViscousDamping,),
    "quadratic": (body.QuadraticDrag,),
    "cubic": (body.CubicRateDamping,),
    "linear and quadratic": (body.ViscousDamping, body.QuadraticDrag),
    "linear and cubic": (body.ViscousDamping, body.CubicRateDamping),
    "quadratic and cubic": (body.QuadraticDrag, body.CubicRateDamping),
    "dry friction and quadratic": (body.BearingFriction, body.QuadraticDrag),
    "any power": (body.PowerDrag,),
}


@dataclass(frozen=True)
class Verdict:
    """What is how probable.

    Attributes
    ----------
    by_set
        Over sets of causes, ``()`` for none, and ``("unknown",)``; sums to 1.
    by_cause
        Of each cause, whatever else is there too.
    by_class
        Probability of damping beyond linear, of any damping, of inertia or stiffness.
    inflation
        Chi-square per degree of freedom that the best set leaves, at least 1; all evidence is
        weakened by it.
    """

    by_set: dict[tuple[str, ...], float]
    by_cause: dict[str, float]
    by_class: dict[str, float]
    inflation: float

    @property
    def best(self) -> tuple[str, ...]:
        """The most probable answer."""
        return max(self.by_set, key=lambda names: self.by_set[names])


def judge(problem: Problem, searched: Searched) -> Verdict:
    """Turn evidence into probabilities.

    A set that leaves much of the gap counts for its names only in part; the rest of its weight
    goes to ``"unknown"``.

    Raises
    ------
    DataError
        If the evidence is no number.
    """
    wide = inflation(problem, searched.best())
    logs = {names: searched.log_weight(names, wide) for names in searched.sets}
    logs[(UNKNOWN,)] = searched.log_weight_unknown(wide)
    if not all(math.isfinite(one) for one in logs.values()):
        raise DataError("the simulation cannot follow these records: their evidence is no number")
    top = max(logs.values())
    weights = {names: math.exp(value - top) for names, value in logs.items()}
    total = sum(weights.values())
    shares = {names: value / total for names, value in weights.items()}
    for names, one in searched.sets.items():
        kept = _deserved(problem, one) if names else 1.0
        shares[(UNKNOWN,)] += (1.0 - kept) * shares[names]
        shares[names] *= kept
    causes = sorted({name for names in shares for name in names if name != UNKNOWN})
    return Verdict(
        dict(sorted(shares.items(), key=lambda row: -row[1])),
        {one: sum(s for names, s in shares.items() if one in names) for one in causes},
        _classes(shares),
        wide,
    )


def _classes(shares: Mapping[tuple[str, ...], float]) -> dict[str, float]:
    def any_of(names: Sequence[str]) -> float:
        return sum(share for key, share in shares.items() if set(key) & set(names))

    # dry friction beside linear damping is not "beyond linear": it grows more slowly
    return {
        "damping": any_of(DAMPING),
        "damping beyond linear": any_of(BEYOND_LINEAR),
        "inertia or stiffness": any_of(STIFFNESS),
        "only inertia or stiffness": sum(
            share for key, share in shares.items() if key and set(key) <= set(STIFFNESS)
        ),
        NONE: shares[()],
        UNKNOWN: shares[(UNKNOWN,)],
    }


def inflation(problem: Problem, best: Hypothesis) -> float:
    """Return chi-square per degree of freedom of the best set, at least 1."""
    left = misfit(best.without_signature(problem), problem.nuisances)
    freedom = max(problem.residual.size - best.units.size, 1)
    return max(left / freedom, 1.0)


def _deserved(problem: Problem, one: Hypothesis) -> float:
    """Return how much of a set's weight its names deserve, by what it leaves of the gap."""
    size = problem.residual.size
    before = misfit(problem.residual, problem.nuisances) - size
    after = misfit(one.without_signature(problem), problem.nuisances) - 2.0 * size
    ratio = math.sqrt(max(after, 0.0) / max(before, 1.0))
    return 1.0 / (1.0 + math.pow(ratio / TOLERATED, _STEEP))


@dataclass(frozen=True, eq=False)
class Law:
    """A law of damping beside what else the best set holds.

    Attributes
    ----------
    log_ratio
        Natural log of its evidence over the best law's, weakened by the inflation.
    withheld
        The gap that it leaves on withheld swings, in u, one for each regime; empty where it was
        not asked.
    """

    name: str
    hypothesis: Hypothesis
    log_ratio: float
    withheld: tuple[float, ...] = ()

    @property
    def possible(self) -> bool:
        """Whether the record as a whole does not tell the best law from it."""
        return self.log_ratio > -math.log(TOLD_APART)


def told_apart(first: Law, other: Law) -> bool:
    """Whether the law of the best evidence can be told from another one.

    Both have to say so: the evidence of the whole record, by a factor of 20, and the swings that
    were withheld, none of which the other one foretells better by more than chance. A law far
    behind in evidence is not asked to foretell.
    """
    return first.name != other.name and not other.possible and not foretells_better(other, first)


def open_laws(laws: Sequence[Law]) -> tuple[Law, ...]:
    """Return the laws of damping that cannot be told from the one of the best evidence."""
    return tuple(law for law in laws[1:] if not told_apart(laws[0], law))


def foretells_better(one: Law, other: Law) -> bool:
    """Whether a law foretells any withheld swings better than another one by more than chance."""
    gaps = zip(one.withheld, other.withheld, strict=False)
    return any(mine < its - _CHANCE_U for mine, its in gaps)


def damping_laws(
    problem: Problem, best: Hypothesis, causes: Sequence[Cause], wide: float
) -> tuple[Law, ...]:
    """Fit every law of damping that the causes make beside the best set's others; best first."""
    others = [one for one in best.causes if one.name not in DAMPING]
    possible = {one.name for one in causes}
    fitted = {
        name: fit(problem, [*others, *(cause(kind) for kind in kinds)])
        for name, kinds in LAWS.items()
        if {kind.name for kind in kinds} <= possible
    }
    top = max(one.log_evidence for one in fitted.values())
    laws = [Law(name, one, (one.log_evidence - top) / wide) for name, one in fitted.items()]
    return tuple(sorted(laws, key=lambda law: -law.log_ratio))


@dataclass(frozen=True)
class Alternative:
    """Another cause in the place of one of the best set's."""

    instead_of: str
    name: str
    log_ratio: float


def alternatives(
    problem: Problem, best: Hypothesis, causes: Sequence[Cause], wide: float
) -> tuple[Alternative, ...]:
    """Return which causes could stand in the place of each one, evidence within a factor of 20."""
    found = []
    for one in best.causes:
        rest = [other for other in best.causes if other.name != one.name]
        base = fit(problem, rest)
        for other in causes:
            if other.name in best.names:
                continue
            ratio = _in_place(problem, base, other, best.log_evidence)
            if ratio / wide > -math.log(TOLD_APART):
                found.append(Alternative(one.name, other.name, ratio / wide))
    return tuple(sorted(found, key=lambda row: (row.instead_of, -row.log_ratio)))


def _in_place(problem: Problem, base: Hypothesis, other: Cause, reference: float) -> float:
    """Return the log evidence of a cause beside a fit, over the reference."""
    try:
        rough = linearised(problem, base, other)
        if rough.log_evidence < reference - _HOPELESS:
            return rough.log_evidence - reference
        return fit(problem, rough.causes, rough.units).log_evidence - reference
    except PmmError:  # cannot act on these tests
        return -math.inf


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


def where(problem: Problem, after: Settled) -> tuple[KindOfGap, ...]:
    """Return the gap by kind of observable, before and after."""
    left = remainder(after.problem, after.best)
    lefts = (as_stated(problem), remainder(problem, null(problem)), left)
    found = []
    for kind in np.unique(problem.kind):
        rows = problem.kind == kind
        sizes = [float(np.sqrt(np.mean(left[rows] ** 2))) for left in lefts]
        found.append(KindOfGap(KINDS[kind], int(rows.sum()), *sizes))
    return tuple(found)


def remainder(problem: Problem, one: Hypothesis) -> FloatArray:
    """Return what a hypothesis leaves of the gap with its nuisances at their best, in sigma."""
    left = one.without_signature(problem)
    return left - problem.nuisances.columns @ problem.nuisances.fitted(left)


def as_stated(problem: Problem) -> FloatArray:
    """Return the gap to the simulation as it is stated, releases at their best, in sigma."""
    release = Nuisances(problem.releases)
    return problem.residual - release.columns @ release.fitted(problem.residual)
