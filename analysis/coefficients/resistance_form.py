"""Whether the resistance is constant as the model turns, or goes with u^2: what the data support.

``X_vv`` is that of a model that keeps its speed u ahead, in tows and oscillations alike. A tow at a
drift angle keeps the carriage's speed and loses u, so that there X_0 goes with u^2 by definition:
``X_0 + X_vv v^2`` at the speed U along the track is ``X_0 (u/U)^2 + (X_vv + X_0/U^2) v^2``.

A model that yaws on a steady carriage is slowed and hastened along its own axis, so that its
resistance swings at twice the frequency, as r^2 does with the other sign: taken as constant, what
it swings by is fitted to X_rr and X_vr, which it does not follow.
"""

from collections.abc import Sequence
from dataclasses import replace
from statistics import fmean
from typing import Final

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.campaign_records import FormChoice
from analysis.coefficients.cycle_fit import CycleFit, fit_cycles, fit_terms
from analysis.coefficients.form_choice import chosen_of_two
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from analysis.coefficients.terms import SURGE
from hardware.description.errors import DataError

BY_SPEED = "resistance by u^2"
CONSTANT = "constant resistance"
PROPELLED: Final = "propeller_turns"  # flag of a run whose X_0 holds a propeller's thrust


def with_further_term(
    cycles: Sequence[BodyCycle], names: Sequence[str], further: str, orders: tuple[int, ...]
) -> tuple[tuple[str, ...], FormChoice | None]:
    """Return the terms of X, with a further one where the data ask for it.

    It is taken where it is :data:`DECIDES` times as well supported as none; the choice says so.
    """
    richer = (*names, further)
    try:
        (plain, _), (rich, _) = (fit_surge(cycles, terms, orders) for terms in (names, richer))
    except DataError:
        return tuple(names), None
    forms = (f"with {further}", f"without {further}")
    reason = f"with {further} it is {{}} as well described as without"
    choice = chosen_of_two(cycles, SURGE, forms, (rich, plain), reason)
    return (tuple(names) if choice is None else richer), choice


def fit_surge(
    cycles: Sequence[BodyCycle],
    names: Sequence[str],
    orders: tuple[int, ...],
    *,
    stated: StatedUncertainties = StatedUncertainties(),  # noqa: B008 - frozen
) -> tuple[CycleFit, FormChoice | None]:
    """Return the fit of X, and how it was found that resistance goes with u^2 where it does.

    ``X_0`` is the resistance at the carriage's speed U either way: ``X_0`` or ``X_0 (u/U)^2``, as
    many terms. Of oscillations the first is taken unless the other is :data:`DECIDES` times as well
    supported; tows at one speed cannot tell them, and take the second.

    Raises
    ------
    ConfigurationError, DataError
        As :func:`analysis.coefficients.cycle_fit.fit_cycles` does.
    """
    constant = fit_cycles(cycles, names, orders, stated=stated)
    speed = fmean(cycle.speed_m_s for cycle in cycles)
    if "X_0" not in names or not speed > 0.0:
        return constant, None
    terms = tuple(
        term if term.factors else replace(term, of_speed_m_s=speed) for term in constant.terms
    )
    if not any(cycle.frequency_hz for cycle in cycles):
        return fit_terms(cycles, terms, constant.names, orders, stated=stated), None
    try:
        squared = fit_terms(cycles, terms, constant.names, orders, stated=stated)
    except DataError:
        return constant, None
    reason = (
        "a resistance that goes with u^2 as the model turns is {} as well supported as a constant "
        "one: X_0 is that at the carriage's speed"
    )
    choice = chosen_of_two(cycles, SURGE, (BY_SPEED, CONSTANT), (squared, constant), reason)
    return (constant if choice is None else squared), choice
