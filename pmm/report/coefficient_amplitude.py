"""Linear coefficients over the amplitude of the motion, a series for each frequency."""

from typing import TYPE_CHECKING

import numpy as np

from analysis.coefficients.campaign_records import LINEAR
from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.coefficients.names import PLACES, name_of, place_of
from pmm.report.coefficient_panels import (
    MOST_SERIES,
    axis_label,
    beside,
    finish,
    grid,
    points,
    settle,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_SAME = 0.02


def has_amplitudes(found: CampaignCoefficients, speed_m_s: float) -> bool:
    """Whether any coefficient was had at two amplitudes of one frequency."""
    return bool(_names(found, speed_m_s))


def amplitude_figure(found: CampaignCoefficients, speed_m_s: float) -> "Figure":
    """Draw a panel for each coefficient that was had at several amplitudes."""
    names = _names(found, speed_m_s)
    title = f"Over amplitude at {speed_m_s:g} m/s; {found.normalisation}"
    with grid(names, title, one_axis=False) as (figure, panels):
        shown = sorted({f for name in names for f, _ in _series(found, name, speed_m_s)})
        for name, panel in zip(names, panels, strict=True):
            used = []
            series = _series(found, name, speed_m_s)
            largest = 1e3 * max(_lever(found, k) for _, rows in series for k in rows)
            for frequency, rows in series:
                number = shown.index(frequency)
                aside = largest * beside(number, len(shown))
                at = [1e3 * _lever(found, k) + aside for k in rows]
                points(panel, found, rows, at, f"{frequency:.3g} Hz", number)
                used += found.values[rows].tolist()
            panel.set_xlim(0.0, 1.1 * largest)
            panel.set_ylabel(axis_label(found, name))
            settle(panel, used)
        level = f"series side by side; intervals of {100.0 * found.level:g} %"
        motions = [("translation (mm)", "rotation (mrad)")[_column(found, name)] for name in names]
        finish(figure, panels, [f"amplitude of {motion}, {level}" for motion in motions])
    return figure


def _names(found: CampaignCoefficients, speed_m_s: float) -> list[str]:
    linear = [name_of(place, found.plane, found.form) for place in PLACES]
    return [name for name in linear if any(_series(found, name, speed_m_s))]


def _series(
    found: CampaignCoefficients, name: str, speed_m_s: float
) -> list[tuple[float, list[int]]]:
    """Return frequency and rows where there are two amplitudes or more; of many an even choice."""
    found_at = []
    rows = found.rows(name, method=LINEAR, speed_m_s=speed_m_s)
    for frequency in sorted({round(found.entries[k].frequency_hz, 3) for k in rows}):
        own = [k for k in rows if abs(found.entries[k].frequency_hz - frequency) < 1e-3]
        sizes = [_lever(found, k) for k in own]
        if len(own) > 1 and max(sizes) > (1.0 + _SAME) * min(sizes):
            found_at.append((frequency, own))
    few = np.linspace(0, len(found_at) - 1, min(MOST_SERIES, len(found_at)))
    return [found_at[k] for k in few.round().astype(int)]


def _lever(found: CampaignCoefficients, row: int) -> float:
    """Return the amplitude of the motion that the coefficient is of: m or rad."""
    entry = found.entries[row]
    column = _column(found, entry.name)
    return (entry.translation_amplitude_m, entry.rotation_amplitude_rad)[column]


def _column(found: CampaignCoefficients, name: str) -> int:
    """Return the motion that a coefficient is of: 0 translation, 1 rotation."""
    return place_of(name, found.plane, found.form).column
