"""The budget of one coefficient, GUM style: what each input adds.

Inputs of one kind stand in one line: the scatter of all runs, the repeats of all runs.
"""

import math
from dataclasses import dataclass

import numpy as np

from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.uncertainty.freedom import effective_freedom, student_factor

_KINDS = {
    "scatter of": "harmonic scatter",
    "repeats:": "repeats",
    "zero run": "zero runs",
    "extrapolation of": "extrapolation to zero frequency",
    "form of": "form of the loads",
}
_WORDS = {
    "mass_kg": "mass",
    "cg_x_m": "centre of gravity, ahead",
    "cg_z_m": "centre of gravity, height",
    "inertia_kg_m2": "moment of inertia",
    "half_spacing_m": "strut spacing",
    "speed_m_s": "carriage speed",
    "frequency_relative": "frequency",
    "restoring_relative": "restoring",
    "amplitude_relative": "amplitude",
    "strut_phase_rad": "phase setting",
    "lag_s": "amplifier lag",
    "skew_s": "skew between gauges",
    "force_gain_relative": "calibration, both gauges",
    "gauge_aft_relative": "calibration, aft gauge",
    "gauge_fore_relative": "calibration, fore gauge",
    "cross_talk_aft": "cross-talk into the aft gauge",
    "cross_talk_fore": "cross-talk into the fore gauge",
    "latency_s": "photocell latency",
    "midpoint_x_m": "alignment, model along the rig",
    "alignment_rad": "alignment, heading",
    "density_relative": "density",
    "heel_rad": "heel",
    "surge_gauge_relative": "calibration, surge gauge",
    "roll_gauge_relative": "calibration, roll gauge",
    "turn_rate_relative": "rate of turn on the circle",
    "turn_radius_m": "radius of the circle",
    "speed_age_s": "age of the carriage's speed",
}
_DIGIT = 0.1


@dataclass(frozen=True)
class BudgetLine:
    """What one kind of input adds.

    Attributes
    ----------
    contribution
        Standard uncertainty of the coefficient by this kind alone, in its unit.
    share
        Part of the variance; all lines together are 1. NaN where runs tell no scatter.
    degrees_of_freedom
        Effective, of the inputs of this kind.
    """

    source: str
    contribution: float
    share: float
    degrees_of_freedom: float


@dataclass(frozen=True)
class CoefficientBudget:
    """The budget of one coefficient, largest line first.

    Attributes
    ----------
    degrees_of_freedom
        Effective, by Welch and Satterthwaite; deviates of one input count as one term.
    coverage_factor, half_width
        Of the interval at the campaign's level.
    digits
        What is to be said where the coefficient is a small difference; empty where it is not.
    """

    name: str
    unit: str
    value: float
    standard_uncertainty: float
    degrees_of_freedom: float
    coverage_factor: float
    half_width: float
    lines: tuple[BudgetLine, ...]
    digits: str


def budget(coefficients: CampaignCoefficients, row: int) -> CoefficientBudget:
    """Return the budget of one entry of a campaign's table."""
    entry = coefficients.entries[row]
    spread = float(coefficients.uncertain.standard_uncertainty[row])
    freedom = float(coefficients.uncertain.degrees_of_freedom[row])
    factor = float(student_factor(freedom, coefficients.level))
    return CoefficientBudget(
        entry.name,
        entry.unit,
        float(coefficients.values[row]),
        spread,
        freedom,
        factor,
        factor * spread,
        _lines(coefficients, row, spread),
        _digits(entry.name, entry.retained),
    )


def _lines(coefficients: CampaignCoefficients, row: int, spread: float) -> tuple[BudgetLine, ...]:
    uncertain = coefficients.uncertain
    parts = uncertain.variances()[:, row]
    freedom = np.array(
        [contribution.degrees_of_freedom for contribution in uncertain.contributions]
    )
    kinds: dict[str, list[int]] = {}
    for k in np.flatnonzero(parts > 0.0).tolist():
        kinds.setdefault(_source(uncertain.contributions[k].label), []).append(k)
    lines = []
    for source, inputs in kinds.items():
        variances = parts[inputs]
        variance = float(variances.sum())
        kind_freedom = float(effective_freedom(variances[:, None], freedom[inputs])[0])
        lines.append(BudgetLine(source, math.sqrt(variance), variance / spread**2, kind_freedom))
    return tuple(sorted(lines, key=lambda line: -line.share))


def _source(label: str) -> str:
    kind = next((words for start, words in _KINDS.items() if label.startswith(start)), None)
    return kind or _WORDS.get(label, label)


def _digits(name: str, retained: float) -> str:
    if math.isnan(retained) or retained >= _DIGIT:
        return ""
    lost = -math.log10(max(retained, 1e-12))
    return (
        f"{name} is {100.0 * retained:.2g} % of the largest part of the load that it is left from: "
        f"{lost:.1f} digits are lost in the difference"
    )
