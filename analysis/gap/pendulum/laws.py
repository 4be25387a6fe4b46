"""Which law of damping it is, and which causes could stand in the place of others."""

import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from typing import Final

import numpy as np

from analysis.gap.forward.candidate import Candidate
from analysis.gap.pendulum.causes import DAMPING
from analysis.gap.pendulum.search import Weighed, fit
from analysis.gap.pendulum.verdict import TOLD_APART
from analysis.gap.search.fit import Fit, expected_evidence, joined
from hardware.description.arrays import FloatArray
from hardware.description.errors import PmmError

_HOPELESS = 60.0  # log evidence to first order that a full fit does not make up for
_GROWS: Final[Mapping[str, str]] = {
    "bearing_friction": "dry friction",
    "viscous_damping": "linear",
    "damping": "linear",
    "quadratic_drag": "quadratic",
    "cubic_damping": "cubic",
    "power_drag": "any power",
}
_POWER: Final = "beta"
_POWERS: Final[Mapping[str, float]] = {"linear": 0.0, "quadratic": 1.0}  # of it
_WITHIN, _EXACT = 2.0, 1e-6  # deviations, and what is the same
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
    weighed: Weighed, best: Fit, causes: Sequence[Candidate]
) -> tuple[DampingLaw, ...]:
    """Fit every law of damping that the causes make beside the best set's others; best first.

    The best set's own law is among them. Linear damping that is stated is more or less of that.
    """
    rest = [candidate for candidate in best.candidates if candidate.name not in DAMPING]
    possible = {candidate.name: candidate for candidate in causes}
    law_names = tuple(candidate.name for candidate in best.candidates if candidate.name in DAMPING)
    tried = {_law(names): names for names in (*map(partial(_linear_as, possible), LAWS), law_names)}
    fitted = {}
    for name, names in tried.items():
        with suppress(PmmError):  # a law that cannot act on these records is none
            if set(names) <= set(possible):
                parts = [*rest, *(possible[cause_name] for cause_name in names)]
                fitted[name] = fit(weighed.problem, parts, _seen(weighed, best, parts))
    best_law = _law(law_names)
    fitted[best_law] = max((best, fitted.get(best_law, best)), key=weighed.log_weight)
    weights = {name: weighed.log_weight(law_fit) for name, law_fit in fitted.items()}
    top = max(weights.values(), default=0.0)
    laws = [DampingLaw(name, law_fit, weights[name] - top) for name, law_fit in fitted.items()]
    ranked = sorted(laws, key=lambda law: -law.log_ratio)
    return tuple(law for law in ranked if law is ranked[0] or not _is_another(law, laws))


def _is_another(law: DampingLaw, laws: Sequence[DampingLaw]) -> bool:
    """Tell whether a law of any power has, within its uncertainty, that of another one."""
    fit = law.hypothesis
    for at, axis in enumerate(fit.axes):
        if axis.parameter.name == _POWER:
            spread = axis.deviation * float(np.sqrt(fit.posterior.covariance[at, at]))
            power = axis.value(float(fit.units[at]))
            there = [_POWERS[other.name] for other in laws if other.name in _POWERS]
            return any(abs(power - other) < _WITHIN * spread + _EXACT for other in there)
    return False


def _seen(weighed: Weighed, best: Fit, parts: Sequence[Candidate]) -> FloatArray:
    """Return where the best set or a first look has some causes: typical sizes lead astray."""
    units = {look.name: look.fit.units for look in weighed.first_looks if look.fit}
    cuts = np.split(best.units, np.flatnonzero(np.diff(best.effect_index)) + 1)
    units |= dict(zip(best.names, cuts, strict=True))
    return np.concatenate([units.get(part.name, part.start) for part in parts])


def _linear_as(possible: Mapping[str, Candidate], names: tuple[str, ...]) -> tuple[str, ...]:
    """Return a law with the linear damping that these records can have."""
    linear = "damping" if "damping" in possible else "viscous_damping"
    return tuple(linear if name == "viscous_damping" else name for name in names)


def _law(names: Sequence[str]) -> str:
    """Return what a law is called."""
    return " and ".join(dict.fromkeys(law for name, law in _GROWS.items() if name in names))


@dataclass(frozen=True)
class Alternative:
    """Another cause in the place of one of the best set's."""

    instead_of: str
    name: str
    log_ratio: float


def alternatives(weighed: Weighed, best: Fit) -> tuple[Alternative, ...]:
    """Return which causes could stand in the place of each one, weights within a factor of 20."""
    rows = [
        Alternative(candidate.name, name, ratio)
        for at, candidate in enumerate(best.candidates)
        for name, ratio in _in_place(weighed, best, at)
        if ratio > -math.log(TOLD_APART)
    ]
    return tuple(sorted(rows, key=lambda row: (row.instead_of, -row.log_ratio)))


def _in_place(weighed: Weighed, best: Fit, at: int) -> Iterator[tuple[str, float]]:
    """Yield the causes in the place of one of a set's, and their weight over the set's."""
    problem, reference = weighed.problem, weighed.log_weight(best)
    base = fit(
        problem, [candidate for number, candidate in enumerate(best.candidates) if number != at]
    )
    for look in weighed.first_looks:
        if look.fit is None or look.name in best.names:
            continue
        rough = joined(problem, base, look.fit)
        if expected_evidence(problem, rough) < best.log_evidence - _HOPELESS:
            continue
        try:
            refit = fit(problem, rough.candidates, rough.units)
        except PmmError:  # cannot act on these tests
            continue
        yield look.name, weighed.log_weight(refit) - reference
