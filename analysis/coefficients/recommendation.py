"""The recommended value of each coefficient: which row of a campaign's table to use.

A manoeuvring derivative is that of slow motion: the value at zero frequency, where several
frequencies tell it, or that of static tests that tell the load's form, whichever is surer; else the
fit of all amplitudes, else a static test, else the linear value. A
coefficient of the seakeeping form belongs to its frequency, so that there is one at each. A
non-linear term is recommended only where the evidence for its form decides.
"""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from analysis.coefficients.campaign_nonlinear import (
    FIRST_HARMONICS,
    QUASI,
    STATIC_DRIFT,
    SURGE_FORCES,
)
from analysis.coefficients.campaign_records import (
    HIGHER_ORDER,
    JOINT,
    LINEAR,
    ROLL_DECAY,
    ZERO_FREQUENCY,
    CoefficientEntry,
)
from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.coefficients.form_choice import LINEAR_FORM
from analysis.coefficients.names import PLACES, Form, is_seakeeping, name_of
from analysis.coefficients.terms import LOAD_WORDS, load_of, term_of

_FIRST = (
    ZERO_FREQUENCY,
    JOINT,
    HIGHER_ORDER,
    FIRST_HARMONICS,
    STATIC_DRIFT,
    LINEAR,
    QUASI,
    SURGE_FORCES,
    ROLL_DECAY,
)  # single runs are checks on all of these


def recommended(coefficients: CampaignCoefficients) -> tuple[int, ...]:
    """Return the places of the values to be used first, one a coefficient and carriage speed.

    In the seakeeping form: one a coefficient, speed and frequency.
    """
    spread = coefficients.uncertain.standard_uncertainty
    kinds = dict.fromkeys((entry.name, entry.speed_m_s) for entry in coefficients.entries)
    curved = {kind: coefficients.is_nonlinear(*kind) for kind in kinds}

    def order(k: int) -> tuple[int, float, float]:
        """By method and frequency; then the smallest amplitude of a curve, else the surest."""
        entry, sure = coefficients.entries[k], float(np.nan_to_num(spread[k], nan=np.inf))
        judged = any(len(c.forms) > 1 for c in coefficients.choices_of(entry.name, entry.runs))
        if entry.method == ZERO_FREQUENCY or (entry.method == STATIC_DRIFT and judged):
            return 0, 0.0, sure  # both are of slow motion
        size = entry.translation_amplitude_m + entry.rotation_amplitude_rad
        last = size if curved[entry.name, entry.speed_m_s] else sure
        return _FIRST.index(entry.method), entry.frequency_hz, last

    best: dict[tuple[str, float, float], int] = {}
    for k in coefficients.rows():
        entry = coefficients.entries[k]
        if _serves(coefficients, entry, curved=curved[entry.name, entry.speed_m_s]):
            key = (entry.name, entry.speed_m_s, _own_frequency(entry))
            best[key] = min(best.get(key, k), k, key=order)
    return tuple(best.values())


def table(coefficients: CampaignCoefficients) -> Iterator[Mapping[str, Any]]:
    """Yield a row per entry: its own, value, uncertainty, interval, trials, whether first."""
    first = set(recommended(coefficients))
    spread, freedom = (
        coefficients.uncertain.standard_uncertainty,
        coefficients.uncertain.degrees_of_freedom,
    )
    half = coefficients.half_widths
    for k, entry in enumerate(coefficients.entries):
        yield {
            "name": entry.name,
            "unit": entry.unit,
            "method": entry.method,
            "frequency_hz": entry.frequency_hz,
            "speed_m_s": entry.speed_m_s,
            "translation_amplitude_m": entry.translation_amplitude_m,
            "rotation_amplitude_rad": entry.rotation_amplitude_rad,
            "runs": entry.runs,
            "value": float(coefficients.values[k]),
            "standard_uncertainty": float(spread[k]),
            "half_width": float(half[k]),
            "degrees_of_freedom": float(freedom[k]),
            "trials_low": float(coefficients.trials.low[k]),
            "trials_high": float(coefficients.trials.high[k]),
            "retained": entry.retained,
            "misfit": entry.misfit,
            "recommended": k in first,
        }


def _own_frequency(entry: CoefficientEntry) -> float:
    """Frequency that a coefficient belongs to; 0 for a derivative, which is of slow motion."""
    return round(entry.frequency_hz, 4) if is_seakeeping(entry.name) else 0.0


def _serves(coefficients: CampaignCoefficients, entry: CoefficientEntry, *, curved: bool) -> bool:
    if entry.method not in _FIRST:
        return False
    if is_seakeeping(entry.name):
        return entry.method == LINEAR
    if load_of(entry.name) == LOAD_WORDS[2]:
        return True
    if coefficients.form is Form.SEAKEEPING and not curved:
        names = [name_of(place, coefficients.plane, Form.MANOEUVRING) for place in PLACES]
        return entry.name not in names  # the same again in the other form
    term = term_of(entry.name, coefficients.plane)
    if term.degree < 2 or term.angles:  # every form has these
        return True
    choices = coefficients.choices_of(entry.name, entry.runs)
    return all(choice.fitted == choice.verdict != LINEAR_FORM for choice in choices)
