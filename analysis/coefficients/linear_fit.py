"""Linear coefficients of runs at one frequency and speed: the fit of first harmonics, with flags.

Runs with different mixtures of translation and rotation (pure heave and pure pitch; at the
carriage's speed pure pitch moves the midpoint too) are fitted together. What they cannot tell is
refused, with the run it takes.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.cycle_fit import FIRST, CycleFit, fit_terms
from analysis.coefficients.identifiability import (
    ALONE,
    fundamental_velocities,
    identifiable_motions,
    missing_run,
    mixture_run,
    motion_words,
)
from analysis.coefficients.names import PLACES, Form, MatrixElement, name_of
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from analysis.coefficients.terms import Term
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity

_FACTORS = (("v", "vdot"), ("r", "rdot"))
_NOTICED = 1e-3
_DIGIT = 0.1
DISAGREE: Final = 3.0
"""How much more than their scatter values differ, root mean square, where they are doubted."""


@dataclass(frozen=True, eq=False)
class LinearFit:
    """What first harmonics give.

    Attributes
    ----------
    retained
        What a coefficient's part of the load is of the largest part it is the remainder of, shape
        ``(n,)``: 0.1 loses one digit.
    misfit
        Root mean square residual over what scatter leads to expect; NaN without one left over.
    """

    fit: CycleFit
    places: tuple[MatrixElement, ...]
    retained: FloatArray
    misfit: float
    flags: tuple[Flag, ...]


def linear_fit(cycles: Sequence[BodyCycle], form: Form, stated: StatedUncertainties) -> LinearFit:
    """Return all linear coefficients that the runs determine.

    Raises
    ------
    DataError
        If they determine none: the message says which run would.
    """
    moved = fundamental_velocities(cycles, form)
    columns = identifiable_motions(moved)
    if not columns:
        raise DataError(mixture_run(cycles, form, moved))
    places = tuple(place for place in PLACES if place.column in columns)
    terms = tuple(map(term_at, places))
    names = tuple(name_of(place, cycles[0].plane, form) for place in places)
    fit = fit_terms(cycles, terms, names, FIRST, form=form, stated=stated)
    retained = _retained(cycles, moved, places, fit.values)
    misfit = fit.misfit(0, 1)
    flags = (
        *(flag.of(cycle.name) for cycle in cycles for flag in cycle.flags),
        *_flags(fit, places, retained, misfit),
        *_neglected(cycles, form, columns, moved),
    )
    return LinearFit(fit, places, retained, misfit, flags)


def term_at(place: MatrixElement) -> Term:
    """Return the term whose coefficient stands at a place."""
    return Term(place.row, (_FACTORS[place.column][place.inertial],))


def lacking_places(cycles: Sequence[BodyCycle], form: Form) -> list[tuple[str, str]]:
    """Return the names of what runs do not tell, and which run would."""
    moved = fundamental_velocities(cycles, form)
    columns = identifiable_motions(moved)
    names = [(name_of(place, cycles[0].plane, form), place) for place in PLACES]
    return [
        (
            name,
            missing_run(name, place, cycles, form, moved)
            if columns
            else mixture_run(cycles, form, moved),
        )
        for name, place in names
        if place.column not in columns
    ]


def _retained(
    cycles: Sequence[BodyCycle],
    moved: np.ndarray,
    places: Sequence[MatrixElement],
    values: FloatArray,
) -> FloatArray:
    """Return each coefficient's part of the load over the largest it is left from, ``(n,)``."""
    ratios = []
    for place, value in zip(places, values, strict=True):
        k = int(np.argmax(np.abs(moved[:, place.column])))
        cycle = cycles[k]
        pace = abs(moved[k, place.column]) / (cycle.half_spacing_m if place.column else 1.0)
        part = abs(float(value)) * pace
        part *= 2.0 * np.pi * cycle.frequency_hz if place.inertial else 1.0
        largest = max(abs(cycle.loads[place.row]), *cycle.load_magnitudes[:, place.row])
        ratios.append(part / max(part, largest, 1e-300))
    return np.array(ratios)


def _flags(
    fit: CycleFit, places: Sequence[MatrixElement], retained: FloatArray, misfit: float
) -> list[Flag]:
    flags = []
    runs = tuple(cycle.name for cycle in fit.problem.numbers.cycles)
    for name, place, part in zip(fit.names, places, retained, strict=True):
        if part < _DIGIT:
            quantity = "gain, mass or restoring" if place.inertial else "phase (in radians)"
            text = (
                f"{name} is {100.0 * part:.2g} % of the largest part of the load (limit "
                f"{100 * _DIGIT:g} %): an error in {quantity} is {1.0 / max(part, 1e-12):.3g} "
                "times as large in it"
            )
            flags.append(Flag("digits_lost", Severity.WARNING, text, name, runs))
    if misfit > DISAGREE:
        text = (
            f"the runs differ {misfit:.2g} times as much as their scatter (limit {DISAGREE:g}): "
            "amplitude, alignment or a force that is not linear; solve them apart"
        )
        flags.append(Flag("runs_disagree", Severity.WARNING, text, None, runs))
    if not np.isfinite(fit.uncertain.standard_uncertainty).all():
        text = "a run has too few periods for scatter: no interval can be given"
        flags.append(Flag("no_interval", Severity.WARNING, text, None, runs))
    return flags


def _neglected(
    cycles: Sequence[BodyCycle], form: Form, columns: tuple[int, ...], moved: np.ndarray
) -> tuple[Flag, ...]:
    if len(columns) == 2:
        return ()
    size, column = np.abs(moved).max(axis=0), columns[0]
    part = size[1 - column] / size[column]
    if part <= _NOTICED:
        return ()
    words = motion_words(cycles[0].plane, form)
    text = (
        f"{words[1 - column]} of {100 * part:.2g} % of {words[column]} at the struts was left out "
        f"(limit {100 * ALONE:g} %); add a run in {words[1 - column]} to have it taken off"
    )
    runs = tuple(cycle.name for cycle in cycles)
    return (Flag("other_motion_left_out", Severity.WARNING, text, None, runs),)
