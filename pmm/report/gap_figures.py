"""Figures of the gap diagnosis: heat map, walk, ranking, before and after, force map."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from analysis.gap.description import ForceMap
from analysis.gap.where import CHAIN
from pmm.gap.cells import Cell
from pmm.gap.report import GapReport, joined
from pmm.report.labels import plain
from pmm.report.style import PALETTE, TRACE, drawing

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.collections import QuadMesh
    from matplotlib.figure import Figure

FloatArray = NDArray[np.float64]

# E/u from noise (1 and less) to large: one hue, dark is more, told apart without colour too.
_LEVELS: Final = (0.0, 1.0, 2.0, 3.0, 5.0, 10.0, 30.0, 100.0)
_BEFORE, _AFTER = PALETTE[1], PALETTE[0]
_LEAST_U: Final = 0.05  # where a gap of nothing is drawn on a logarithmic axis
_FEW_DECADES: Final = 30.0  # highest over lowest value of an axis


def heat_map(report: GapReport) -> "Figure":
    """Draw E/u of each channel's harmonics over the runs, before and after the best answer."""
    from matplotlib.figure import Figure

    rows = sorted({(one.stage, one.channel, one.order) for one in report.cells}, key=_downstream)
    runs = list(dict.fromkeys(one.run for one in report.cells))
    with drawing():
        height = 1.6 + 0.17 * len(rows) + 0.06 * max((len(name) for name in runs), default=0)
        figure = Figure(figsize=(10.5, height), layout="constrained")
        axes = figure.subplots(1, 2, sharey=True)
        for number, (place, title) in enumerate(
            zip(axes, ("without an effect", "with the best answer"), strict=True)
        ):
            values = _matrix(report.cells, rows, runs, after=bool(number))
            image = _draw_cells(place, values, rows, runs)
            place.set_title(title, loc="left")
        bar = figure.colorbar(image, ax=axes, shrink=0.7, ticks=_LEVELS)
        bar.set_label("E/u, root mean square of both parts")
    return figure


def _downstream(row: tuple[str, str, int]) -> tuple[int, str, int]:
    return CHAIN.index(row[0]), row[1], row[2]


def _matrix(
    cells: Sequence[Cell],
    rows: Sequence[tuple[str, str, int]],
    runs: Sequence[str],
    *,
    after: bool,
) -> FloatArray:
    found = np.full((len(rows), len(runs)), np.nan)
    down = {key: at for at, key in enumerate(rows)}
    across = {name: at for at, name in enumerate(runs)}
    for one in cells:
        place = down[one.stage, one.channel, one.order], across[one.run]
        found[place] = one.after if after else one.before
    return found


def _draw_cells(
    axes: "Axes", values: FloatArray, rows: Sequence[tuple[str, str, int]], runs: Sequence[str]
) -> "QuadMesh":
    import matplotlib as mpl
    from matplotlib.colors import BoundaryNorm

    colours = mpl.colormaps["Blues"]
    norm = BoundaryNorm(_LEVELS, colours.N, extend="max")
    edges_x, edges_y = np.arange(len(runs) + 1) - 0.5, np.arange(len(rows) + 1) - 0.5
    image = axes.pcolormesh(edges_x, edges_y, values, norm=norm, cmap=colours)
    axes.grid(visible=False)
    axes.set_ylim(len(rows) - 0.5, -0.5)
    axes.set_xticks(range(len(runs)), [plain(name) for name in runs], rotation=90)
    axes.set_yticks(range(len(rows)), [_row_name(one) for one in rows], fontsize=7.0)
    for at in range(1, len(rows)):
        if rows[at][1] != rows[at - 1][1]:
            axes.axhline(at - 0.5, color=TRACE, linewidth=0.8)
    return image


def _row_name(row: tuple[str, str, int]) -> str:
    stage, channel, order = row
    return f"{plain(channel)}  n = {order}" if channel else stage


