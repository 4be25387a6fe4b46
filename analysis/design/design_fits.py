"""Which fits the targets of a design ask for: of which runs, with which terms."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from analysis.coefficients.cycle_fit import FIRST, HIGHER
from analysis.design.belief import Belief, told_terms
from analysis.design.candidate import CandidateRun
from hardware.description.arrays import IntArray


@dataclass(frozen=True)
class DesignTarget:
    """How well a coefficient has to be known.

    Attributes
    ----------
    standard_uncertainty
        In the coefficient's unit.
    band_hz
        Frequencies at each of which it has to be met, by the runs of one frequency and speed; all
        runs together tell it where there is none.
    """

    name: str
    standard_uncertainty: float
    band_hz: tuple[float, float] | None = None


@dataclass(frozen=True, eq=False)
class DesignFit:
    """Which candidates are fitted together with which terms of one load.

    Attributes
    ----------
    row
        0 force, 1 moment.
    places
        Of the terms among those of the belief.
    orders
        Harmonics that are fitted.
    members
        Places of the candidates.
    wanted
        Standard uncertainty that is wanted, by name.
    where
        Frequency and speed of the runs; empty for all runs.
    """

    row: int
    places: tuple[int, ...]
    orders: tuple[int, ...]
    members: IntArray
    wanted: Mapping[str, float]
    where: str


def fits_of(
    candidates: Sequence[CandidateRun], targets: Sequence[DesignTarget], belief: Belief
) -> Iterator[DesignFit]:
    """Yield the fits that targets ask for: of all runs, and of those of each frequency and speed.

    Without a target all terms of all runs are asked for.
    """
    broad_targets = {
        target.name: target.standard_uncertainty for target in targets if target.band_hz is None
    }
    if broad_targets or not targets:
        told = told_terms(belief, (candidate.point for candidate in candidates))
        degree = max(term.degree for term in belief.terms)
        yield from _by_load(np.arange(len(candidates)), broad_targets, belief, told, degree)
    kinds: dict[tuple[float, float], list[int]] = {}
    for k, candidate in enumerate(candidates):
        if candidate.point.drift_rad == 0.0:
            key = (candidate.point.frequency_hz, candidate.point.carriage_speed_m_s)
            kinds.setdefault(key, []).append(k)
    for (frequency, speed), members in sorted(kinds.items()):
        band_targets = {
            target.name: target.standard_uncertainty
            for target in targets
            if target.band_hz is not None and target.band_hz[0] <= frequency <= target.band_hz[1]
        }
        if band_targets:
            where = f"{frequency:g} Hz, {speed:g} m/s"
            told = told_terms(belief, (candidates[k].point for k in members))
            yield from _by_load(np.array(members), band_targets, belief, told, 1, where)


def _by_load(
    members: IntArray,
    wanted: Mapping[str, float],
    belief: Belief,
    told: Sequence[bool],
    degree: int,
    where: str = "",
) -> Iterator[DesignFit]:
    """Yield the fit of each load that is asked for, with terms of up to some degree."""
    names = list(belief.values)
    for row in sorted({term.row for term in belief.terms}):
        places = [
            k for k, term in enumerate(belief.terms) if term.row == row and term.degree <= degree
        ]
        orders = HIGHER if degree > 1 else FIRST
        together = tuple(k for k in places if told[k])
        beyond = [(k,) for k in places if not told[k] and names[k] in wanted]
        for fitted in (together, *beyond):  # what no run moves is asked for by itself, in vain
            if fitted and (not wanted or any(names[k] in wanted for k in fitted)):
                yield DesignFit(row, fitted, orders, members, wanted, where)
