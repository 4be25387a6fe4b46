"""Coefficients over frequency, with intervals, the value at zero frequency and reference tables."""

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Final

from analysis.coefficients.campaign_records import LINEAR
from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.coefficients.names import PLACES, name_of
from pmm.report.coefficient_panels import axis_label, beside, finish, grid, points, settle
from pmm.report.style import TRACE, drawing

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MOST_PANELS: Final = 8
_SAME_SIZE: Final = 0.02
_DASHES: Final = ("--", ":", "-.")
_MARGIN: Final = 0.04  # of the axis, right of the highest frequency


def panels_of(found: CampaignCoefficients, speed_m_s: float) -> dict[str, list[str]]:
    """Return the coefficients of each figure: linear ones together, the rest eight at a time."""
    names = list(dict.fromkeys(found.entries[k].name for k in found.rows(speed_m_s=speed_m_s)))
    linear = [name_of(place, found.plane, found.form) for place in PLACES]
    first = [name for name in linear if name in names]
    rest = [name for name in names if name not in first]
    groups = {"frequency": first} if first else {}
    for k in range(0, len(rest), _MOST_PANELS):
        kind = "terms" if k == 0 else f"terms-{k // _MOST_PANELS + 1}"
        groups[kind] = rest[k : k + _MOST_PANELS]
    return groups


def frequency_figure(
    found: CampaignCoefficients, speed_m_s: float, names: Sequence[str]
) -> "Figure":
    """Draw a panel for each coefficient at one speed."""
    with drawing():
        title = f"Coefficients at {speed_m_s:g} m/s; {found.normalisation}"
        figure, panels = grid(names, title)
        labels = [label for label, _ in _series(found, names, speed_m_s)]
        numbers = {label: k for k, label in enumerate(dict.fromkeys(labels))}
        widest = max(_place(found.entries[k].frequency_hz) for k in found.rows(speed_m_s=speed_m_s))
        for name, panel in zip(names, panels, strict=True):
            used = []
            for label, rows in _series(found, [name], speed_m_s):
                aside = widest * beside(numbers[label], len(numbers))
                at = [_place(found.entries[k].frequency_hz) + aside for k in rows]
                joined = found.entries[rows[0]].method == LINEAR
                points(panel, found, rows, at, label, numbers[label], joined=joined)
                used += found.values[rows].tolist()
            used += _draw_references(panel, found, name, speed_m_s)
            panel.set_ylabel(axis_label(found, name))
            settle(panel, used)
        left = min(0.0, *(panel.get_xlim()[0] for panel in panels))
        right = max(panel.get_xlim()[1] for panel in panels)
        for panel in panels:
            panel.set_xlim(left, right + _MARGIN * (right - left))
        label = f"frequency (Hz), series side by side; intervals of {100.0 * found.level:g} %"
        finish(figure, panels, [label] * len(panels))
    return figure


def _place(frequency_hz: float) -> float:
    """Return where a value stands: one that several frequencies share stands at none of them."""
    return 0.0 if math.isnan(frequency_hz) else frequency_hz


def _series(
    found: CampaignCoefficients, names: Sequence[str], speed_m_s: float
) -> Iterator[tuple[str, list[int]]]:
    """Yield rows that belong together: a method, and for linear ones an amplitude."""
    for name in names:
        rows = found.rows(name, speed_m_s=speed_m_s)
        for method in dict.fromkeys(found.entries[k].method for k in rows):
            own = [k for k in rows if found.entries[k].method == method]
            if method != LINEAR:
                yield method, own
                continue
            for size, group in _by_amplitude(found, own):
                yield f"{method}, {size}", group


def _by_amplitude(
    found: CampaignCoefficients, rows: Sequence[int]
) -> Iterator[tuple[str, list[int]]]:
    sizes: list[tuple[float, list[int]]] = []
    for k in sorted(rows, key=lambda k: found.entries[k].translation_amplitude_m):
        own = _size(found, k)
        if sizes and abs(own - sizes[-1][0]) <= _SAME_SIZE * own:
            sizes[-1][1].append(k)
        else:
            sizes.append((own, [k]))
    for own, group in sizes:
        turning = found.entries[group[0]].translation_amplitude_m < 1e-9
        yield (f"{math.degrees(own):.3g}°" if turning else f"{1e3 * own:.3g} mm"), group


def _size(found: CampaignCoefficients, row: int) -> float:
    entry = found.entries[row]
    way = entry.translation_amplitude_m
    return entry.rotation_amplitude_rad if way < 1e-9 else way


def _draw_references(
    panel: "Axes", found: CampaignCoefficients, name: str, speed_m_s: float
) -> list[float]:
    """Draw the tables' values at the measured frequencies; return them."""
    unit = next(entry.unit for entry in found.entries if entry.name == name)
    rows = [
        one
        for one in found.references
        if one.name == name and one.unit == unit and abs(one.speed_m_s - speed_m_s) < 1e-9
    ]
    for number, table in enumerate(dict.fromkeys(one.reference for one in rows)):
        own = sorted({(one.frequency_hz, one.expected) for one in rows if one.reference == table})
        at, expected = zip(*own, strict=True)
        style = _DASHES[number % len(_DASHES)]
        panel.plot(at, expected, style, marker="_", color=TRACE, ms=9.0, label=table)
    return [one.expected for one in rows]