def walk_figure(report: GapReport) -> "Figure":
    """Draw the gap step by step along the chain, before and after, over the noise's own 1."""
    from matplotlib.figure import Figure

    after = {one.what: one.gap_u for one in report.remains}
    with drawing():
        count = len(report.walk)
        figure = Figure(figsize=(10.5, 1.4 + 0.42 * count), layout="constrained")
        axes = figure.add_subplot()
        for at, one in enumerate(report.walk):
            axes.plot(max(one.gap_u, _LEAST_U), at, "o", color=_BEFORE, markersize=7)
            if one.what in after:
                axes.plot(max(after[one.what], _LEAST_U), at, "s", color=_AFTER, markersize=5)
        axes.axvline(1.0, color=TRACE, linestyle="--")
        axes.annotate(
            "noise alone", (1.0, -0.75), xytext=(4, 0), textcoords="offset points", fontsize=8
        )
        _logarithmic(axes)
        axes.set_ylim(count - 0.5, -1.0)
        axes.set_yticks(range(count), [one.what for one in report.walk])
        axes.set_xlabel("E/u after the free coefficients, root mean square")
        axes.plot([], [], "o", color=_BEFORE, label="without an effect")
        axes.plot([], [], "s", color=_AFTER, label="with the best answer")
        axes.legend(loc="lower right")
    return figure


def _logarithmic(axes: "Axes") -> None:
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


def ranking_figure(report: GapReport) -> "Figure":
    """Draw the answers' probabilities; the class of the best one in its colour."""
    from matplotlib.figure import Figure

    shown = report.ranking
    with drawing():
        figure = Figure(figsize=(10.5, 1.1 + 0.36 * len(shown)), layout="constrained")
        axes = figure.add_subplot()
        alike = set(shown[0].alike) | {shown[0].answer} if shown else set[str]()
        for at, one in enumerate(shown):
            colour = _AFTER if one.answer in alike else "#B8BEC4"
            axes.barh(at, one.probability, color=colour, height=0.7)
            axes.text(one.probability + 0.01, at, f"{one.probability:.3f}", va="center")
        axes.set_yticks(range(len(shown)), [plain(joined(one.answer)) for one in shown])
        axes.invert_yaxis()
        axes.set_xlim(0.0, 1.12)
        axes.set_xlabel("probability; in blue what these runs cannot tell from the first")
    return figure


def withheld_figure(report: GapReport) -> "Figure":
    """Draw the gap of each withheld regime without and with each answer, noise taken off."""
    from matplotlib.figure import Figure

    named = "nearest, but not it" if report.verdict == "unknown" else "best answer"
    marks = {
        "without an effect": ("before", "o", _BEFORE),
        named: ("after", "s", _AFTER),
        "second best": ("second_best", "^", PALETTE[3]),
        "free polynomial": ("polynomial", "D", PALETTE[4]),
    }
    with drawing():
        count = len(report.regimes)
        figure = Figure(figsize=(10.5, 1.6 + 0.36 * count), layout="constrained")
        axes = figure.add_subplot()
        for step, (label, (name, mark, colour)) in enumerate(marks.items()):
            values = [float(getattr(one, name)) for one in report.regimes]
            seen = [(value, at) for at, value in enumerate(values) if not math.isnan(value)]
            if seen:
                x = [max(value, _LEAST_U) for value, _ in seen]
                y = [at + 0.12 * (step - 1.5) for _, at in seen]
                axes.plot(x, y, mark, color=colour, label=label, markersize=6)
        axes.axvline(1.0, color=TRACE, linestyle="--")
        _logarithmic(axes)
        axes.set_xlim(left=0.8 * _LEAST_U)
        axes.set_yticks(range(count), [plain(one.regime) for one in report.regimes])
        axes.invert_yaxis()
        axes.set_xlabel(f"gap in u, noise taken off; {_LEAST_U:g} and less are drawn at the left")
        figure.legend(loc="outside upper center", ncols=4)
    return figure


def force_map_figure(maps: Sequence[ForceMap]) -> "Figure":
    """Draw the remainder over the strut's displacement and velocity, no form assumed."""
    from matplotlib.figure import Figure

    with drawing():
        figure = Figure(figsize=(10.5, 4.2), layout="constrained")
        places = figure.subplots(1, len(maps), squeeze=False)[0]
        largest = max(float(np.nanmax(np.abs(one.force_n))) for one in maps) or 1.0
        for axes, one in zip(places, maps, strict=True):
            image = axes.pcolormesh(
                one.displacement, one.velocity, one.force_n, cmap="PuOr", vmin=-largest,
                vmax=largest, shading="nearest",
            )  # fmt: skip
            axes.grid(visible=False)
            axes.set_title(plain(one.channel), loc="left")
            axes.set_xlabel("displacement over the largest")
            axes.set_ylabel("velocity over the largest")
        figure.colorbar(image, ax=places, shrink=0.8).set_label("remaining force (N)")
    return figure
