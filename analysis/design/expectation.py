"""What the product's own fit would say of the runs that were chosen, run by run.

The runs are made up as the hull is believed to be, with the scatter that is expected of them, and
fitted as recordings are; so what all runs share, and weights that come from few periods, count as
they will then.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.cycle_fit import CycleFit, fit_terms
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from analysis.design.belief import Belief, believed_cycles
from analysis.design.candidate import CandidateRun
from analysis.design.design_fits import DesignFit, DesignTarget, fits_of
from analysis.design.noise import Noise
from hardware.description.errors import DataError

SCATTER: Final = "scatter of the runs"
REPEATS: Final = "scatter between repeats"
_SOURCES: Final = ((re.compile("scatter of .*"), SCATTER), (re.compile("repeats: .*"), REPEATS))


@dataclass(frozen=True)
class ExpectedCoefficient:
    """How well one coefficient is expected to be known.

    Attributes
    ----------
    where
        Frequency and speed that it holds at; empty where all runs tell it.
    value
        Of the fit: what is believed, or what was measured; NaN where the runs do not determine it.
    wanted
        Standard uncertainty that is wanted; NaN where none is.
    standard_uncertainty
        That is expected; infinite where the runs do not determine it.
    shares
        What part of its variance each input has, largest first.
    message
        Why the runs do not determine it; empty if they do.
    """

    name: str
    where: str
    unit: str
    believed: float
    value: float
    wanted: float
    standard_uncertainty: float
    shares: Mapping[str, float]
    message: str = ""

    @property
    def met(self) -> bool:
        """Whether it is expected to be known as well as is wanted."""
        return not self.standard_uncertainty > self.wanted


def made_up(candidates: Sequence[CandidateRun], belief: Belief, noise: Noise) -> list[BodyCycle]:
    """Return the cycles that are expected of runs, named by their place."""
    names = [f"run {k + 1}" for k in range(len(candidates))]
    scatter = [
        noise.scatter(name, candidate.point.frequency_hz, candidate.periods)
        for name, candidate in zip(names, candidates, strict=True)
    ]
    points = [candidate.point for candidate in candidates]
    return [noise.repeating(cycle) for cycle in believed_cycles(names, points, belief, scatter)]


def expected_coefficients(
    candidates: Sequence[CandidateRun],
    cycles: Sequence[BodyCycle],
    targets: Sequence[DesignTarget],
    belief: Belief,
    stated: StatedUncertainties,
) -> tuple[ExpectedCoefficient, ...]:
    """Return how well all that is asked for is expected to be known by some runs.

    Parameters
    ----------
    candidates, cycles
        The runs, and :func:`made_up` of them or what was measured.
    """
    return tuple(
        row
        for fit in fits_of(candidates, targets, belief)
        for row in _rows(fit, [cycles[k] for k in fit.members], belief, stated)
    )


def fit_cycles(
    fit: DesignFit, cycles: Sequence[BodyCycle], belief: Belief, stated: StatedUncertainties
) -> CycleFit:
    """Return the fit of some cycles.

    It raises what :func:`analysis.coefficients.cycle_fit.fit_terms` raises.
    """
    terms = tuple(belief.terms[k] for k in fit.places)
    names = tuple(list(belief.values)[k] for k in fit.places)
    return fit_terms(cycles, terms, names, fit.orders, form=belief.form, stated=stated)


def _rows(
    fit: DesignFit, cycles: Sequence[BodyCycle], belief: Belief, stated: StatedUncertainties
) -> Iterator[ExpectedCoefficient]:
    names = list(belief.values)
    wanted_places = [k for k in fit.places if not fit.wanted or names[k] in fit.wanted]
    try:
        uncertain, reason = fit_cycles(fit, cycles, belief, stated).uncertain, ""
    except DataError as error:
        uncertain, reason = None, str(error)
    for k in wanted_places:
        place = fit.places.index(k)
        yield ExpectedCoefficient(
            names[k],
            fit.where,
            belief.terms[k].unit,
            belief.values[names[k]],
            np.nan if uncertain is None else float(uncertain.values[place]),
            fit.wanted.get(names[k], np.nan),
            np.inf if uncertain is None else float(uncertain.standard_uncertainty[place]),
            {} if uncertain is None else _pooled_shares(uncertain.shares(place)),
            reason,
        )


def _pooled_shares(shares: Mapping[str, float]) -> dict[str, float]:
    """Return shares with all runs' scatter as one, largest first."""
    total: dict[str, float] = {}
    for label, share in shares.items():
        name = next((source for kind, source in _SOURCES if kind.fullmatch(label)), label)
        total[name] = total.get(name, 0.0) + share
    return dict(sorted(total.items(), key=lambda item: -item[1]))
