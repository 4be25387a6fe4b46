"""Figures of the gap diagnosis: heat map, walk, ranking, before and after, force map."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from analysis.gap.judge.description import ForceMap
from analysis.gap.locate.walk import CHAIN
from hardware.description.arrays import FloatArray
from pmm.document.labels import plain
from pmm.document.style import PALETTE, TRACE, new_figure
from pmm.gap.cells import HARMONIC, Cell
from pmm.gap.heat import (
    AFTER,
    BEFORE,
    LEAST_U,
    Dots,
    Grid,
    before_and_after,
    dotted,
    logarithmic,
    probability_bars,
)
from pmm.gap.report import GapReport
from pmm.gap.words import joined

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def heat_map(report: GapReport) -> "Figure":
    """Draw E/u of each channel's harmonics over the runs, before and after the answer."""
    rows = sorted(dict.fromkeys(_row(cell) for cell in report.cells), key=_downstream)
    runs = list(dict.fromkeys(cell.run for cell in report.cells))
    breaks = [at for at in range(1, len(rows)) if rows[at][:2] != rows[at - 1][:2]]
    maps = [_matrix(report.cells, rows, runs, after=after) for after in (False, True)]
    grid = Grid([_row_name(row) for row in rows], runs, breaks)
    return before_and_after(grid, maps, "E/u, root mean square of all parts")


def _downstream(row: tuple[str, str, str, int]) -> tuple[int, str, bool, int]:
    stage, channel, kind, order = row
    return CHAIN.index(stage), channel, kind != HARMONIC, order


def _row(cell: Cell) -> tuple[str, str, str, int]:
    return cell.stage, cell.channel, cell.what, cell.order


def _matrix(
    cells: Sequence[Cell],
    rows: Sequence[tuple[str, str, str, int]],
    runs: Sequence[str],
    *,
    after: bool,
) -> FloatArray:
    values = np.full((len(rows), len(runs)), np.nan)
    down = {key: at for at, key in enumerate(rows)}
    across = {name: at for at, name in enumerate(runs)}
    for cell in cells:
        place = down[_row(cell)], across[cell.run]
        values[place] = cell.after if after else cell.before
    return values


def _row_name(row: tuple[str, str, str, int]) -> str:
    _, channel, kind, order = row
    return f"{plain(channel)}  {f'n = {order}' if kind == HARMONIC else kind}".lstrip()


def walk_figure(report: GapReport) -> "Figure":
    """Draw the gap step by step along the chain, before and after, over the noise's own 1."""
    after = {step.what: step.gap_u for step in report.conclusion.remains}
    count = len(report.conclusion.walk)
    with new_figure(10.5, 1.6 + 0.42 * count) as figure:
        axes = figure.add_subplot()
        for at, step in enumerate(report.conclusion.walk):
            axes.plot(max(step.gap_u, LEAST_U), at, "o", color=BEFORE, markersize=7)
            if step.what in after:
                axes.plot(max(after[step.what], LEAST_U), at, "s", color=AFTER, markersize=5)
        axes.axvline(1.0, color=TRACE, linestyle="--")
        axes.annotate(
            "noise alone", (1.0, -0.75), xytext=(4, 0), textcoords="offset points", fontsize=8
        )
        logarithmic(axes)
        axes.set_ylim(count - 0.5, -1.0)
        axes.set_yticks(range(count), [step.what for step in report.conclusion.walk])
        axes.set_xlabel(
            "E/u after the free coefficients, root mean square; "
            f"{LEAST_U:g} and less are drawn at the left"
        )
        axes.plot([], [], "o", color=BEFORE, label="without an effect")
        axes.plot([], [], "s", color=AFTER, label="with the answer")
        figure.legend(loc="outside upper center", ncols=2)
    return figure


def ranking_figure(report: GapReport) -> "Figure":
    """Draw the answers' probabilities; the class of the best one in its colour."""
    shown = report.ranking
    alike = set(shown[0].alike) | {shown[0].answer} if shown else set[str]()
    return probability_bars(
        {joined(row.answer): row.probability for row in shown},
        [joined(name) for name in alike],
        "probability; in blue what these runs cannot tell from the first",
    )


def withheld_figure(report: GapReport) -> "Figure":
    """Draw the gap of each withheld regime without and with each answer, noise taken off."""
    named = "best answer" if report.conclusion.names else "nearest, but not it"
    marks = {
        "without an effect": ("before", "o", BEFORE),
        named: ("after", "s", AFTER),
        "second best": ("second_best", "^", PALETTE[3]),
        "free polynomial": ("polynomial", "D", PALETTE[4]),
    }
    return dotted(
        [row.regime for row in report.regimes],
        [
            Dots(label, mark, colour, [float(getattr(row, name)) for row in report.regimes])
            for label, (name, mark, colour) in marks.items()
        ],
    )


def force_map_figure(maps: Sequence[ForceMap]) -> "Figure":
    """Draw the remainder over the strut's displacement and velocity, no form assumed."""
    with new_figure(10.5, 4.2) as figure:
        places = figure.subplots(1, len(maps), squeeze=False)[0]
        largest = max(float(np.nanmax(np.abs(force_map.force_n))) for force_map in maps) or 1.0
        for axes, force_map in zip(places, maps, strict=True):
            image = axes.pcolormesh(
                force_map.displacement, force_map.velocity, force_map.force_n, cmap="PuOr",
                vmin=-largest, vmax=largest, shading="nearest",
            )  # fmt: skip
            axes.grid(visible=False)
            axes.set_title(plain(force_map.channel), loc="left")
            axes.set_xlabel("displacement over the largest")
            axes.set_ylabel("velocity over the largest")
        figure.colorbar(image, ax=places, shrink=0.8).set_label("remaining force (N)")
    return figure
