"""A campaign's table as others quote it: factors, shifts by the mass, names."""

from dataclasses import dataclass, field, replace

import numpy as np

from analysis.coefficients.campaign_records import ReferenceRow
from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.coefficients.campaign_systems import System, speed_power, term_of_entry
from analysis.coefficients.names import Form
from analysis.coefficients.normalisation import Normalisation
from analysis.coefficients.quoting import Quoting
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from analysis.coefficients.terms import term_of
from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError


@dataclass(frozen=True)
class QuotedMass:
    """The mass that is quoted with the coefficients, and what they were divided by.

    Attributes
    ----------
    cg_x_m
        Ahead of the point that the coefficients are about.
    system
        Of the table; ``None`` where it is in SI units.
    stated
        Uncertainties of mass, centre of gravity, speed and density: the same inputs act again.
    """

    mass_kg: float = 0.0
    cg_x_m: float = 0.0
    system: System | None = None
    stated: StatedUncertainties = field(default_factory=StatedUncertainties)


def quote(
    coefficients: CampaignCoefficients, quoting: Quoting, carried: QuotedMass = QuotedMass()
) -> CampaignCoefficients:
    """Return the campaign as it is quoted; tables beside it were held against what it was.

    Raises
    ------
    ConfigurationError
        If it is in the seakeeping form, which nobody quotes otherwise.
    """
    if quoting == Quoting():
        return coefficients
    if coefficients.form is not Form.MANOEUVRING:
        raise ConfigurationError(
            "--names and --with-mass are of manoeuvring derivatives; take --form manoeuvring"
        )
    factors, shifts = _factors(coefficients, quoting), _shifts(coefficients, quoting, carried)
    uncertain = coefficients.uncertain.scaled(factors)
    uncertain = replace(uncertain, values=uncertain.values + shifts)
    for label, parts in _slopes(coefficients, quoting, carried).items():
        uncertain = uncertain.plus(label, parts)
    return replace(
        coefficients,
        normalisation=coefficients.normalisation + quoting.description(coefficients.plane),
        entries=tuple(
            replace(entry, name=quoting.name(entry.name)) for entry in coefficients.entries
        ),
        uncertain=uncertain,
        trials=coefficients.trials.carried(coefficients.uncertain, uncertain, factors),
        references=tuple(
            _row(row, coefficients, quoting, carried) for row in coefficients.references
        ),
    )


def _factors(coefficients: CampaignCoefficients, quoting: Quoting) -> FloatArray:
    return np.array(
        [quoting.factor(term_of_entry(coefficients, entry)) for entry in coefficients.entries]
    )


def _shifts(
    coefficients: CampaignCoefficients, quoting: Quoting, carried: QuotedMass
) -> FloatArray:
    """Return what is added to each entry, in the table's system."""
    shifts = []
    for entry in coefficients.entries:
        term = term_of_entry(coefficients, entry)
        shift = quoting.mass_shift(
            term, coefficients.plane, carried.mass_kg, carried.cg_x_m, entry.speed_m_s
        )
        system = _system(carried, entry.speed_m_s)
        shifts.append(shift / system.term_factor(term) if system and shift else shift)
    return np.array(shifts)


def _system(carried: QuotedMass, speed_m_s: float) -> Normalisation | None:
    return None if carried.system is None else carried.system(speed_m_s)


def _slopes(
    coefficients: CampaignCoefficients, quoting: Quoting, carried: QuotedMass
) -> dict[str, FloatArray]:
    """Return what each stated input does to the shifts, per standard deviation."""
    stated, shifts = carried.stated, _shifts(coefficients, quoting, carried)
    heavier = replace(carried, mass_kg=carried.mass_kg + stated.mass_kg)
    ahead = replace(carried, cg_x_m=carried.cg_x_m + stated.cg_x_m)
    speeds = np.array([entry.speed_m_s or np.inf for entry in coefficients.entries])
    powers = np.zeros(len(shifts))
    if carried.system is not None:
        powers = np.array(
            [speed_power(coefficients, entry, carried.system(entry.speed_m_s)) if shift else 0.0
             for entry, shift in zip(coefficients.entries, shifts, strict=True)]
        )  # fmt: skip
    slopes = {
        "mass_kg": _shifts(coefficients, quoting, heavier) - shifts,
        "cg_x_m": _shifts(coefficients, quoting, ahead) - shifts,
        "speed_m_s": shifts * (1.0 - powers) / speeds * stated.speed_m_s,
        "density_relative": -shifts * stated.density_relative * (carried.system is not None),
    }
    return {key: slope for key, slope in slopes.items() if slope.any()}


def _row(
    row: ReferenceRow, coefficients: CampaignCoefficients, quoting: Quoting, carried: QuotedMass
) -> ReferenceRow:
    term = term_of(row.name, coefficients.plane)
    factor = quoting.factor(term)
    shift = quoting.mass_shift(
        term, coefficients.plane, carried.mass_kg, carried.cg_x_m, row.speed_m_s
    )
    if shift and (system := _system(carried, row.speed_m_s)):
        shift /= system.term_factor(term)
    return replace(
        row,
        name=quoting.name(row.name),
        measured=row.measured * factor + shift,
        half_width=row.half_width * factor,
        expected=row.expected * factor + shift,
        difference=row.difference * factor,
        allowance=row.allowance * factor,
    )
