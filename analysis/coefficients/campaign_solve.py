"""One group of a campaign, solved: its entries of the table, and what was noticed."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.campaign_nonlinear import SINGLE_RUN, GroupFits, nonlinear_fits
from analysis.coefficients.campaign_plan import Group, GroupKind, Request
from analysis.coefficients.campaign_records import (
    JOINT,
    LINEAR,
    CoefficientEntry,
    FormChoice,
    Missing,
)
from analysis.coefficients.campaign_result import TrialColumns, no_trials
from analysis.coefficients.campaign_static import static_fits
from analysis.coefficients.cycle_fit import FIRST, CycleFit, fit_cycles
from analysis.coefficients.cycle_trials import cycle_trials
from analysis.coefficients.linear_fit import lacking_places, linear_fit
from analysis.coefficients.rearrangement import Refits, refits
from analysis.coefficients.run_agreement import run_flags
from analysis.coefficients.terms import ROLL, linear_terms
from analysis.uncertainty.values import UncertainValues, stacked
from hardware.description.errors import DataError
from hardware.description.flags import Flag


@dataclass(frozen=True, eq=False)
class GroupCoefficients:
    """Entries of one group, ``n`` of them.

    Attributes
    ----------
    refits
        What they would be under other arrangements of the rig; empty where that is not known.
    """

    entries: tuple[CoefficientEntry, ...]
    uncertain: UncertainValues
    trials: TrialColumns
    choices: tuple[FormChoice, ...] = ()
    missing: tuple[Missing, ...] = ()
    flags: tuple[Flag, ...] = ()
    refits: tuple[Refits, ...] = ()


def solve_group(group: Group, request: Request) -> GroupCoefficients:
    """Return what one group determines; what it cannot tell is named, not raised."""
    if group.kind is GroupKind.LINEAR:
        block = _linear(group.cycles, request)
    else:
        fits_of = static_fits if group.kind is GroupKind.STATIC else nonlinear_fits
        block = _fits_block(fits_of(group.cycles, request), group.cycles, request)
    entries = [replace(one, speed_m_s=group.speed_m_s) for one in block.entries]
    if not math.isnan(group.frequency_hz):
        entries = [replace(one, frequency_hz=group.frequency_hz) for one in entries]
    return replace(block, entries=tuple(entries))


def _linear(cycles: Sequence[BodyCycle], request: Request) -> GroupCoefficients:
    missing = tuple(Missing(*lacking) for lacking in lacking_places(cycles, request.form))
    try:
        linear = linear_fit(cycles, request.form, request.stated)
    except DataError:
        alternatives = refits(cycles, [], [])
        return GroupCoefficients(
            (), UncertainValues(np.zeros(0)), no_trials(0), missing=missing, refits=alternatives
        )
    fit = linear.fit
    entries = tuple(
        replace(
            _fit_entry(LINEAR, fit, k),
            unit=place.unit,
            retained=float(linear.retained[k]),
            misfit=linear.misfit,
        )
        for k, place in enumerate(linear.places)
    )
    fits = [(LINEAR, fit), *_in_roll(cycles, {place.column for place in linear.places}, request)]
    entries += tuple(
        _fit_entry(LINEAR, roll_fit, k)
        for _, roll_fit in fits[1:]
        for k in range(len(roll_fit.names))
    )
    trials = _fits_trials(fits, request)
    alternatives = refits(cycles, [cycle_fit for _, cycle_fit in fits], [])
    flags = (*linear.flags, *(flag for _, cycle_fit in fits for flag in run_flags(cycle_fit)))
    return GroupCoefficients(
        entries,
        stacked([cycle_fit.uncertain for _, cycle_fit in fits]),
        trials,
        missing=missing,
        flags=flags,
        refits=alternatives,
    )


def _in_roll(
    cycles: Sequence[BodyCycle], columns: set[int], request: Request
) -> list[tuple[str, CycleFit]]:
    """Return the fit of the roll moment where all runs have one, of the motions that are told."""
    if not all(cycle.has_roll for cycle in cycles):
        return []
    roll_names = linear_terms(cycles[0].plane, (ROLL,))
    names = [name for name in roll_names if "vr".index(name[2]) in columns]
    return [(LINEAR, fit_cycles(cycles, names, FIRST, stated=request.stated))]


def _fits_block(
    group: GroupFits, cycles: Sequence[BodyCycle], request: Request
) -> GroupCoefficients:
    fits = group.fits
    entries = tuple(
        _fit_entry(method, fit, k) for method, fit in fits for k in range(len(fit.names))
    )
    uncertain = stacked([fit.uncertain for _, fit in fits])
    flags = (
        *(flag.of(cycle.name) for cycle in cycles for flag in cycle.flags),
        *(flag for method, fit in fits if method != SINGLE_RUN for flag in run_flags(fit)),
    )
    trials = _fits_trials(fits, request)
    alternatives = refits(cycles, [fit for _, fit in fits], group.richest)
    return GroupCoefficients(
        entries, uncertain, trials, tuple(group.choices), tuple(group.missing), flags, alternatives
    )


def _fits_trials(fits: Sequence[tuple[str, CycleFit]], request: Request) -> TrialColumns:
    """Monte Carlo of the fits of several runs; single runs are checks on them."""
    columns = [
        cycle_trials(fit, request.trials, request.seed, request.level)
        if request.trials and method != SINGLE_RUN
        else no_trials(len(fit.names))
        for method, fit in fits
    ]
    if not columns:
        return no_trials(0)
    names = ("standard_uncertainty", "low", "high")
    return TrialColumns(
        request.trials, *(np.concatenate([getattr(column, n) for column in columns]) for n in names)
    )


def _fit_entry(method: str, fit: CycleFit, k: int) -> CoefficientEntry:
    cycles = fit.problem.numbers.cycles
    moving = [cycle.amplitude for cycle in cycles if cycle.frequency_hz > 0.0]
    size = np.stack(moving).max(axis=0) if moving else np.zeros(2)
    return CoefficientEntry(
        fit.names[k],
        fit.terms[k].unit,
        method,
        math.nan if method == JOINT else cycles[0].frequency_hz,
        cycles[0].speed_m_s,
        float(size[0]),
        float(size[1]),
        tuple(cycle.name for cycle in cycles),
        float("nan"),
        fit.misfit(fit.terms[k].row),
    )
