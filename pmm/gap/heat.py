"""Maps and rows of dots that diagnoses of any kind share."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from hardware.description.arrays import FloatArray
from pmm.document.labels import plain
from pmm.document.style import PALETTE, TRACE, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.collections import QuadMesh
    from matplotlib.figure import Figure


BEFORE, AFTER = PALETTE[1], PALETTE[0]
LEAST_U: Final = 0.05  # where a gap of nothing is drawn on a logarithmic axis
# E/u from noise (1 and less) to large: one hue, dark is more, told apart without colour too.
_LEVELS: Final = (0.0, 1.0, 2.0, 3.0, 5.0, 10.0, 30.0, 100.0)
_FEW_DECADES: Final = 30.0  # highest over lowest value of an axis
_OTHER: Final = "#B8BEC4"


@dataclass(frozen=True)
class Grid:
    """What the rows and columns of a map are called.

    Attributes
    ----------
    breaks
        Rows above which a line is drawn.
    titles
        Of the two maps.
    across
        What the columns are; nothing where their names say it.
    """

    rows: Sequence[str]
    columns: Sequence[str]
    breaks: Sequence[int] = ()
    titles: tuple[str, str] = ("without an effect", "with the answer")
    across: str = ""


def before_and_after(grid: Grid, maps: Sequence[FloatArray], label: str) -> "Figure":
    """Draw E/u without an effect and with the answer, side by side.

    Parameters
    ----------
    maps
        Of shape ``(rows, columns)``; NaN is left white.
    label
        Of the colours.
    """
    height = 1.6 + 0.17 * len(grid.rows)
    height += 0.06 * max((len(name) for name in grid.columns), default=0)
    with new_figure(10.5, max(height, 2.4)) as figure:
        axes = figure.subplots(1, 2, sharey=True)
        for place, title, values in zip(axes, grid.titles, maps, strict=True):
            image = _cells(place, values, grid)
            place.set_title(title, loc="left")
        figure.colorbar(image, ax=axes, shrink=0.7, ticks=_LEVELS).set_label(label)
    return figure


def _cells(axes: "Axes", values: FloatArray, grid: Grid) -> "QuadMesh":
    import matplotlib as mpl
    from matplotlib.colors import BoundaryNorm

    colours = mpl.colormaps["Blues"]
    norm = BoundaryNorm(_LEVELS, colours.N, extend="max")
    down, across = (np.arange(len(names) + 1) - 0.5 for names in (grid.rows, grid.columns))
    image = axes.pcolormesh(across, down, values, norm=norm, cmap=colours)
    axes.grid(visible=False)
    axes.set_ylim(len(grid.rows) - 0.5, -0.5)
    axes.set_xticks(range(len(grid.columns)), [plain(name) for name in grid.columns], rotation=90)
    axes.set_yticks(range(len(grid.rows)), [plain(name) for name in grid.rows], fontsize=7.0)
    axes.set_xlabel(grid.across)
    for at in grid.breaks:
        axes.axhline(at - 0.5, color=TRACE, linewidth=0.8)
    return image


def probability_bars(shares: Mapping[str, float], alike: Sequence[str], label: str) -> "Figure":
    """Draw probabilities as bars, those of what cannot be told from the first one in its colour."""
    with new_figure(10.5, 1.1 + 0.36 * len(shares)) as figure:
        axes = figure.add_subplot()
        for at, (name, share) in enumerate(shares.items()):
            axes.barh(at, share, color=AFTER if name in alike else _OTHER, height=0.7)
            axes.text(share + 0.01, at, f"{share:.3f}", va="center")
        axes.set_yticks(range(len(shares)), [plain(name) for name in shares])
        axes.invert_yaxis()
        axes.set_xlim(0.0, 1.12)
        axes.set_xlabel(label)
    return figure


@dataclass(frozen=True)
class Dots:
    """One mark for each row; NaN where there is none."""

    label: str
    mark: str
    colour: str
    values: Sequence[float]


def dotted(rows: Sequence[str], series: Sequence[Dots]) -> "Figure":
    """Draw gaps in u without and with some answers, noise taken off, a row for each regime."""
    count = len(rows)
    with new_figure(10.5, 1.6 + 0.36 * count) as figure:
        axes = figure.add_subplot()
        for step, dots in enumerate(series):
            points = [(value, at) for at, value in enumerate(dots.values) if not math.isnan(value)]
            if points:
                x = [max(value, LEAST_U) for value, _ in points]
                y = [at + 0.12 * (step - 1.5) for _, at in points]
                axes.plot(x, y, dots.mark, color=dots.colour, label=dots.label, markersize=6)
        axes.axvline(1.0, color=TRACE, linestyle="--")
        logarithmic(axes)
        axes.set_xlim(left=0.8 * LEAST_U)
        axes.set_yticks(range(count), [plain(row) for row in rows])
        axes.set_ylim(count - 0.5, -0.5)
        axes.set_xlabel(f"gap in u, noise taken off; {LEAST_U:g} and less are drawn at the left")
        figure.legend(loc="outside upper center", ncols=4)
    return figure


def logarithmic(axes: "Axes") -> None:
    """Scale the abscissa by decades with plain numbers, three to a decade where there are few."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    axes.set_xscale("log")
    low, high = axes.get_xlim()
    low, high = min(low, 0.45), max(high, 2.2)  # so that there are numbers beside the 1
    axes.set_xlim(low, high)
    if high < _FEW_DECADES * low:
        axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.xaxis.set_minor_formatter(NullFormatter())
