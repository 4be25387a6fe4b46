"""What the panels of coefficients have in common: a grid, names, units, series with intervals."""

import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Final

import numpy as np

from analysis.coefficients.campaign_result import CampaignCoefficients
from pmm.document.labels import plain
from pmm.document.style import PALETTE, new_figure

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MARKS: Final = "osD^vP*X"
MOST_SERIES: Final = 4  # of a panel: of more a reader loses which point belongs to what
_COLUMNS: Final = 2
_WIDTH, _HEIGHT = 10.5, 2.1
_ASIDE: Final = 0.01


@contextmanager
def grid(
    names: Sequence[str], title: str, *, one_axis: bool = True
) -> Iterator[tuple["Figure", list["Axes"]]]:
    """Give a figure to draw on, with a panel for each name, in two columns."""
    rows = math.ceil(len(names) / _COLUMNS)
    with new_figure(_WIDTH, _HEIGHT * rows + 1.1, plain(title)) as figure:
        panels = figure.subplots(rows, _COLUMNS, squeeze=False, sharex=one_axis).ravel().tolist()
        for panel in panels[len(names) :]:
            panel.set_visible(False)
        yield figure, panels[: len(names)]


def series_offset(number: int, count: int) -> float:
    """Return by what part of the axis a series stands aside, so that none hides another."""
    return _ASIDE * (number - (count - 1) / 2.0)


def finish(figure: "Figure", panels: Sequence["Axes"], labels: Sequence[str]) -> None:
    """Label the lowest panel of each kind in its column, and put one legend below all of them.

    Parameters
    ----------
    labels
        Of each panel's horizontal axis.
    """
    for k, (panel, label) in enumerate(zip(panels, labels, strict=True)):
        lowest = label not in labels[k + _COLUMNS :: _COLUMNS]
        panel.tick_params(labelbottom=lowest)
        if lowest:
            panel.set_xlabel(label)
    handles: dict[str, Artist] = {}
    for panel in panels:
        for handle, text in zip(*panel.get_legend_handles_labels(), strict=True):
            handles.setdefault(str(text), handle)
    if handles:
        figure.legend(
            list(handles.values()),
            list(handles),
            loc="outside lower center",
            ncols=min(4, len(handles)),
        )


def axis_label(coefficients: CampaignCoefficients, name: str) -> str:
    """Return ``name (unit)``; without dimensions the figure's title names the system."""
    unit = next(entry.unit for entry in coefficients.entries if entry.name == name)
    return f"{name}\n({'–' if unit == '1' else unit})"


def points(
    panel: "Axes",
    coefficients: CampaignCoefficients,
    rows: Sequence[int],
    positions: Sequence[float],
    label: str,
    number: int,
) -> None:
    """Draw values with their intervals, in the order of ``positions``."""
    order = np.argsort(positions)
    sorted_rows = [rows[k] for k in order]
    panel.errorbar(
        np.asarray(positions)[order],
        coefficients.values[sorted_rows],
        coefficients.half_widths[sorted_rows],
        fmt=f"{MARKS[number % len(MARKS)]}-",
        color=PALETTE[number % len(PALETTE)],
        ms=4.0,
        lw=0.8,
        elinewidth=1.2,
        capsize=2.5,
        label=label,
    )


def settle(panel: "Axes", values: Sequence[float]) -> None:
    """Keep what is level in looks level too: never less than 2 % of the value from end to end."""
    low, high = panel.get_ylim()
    size = float(np.abs(np.asarray(values)).max(initial=0.0))
    if high - low < 0.02 * size:
        middle = (low + high) / 2.0
        panel.set_ylim(middle - 0.01 * size, middle + 0.01 * size)
    panel.ticklabel_format(axis="y", useOffset=False)
