"""Coefficients over frequency: the recommended value, each frequency's own, reference tables."""

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from analysis.coefficients.campaign_nonlinear import STATIC_DRIFT
from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.coefficients.names import PLACES, name_of
from analysis.coefficients.recommendation import recommended
from pmm.document.style import PALETTE, TRACE
from pmm.report.coefficient_panels import (
    MOST_SERIES,
    axis_label,
    finish,
    grid,
    points,
    series_offset,
    settle,
)
from pmm.report.coefficient_tables import amplitudes

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

RECOMMENDED: Final = "recommended"
_MOST_PANELS: Final = 8
_DASHES: Final = ("--", ":", "-.")
_MARGIN: Final = 0.04  # of the axis, right of the highest frequency
_BAND: Final = 0.15  # opacity of the recommended value's interval


def panels_of(coefficients: CampaignCoefficients, speed_m_s: float) -> dict[str, list[str]]:
    """Return the coefficients of each figure: linear ones together, the rest eight at a time."""
    names = list(
        dict.fromkeys(coefficients.entries[k].name for k in coefficients.rows(speed_m_s=speed_m_s))
    )
    linear = [name_of(place, coefficients.plane, coefficients.form) for place in PLACES]
    first = [name for name in linear if name in names]
    rest = [name for name in names if name not in first]
    groups = {"frequency": first} if first else {}
    for k in range(0, len(rest), _MOST_PANELS):
        kind = "terms" if k == 0 else f"terms-{k // _MOST_PANELS + 1}"
        groups[kind] = rest[k : k + _MOST_PANELS]
    return groups


def frequency_figure(
    coefficients: CampaignCoefficients, speed_m_s: float, names: Sequence[str]
) -> "Figure":
    """Draw a panel for each coefficient at one speed, of at most four series."""
    title = f"Coefficients at {speed_m_s:g} m/s; {coefficients.normalisation}"
    with grid(names, title) as (figure, panels):
        series = {name: list(_series(coefficients, name, speed_m_s)) for name in names}
        labels = list(dict.fromkeys(label for curves in series.values() for label, _ in curves))
        widest = max(
            coefficients.entries[k].frequency_hz for k in coefficients.rows(speed_m_s=speed_m_s)
        )
        for name, panel in zip(names, panels, strict=True):
            values = []
            for label, rows in series[name]:
                number = labels.index(label)
                offset = widest * series_offset(number, len(labels))
                positions = [coefficients.entries[k].frequency_hz + offset for k in rows]
                points(panel, coefficients, rows, positions, label, number)
                values += coefficients.values[rows].tolist()
            _draw_band(panel, coefficients, series[name])
            most = MOST_SERIES - len(series[name])
            values += _draw_references(panel, coefficients, name, speed_m_s, most)
            panel.set_ylabel(axis_label(coefficients, name))
            settle(panel, values)
        _align(panels)
        label = (
            f"frequency (Hz), series side by side; intervals of {100.0 * coefficients.level:g} %"
        )
        finish(figure, panels, [label] * len(panels))
    return figure


def _align(panels: Sequence["Axes"]) -> None:
    """Give all panels one axis of frequency, from zero."""
    left = min(0.0, *(panel.get_xlim()[0] for panel in panels))
    right = max(panel.get_xlim()[1] for panel in panels)
    for panel in panels:
        panel.set_xlim(left, right + _MARGIN * (right - left))


def _series(
    coefficients: CampaignCoefficients, name: str, speed_m_s: float
) -> Iterator[tuple[str, list[int]]]:
    """Yield the recommended values, then those of each frequency, then a static test's."""
    rows = coefficients.rows(name, speed_m_s=speed_m_s)
    chosen = recommended(coefficients)
    first = [k for k in rows if k in chosen]
    if first:
        yield RECOMMENDED, first
    frequency_rows = [k for k in coefficients.at_each_frequency(name, speed_m_s) if k not in first]
    if frequency_rows:
        yield _label(coefficients, frequency_rows), frequency_rows
    static = [k for k in rows if coefficients.entries[k].method == STATIC_DRIFT and k not in first]
    if static:
        yield STATIC_DRIFT, static


def _label(coefficients: CampaignCoefficients, rows: Sequence[int]) -> str:
    """Return the method, with the motion where it is of one amplitude and that is the same."""
    entries = [coefficients.entries[k] for k in rows]
    methods = " or ".join(dict.fromkeys(entry.method for entry in entries))
    motions = {
        amplitudes(entry.translation_amplitude_m, entry.rotation_amplitude_rad).partition(",")[0]
        for entry in entries
    }
    several = any(len(entry.runs) > 2 for entry in entries) or len(motions) > 1
    return methods if several else f"{methods}, {motions.pop()}"


def _draw_band(
    panel: "Axes", coefficients: CampaignCoefficients, series: Sequence[tuple[str, list[int]]]
) -> None:
    """Shade the interval of a recommended value of slow motion across all frequencies."""
    rows = dict(series).get(RECOMMENDED, [])
    if len(rows) == 1 and len(series) > 1 and np.isfinite(coefficients.half_widths[rows[0]]):
        value, half = float(coefficients.values[rows[0]]), float(coefficients.half_widths[rows[0]])
        panel.axhspan(value - half, value + half, color=PALETTE[0], alpha=_BAND, lw=0.0)


def _draw_references(
    panel: "Axes", coefficients: CampaignCoefficients, name: str, speed_m_s: float, most: int
) -> list[float]:
    """Draw the tables' values at the measured frequencies; return them."""
    unit = next(entry.unit for entry in coefficients.entries if entry.name == name)
    rows = [
        reference
        for reference in coefficients.references
        if reference.name == name
        and reference.unit == unit
        and abs(reference.speed_m_s - speed_m_s) < 1e-9
    ]
    tables = list(dict.fromkeys(row.reference for row in rows))[:most]
    for number, table in enumerate(tables):
        pairs = sorted({(row.frequency_hz, row.expected) for row in rows if row.reference == table})
        frequencies_hz, expected = zip(*pairs, strict=True)
        style = _DASHES[number % len(_DASHES)]
        panel.plot(frequencies_hz, expected, style, marker="_", color=TRACE, ms=9.0, label=table)
    return [row.expected for row in rows if row.reference in tables]
