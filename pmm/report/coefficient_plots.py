"""The figures of a campaign's coefficients.

Over frequency and over amplitude, with intervals and reference tables, and where the uncertainty of
each comes from.
"""

from collections.abc import Iterator
from functools import partial
from typing import Final

from analysis.coefficients.campaign_result import CampaignCoefficients
from pmm.document.content import Figure
from pmm.report.coefficient_amplitude import amplitude_figure, has_amplitudes
from pmm.report.coefficient_budget import budget_figure, budget_rows
from pmm.report.coefficient_frequency import frequency_figure, panels_of

_CAPTIONS: Final = {
    "frequency": "Coefficients over frequency with their intervals: the recommended value, shaded "
    "across where it is that of slow motion, beside each frequency's own. Dashed lines are "
    "reference tables, where they were given.",
    "terms": "Non-linear terms, drawn alike.",
    "amplitude": "Linear coefficients over the amplitude of the motion: what does not lie on a "
    "level line is not linear.",
    "budget": "Left: the interval of each recommended value in per cent of it, hatched where it is "
    "as large as the value. Right: where it comes from, by kind of input.",
}


def figures(coefficients: CampaignCoefficients) -> Iterator[Figure]:
    """Yield every figure that the campaign allows."""
    for number, speed in enumerate(sorted({entry.speed_m_s for entry in coefficients.entries}), 1):
        for kind, names in panels_of(coefficients, speed).items():
            draw = partial(frequency_figure, coefficients, speed, names)
            yield Figure(f"{kind}-{number}", _caption(kind, speed), draw)
        if has_amplitudes(coefficients, speed):
            draw = partial(amplitude_figure, coefficients, speed)
            yield Figure(f"amplitude-{number}", _caption("amplitude", speed), draw)
        if rows := budget_rows(coefficients, speed):
            draw = partial(budget_figure, coefficients, rows, speed)
            yield Figure(f"budget-{number}", _caption("budget", speed), draw)


def _caption(kind: str, speed_m_s: float) -> str:
    return f"{speed_m_s:g} m/s. {_CAPTIONS[kind.partition('-')[0]]}"
