"""Which law of damping it is, and which causes could stand in the place of others."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Final

from analysis.gap.forward.candidate import Candidate
from analysis.gap.pendulum.causes import DAMPING
from analysis.gap.pendulum.search import WeighedCauses, fit
from analysis.gap.pendulum.verdict import TOLD_APART
from analysis.gap.search.fit import Fit, expected_evidence, joined
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
