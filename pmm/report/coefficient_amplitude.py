"""Linear coefficients over the amplitude of the motion, a series for each frequency."""

from typing import TYPE_CHECKING

import numpy as np

from analysis.coefficients.campaign_records import LINEAR
from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.coefficients.names import PLACES, name_of, place_of
from pmm.report.coefficient_panels import (
    MOST_SERIES,
    axis_label,
    finish,
    grid,
    points,
    series_offset,
    settle,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_SAME = 0.02


def has_amplitudes(coefficients: CampaignCoefficients, speed_m_s: float) -> bool:
    """Whether any coefficient was had at two amplitudes of one frequency."""
    return bool(_names(coefficients, speed_m_s))


def amplitude_figure(coefficients: CampaignCoefficients, speed_m_s: float) -> "Figure":
    """Draw a panel for each coefficient that was had at several amplitudes."""
    names = _names(coefficients, speed_m_s)
    title = f"Over amplitude at {speed_m_s:g} m/s; {coefficients.normalisation}"
    with grid(names, title, one_axis=False) as (figure, panels):
        frequencies = sorted(
            {f for name in names for f, _ in _series(coefficients, name, speed_m_s)}
        )
        for name, panel in zip(names, panels, strict=True):
            values = []
            series = _series(coefficients, name, speed_m_s)
            largest = 1e3 * max(_lever(coefficients, k) for _, rows in series for k in rows)
            for frequency, rows in series:
                number = frequencies.index(frequency)
                offset = largest * series_offset(number, len(frequencies))
                positions = [1e3 * _lever(coefficients, k) + offset for k in rows]
                points(panel, coefficients, rows, positions, f"{frequency:.3g} Hz", number)
                values += coefficients.values[rows].tolist()
            panel.set_xlim(0.0, 1.1 * largest)
            panel.set_ylabel(axis_label(coefficients, name))
            settle(panel, values)
        level = f"series side by side; intervals of {100.0 * coefficients.level:g} %"
        motions = [
            ("translation (mm)", "rotation (mrad)")[_column(coefficients, name)] for name in names
        ]
        finish(figure, panels, [f"amplitude of {motion}, {level}" for motion in motions])
    return figure


def _names(coefficients: CampaignCoefficients, speed_m_s: float) -> list[str]:
    linear = [name_of(place, coefficients.plane, coefficients.form) for place in PLACES]
    return [name for name in linear if any(_series(coefficients, name, speed_m_s))]


def _series(
    coefficients: CampaignCoefficients, name: str, speed_m_s: float
) -> list[tuple[float, list[int]]]:
    """Return frequency and rows where there are two amplitudes or more; of many an even choice."""
    series = []
    rows = coefficients.rows(name, method=LINEAR, speed_m_s=speed_m_s)
    for frequency in sorted({round(coefficients.entries[k].frequency_hz, 3) for k in rows}):
        group = [k for k in rows if abs(coefficients.entries[k].frequency_hz - frequency) < 1e-3]
        sizes = [_lever(coefficients, k) for k in group]
        if len(group) > 1 and max(sizes) > (1.0 + _SAME) * min(sizes):
            series.append((frequency, group))
    few = np.linspace(0, len(series) - 1, min(MOST_SERIES, len(series)))
    return [series[k] for k in few.round().astype(int)]


def _lever(coefficients: CampaignCoefficients, row: int) -> float:
    """Return the amplitude of the motion that the coefficient is of: m or rad."""
    entry = coefficients.entries[row]
    column = _column(coefficients, entry.name)
    return (entry.translation_amplitude_m, entry.rotation_amplitude_rad)[column]


def _column(coefficients: CampaignCoefficients, name: str) -> int:
    """Return the motion that a coefficient is of: 0 translation, 1 rotation."""
    return place_of(name, coefficients.plane, coefficients.form).column
