"""A whole campaign's coefficients, by pure functions: check, group, solve each group, put together.

:func:`plan` sorts the runs into groups, each of which :func:`solve_group` solves on its own (a
plain function of what can be pickled, for an executor's ``map``), and :func:`assemble` makes one
table of them. :func:`campaign_coefficients` does all three.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from analysis.coefficients.arrangements import arrangement_flags, other_arrangement
from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.campaign_checks import consistency
from analysis.coefficients.campaign_plan import Group, Request, check_campaign, plan
from analysis.coefficients.campaign_records import (
    ZERO_FREQUENCY,
    CoefficientEntry,
    Missing,
    OtherArrangement,
)
from analysis.coefficients.campaign_result import CampaignCoefficients, TrialColumns
from analysis.coefficients.campaign_solve import GroupCoefficients, solve_group
from analysis.coefficients.cycle_checks import missing_roll_gauge
from analysis.coefficients.line_cycles import by_lines
from analysis.coefficients.names import damping_of, is_inertial, is_seakeeping, place_of
from analysis.coefficients.repeats import Repeatability, outliers, repeatability, with_repeats
from analysis.coefficients.terms import term_of
from analysis.coefficients.zero_frequency import at_zero_frequency
from analysis.uncertainty.values import UncertainValues, stacked
from hardware.description.errors import ConfigurationError, DataError

Map = Callable[[Callable[[Any], Any], Iterable[Any]], Iterable[Any]]


@dataclass(frozen=True)
class _Solver:
    """Solve a group for a request: an object, so that it can be sent to another process."""

    request: Request

    def __call__(self, group: Group) -> GroupCoefficients:
        return solve_group(group, self.request)


def campaign_coefficients(
    cycles: Sequence[BodyCycle],
    request: Request = Request(),  # noqa: B008 - frozen
    *,
    mapped: Map = map,
) -> CampaignCoefficients:
    """Return all coefficients of a campaign.

    Parameters
    ----------
    cycles
        Of one oscillator and one model, each with its body (or a dry run taken off) and restoring;
        static runs have frequency 0.
    mapped
        An executor's ``map``, for groups side by side; the numbers are the same.

    Raises
    ------
    ConfigurationError
        If runs have one name, differ in geometry or lack the inertia; all faults are named.
    DataError
        If a wanted coefficient is not determined: the message says which run would do it.
    """
    groups, single, repeats = planned(cycles, request)
    return assemble(list(mapped(_Solver(request), groups)), single, repeats, request)


def planned(
    cycles: Sequence[BodyCycle], request: Request
) -> tuple[tuple[Group, ...], tuple[BodyCycle, ...], Repeatability]:
    """Return the groups, the runs with each line by itself, and what repeating them adds.

    It raises what :func:`campaign_coefficients` raises of the runs.
    """
    check_campaign(cycles)
    lines = [line for cycle in cycles for line in by_lines(cycle)]
    repeats = repeatability(lines)
    single = tuple(
        with_repeats(line, repeats) if line.frequency_hz > 0.0 else line for line in lines
    )
    return plan(single, request, [cycle for cycle in cycles if cycle.lines]), single, repeats


def assemble(
    blocks: Sequence[GroupCoefficients],
    cycles: Sequence[BodyCycle],
    repeats: Repeatability,
    request: Request,
) -> CampaignCoefficients:
    """Put the groups' coefficients together, with all that only the whole campaign tells.

    Raises
    ------
    DataError
        If a wanted coefficient is in none of the groups.
    """
    entries = tuple(entry for block in blocks for entry in block.entries)
    uncertain = stacked([block.uncertain for block in blocks])
    trials = TrialColumns(
        request.trials,
        *(np.concatenate([getattr(block.trials, name) for block in blocks])
          for name in ("standard_uncertainty", "low", "high")),
    ) if blocks else TrialColumns(0, np.zeros(0), np.zeros(0), np.zeros(0))  # fmt: skip
    coefficients = CampaignCoefficients(
        request.form,
        cycles[0].plane,
        "dimensional",
        request.level,
        entries,
        uncertain,
        trials,
        choices=tuple(choice for block in blocks for choice in block.choices),
        outliers=outliers(repeats),
        missing=_still_missing(blocks, entries),
        flags=tuple(dict.fromkeys(flag for block in blocks for flag in block.flags)),
    )
    _check_wanted(coefficients, cycles, request)
    extended = with_zero_frequency(coefficients) if request.zero_frequency else coefficients
    alternatives = tuple(_other_arrangements(coefficients, extended, blocks, cycles))
    return replace(
        extended,
        checks=consistency(extended, cycles),
        arrangements=alternatives,
        flags=(*extended.flags, *arrangement_flags(alternatives)),
    )


def _other_arrangements(
    coefficients: CampaignCoefficients,
    extended: CampaignCoefficients,
    blocks: Sequence[GroupCoefficients],
    cycles: Sequence[BodyCycle],
) -> Iterator[OtherArrangement]:
    """Yield the result under each alternative arrangement, where all groups kept their readings.

    Parameters
    ----------
    coefficients, extended
        Without and with the values at zero frequency.
    """
    if not all(block.refits for block in blocks):
        return
    for readings in zip(*(block.refits for block in blocks), strict=True):
        values = np.concatenate([reading.values for reading in readings])
        if len(extended.entries) > len(coefficients.entries) and np.isfinite(values).all():
            uncertain = UncertainValues(values, coefficients.uncertain.contributions)
            values = with_zero_frequency(replace(coefficients, uncertain=uncertain)).values
        evidence = sum(reading.evidence for reading in readings)
        first = readings[0]
        yield other_arrangement(
            extended, cycles[0].arrangement, first.key, first.alternative, values, evidence
        )


def _still_missing(
    blocks: Sequence[GroupCoefficients], entries: Sequence[CoefficientEntry]
) -> tuple[Missing, ...]:
    """Return the coefficients that no group determined."""
    names = {entry.name for entry in entries}
    missing_entries = dict.fromkeys(missing for block in blocks for missing in block.missing)
    return tuple(missing for missing in missing_entries if missing.name not in names)


def _check_wanted(
    coefficients: CampaignCoefficients, cycles: Sequence[BodyCycle], request: Request
) -> None:
    for name in request.wanted:
        _check_name(name, coefficients, request)
        if coefficients.rows(name):
            continue
        reasons = [missing.message for missing in coefficients.missing if missing.name == name]
        if not reasons and name.startswith("K_") and not all(cycle.has_roll for cycle in cycles):
            reasons = [missing_roll_gauge([cycle.name for cycle in cycles if not cycle.has_roll])]
        names = ", ".join(dict.fromkeys(entry.name for entry in coefficients.entries))
        raise DataError(
            reasons[0] if reasons else f"{name} is not determined by these runs ({names} are)"
        )


def _check_name(name: str, coefficients: CampaignCoefficients, request: Request) -> None:
    """Refuse a name that is neither of the form nor a term."""
    try:
        place_of(name, coefficients.plane, request.form)
    except ConfigurationError as unknown:
        try:
            term_of(name, coefficients.plane)
        except ConfigurationError:
            raise unknown from None


def with_zero_frequency(coefficients: CampaignCoefficients) -> CampaignCoefficients:
    """Return the campaign with each coefficient at zero frequency, where two frequencies allow it.

    At each frequency the fit of all amplitudes is taken; a linear value of one amplitude only where
    the load was found linear, for it holds what the amplitude adds.
    """
    entries, values = list(coefficients.entries), [coefficients.uncertain]
    for names, speed in _responses(coefficients):
        rows_of = {name: coefficients.at_each_frequency(name, speed) for name in names}
        if max(map(len, rows_of.values())) < 2:
            continue
        rows = [row for name in names for row in rows_of[name]]
        frequencies = [coefficients.entries[row].frequency_hz for row in rows]
        label = f"{' and '.join(names)} at {speed:g} m/s"
        kinds = [is_inertial(coefficients.entries[row].name) for row in rows]
        picked = coefficients.uncertain.select(rows)
        values.append(at_zero_frequency(label, frequencies, kinds, picked))
        entries += [_at_zero(coefficients, rows_of[name]) for name in names if rows_of[name]]
    added_count = len(entries) - len(coefficients.entries)
    empty = np.full(added_count, np.nan)
    trials = coefficients.trials
    return replace(
        coefficients,
        entries=tuple(entries),
        uncertain=stacked(values),
        trials=TrialColumns(
            trials.count,
            np.concatenate((trials.standard_uncertainty, empty)),
            np.concatenate((trials.low, empty)),
            np.concatenate((trials.high, empty)),
        ),
    )


def _responses(
    coefficients: CampaignCoefficients,
) -> Iterator[tuple[list[str], float]]:
    """Yield the names that are one response, added mass first, and their carriage speed.

    At speed added mass and damping of the seakeeping form hold what the incidence does, which has
    no limit in slow motion.
    """
    responses: dict[tuple[str, float], list[str]] = {}
    for name, speed in dict.fromkeys(
        (entry.name, entry.speed_m_s) for entry in coefficients.entries
    ):
        responses.setdefault((damping_of(name), speed), []).append(name)
    for (damping, speed), names in responses.items():
        if not (speed and is_seakeeping(damping)):
            yield sorted(names, key=is_inertial, reverse=True), speed


def _at_zero(coefficients: CampaignCoefficients, rows: Sequence[int]) -> CoefficientEntry:
    frequency_entries = [coefficients.entries[k] for k in rows]
    return replace(
        frequency_entries[0],
        method=ZERO_FREQUENCY,
        frequency_hz=0.0,
        translation_amplitude_m=max(entry.translation_amplitude_m for entry in frequency_entries),
        rotation_amplitude_rad=max(entry.rotation_amplitude_rad for entry in frequency_entries),
        runs=tuple(dict.fromkeys(run for entry in frequency_entries for run in entry.runs)),
        retained=min(entry.retained for entry in frequency_entries),
        misfit=np.nan,
    )


__all__ = [
    "CampaignCoefficients",
    "Request",
    "assemble",
    "campaign_coefficients",
    "with_zero_frequency",
]
