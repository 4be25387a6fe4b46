"""A campaign's table in a system without dimensions, each entry by its own speed."""

import re
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from analysis.coefficients.campaign_records import CoefficientEntry
from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.coefficients.names import Form, place_of
from analysis.coefficients.normalisation import DIMENSIONAL, Normalisation
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from analysis.coefficients.terms import Term, term_of
from hardware.description.errors import ConfigurationError

System = Callable[[float], Normalisation]
"""From a carriage speed to the system there: ``lambda u: prime(length, u, density)``."""


def without_dimensions(
    coefficients: CampaignCoefficients,
    system: System,
    stated: StatedUncertainties = StatedUncertainties(),  # noqa: B008 - frozen
) -> CampaignCoefficients:
    """Return the campaign in a system without dimensions.

    Parameters
    ----------
    stated
        Uncertainty of the density and of the speed, as they were stated for the campaign: the same
        inputs act again in what the values are divided by.

    Raises
    ------
    ConfigurationError
        If the campaign is in a system already, or holds a speed at which the system has no meaning.
    """
    _check_system(coefficients, DIMENSIONAL)
    systems = [system(entry.speed_m_s) for entry in coefficients.entries]
    factors = np.array(
        [_factor(coefficients, e, s) for e, s in zip(coefficients.entries, systems, strict=True)]
    )
    uncertain = coefficients.uncertain.scaled(1.0 / factors)
    if stated.density_relative > 0.0:
        uncertain = uncertain.plus("density_relative", -uncertain.values * stated.density_relative)
    if stated.speed_m_s > 0.0 and any(system.speed_m_s > 0.0 for system in systems):
        pairs = zip(coefficients.entries, systems, strict=True)
        powers = np.array(
            [speed_power(coefficients, entry, entry_system) for entry, entry_system in pairs]
        )
        speeds = np.array([system.speed_m_s or np.inf for system in systems])
        parts = -uncertain.values * powers * stated.speed_m_s / speeds
        uncertain = uncertain.plus("speed_m_s", parts)
    return replace(
        coefficients,
        normalisation=common_name(systems),
        entries=tuple(replace(entry, unit="1") for entry in coefficients.entries),
        uncertain=uncertain,
        trials=coefficients.trials.carried(coefficients.uncertain, uncertain, 1.0 / factors),
    )


def _check_system(coefficients: CampaignCoefficients, needed: str) -> None:
    if coefficients.normalisation != needed:
        raise ConfigurationError(
            f"the coefficients are in the system {coefficients.normalisation!r}, not in {needed!r}"
        )


def common_name(systems: Sequence[Normalisation]) -> str:
    """Return the systems' name; without the speed where they are of several."""
    names = list(dict.fromkeys(system.name for system in systems))
    if len(names) == 1:
        return names[0]
    return re.sub(r"U = [^ ]+ m/s", "U = the carriage's", names[0]) if names else DIMENSIONAL


def term_of_entry(coefficients: CampaignCoefficients, entry: CoefficientEntry) -> Term:
    """Return a coefficient of either form as a term: ``a35`` is that of a rotation's rate."""
    try:
        return term_of(entry.name, coefficients.plane)
    except ConfigurationError:
        place = place_of(entry.name, coefficients.plane, Form.SEAKEEPING)
        letter = "vr"[place.column]
        return Term(place.row, (letter + "dot" if place.inertial else letter,))


def _factor(
    coefficients: CampaignCoefficients, entry: CoefficientEntry, system: Normalisation
) -> float:
    return system.term_factor(term_of_entry(coefficients, entry))


def speed_power(
    coefficients: CampaignCoefficients, entry: CoefficientEntry, system: Normalisation
) -> float:
    """Power of the speed in what the value is divided by."""
    term = term_of_entry(coefficients, entry)
    return 2.0 - term.degree - term.rates if system.speed_m_s > 0.0 else 0.0
