"""Figures of the slow and steady tests: restoring, static drift, straight tow."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from analysis.coefficients.campaign_nonlinear import STATIC_DRIFT
from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.coefficients.restoring import Restoring, Track
from analysis.coefficients.term_waves import MOVES, waves_of
from analysis.coefficients.terms import VELOCITY_LETTERS, term_of
from analysis.coefficients.tows import Tow
from hardware.description.kinds import RunKind
from pmm.document.notation import rounded
from pmm.document.style import FIT, PALETTE, new_figure
from pmm.evaluation.control_chart import Chart

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def restoring_figure(tests: Sequence[Restoring], tracks: Sequence[Track]) -> "Figure":
    """Return force and moment over the displacement, a column for each motion.

    The turn as it was measured, and dashed the line of hydrostatics where they are given.
    """
    motions = list(dict.fromkeys(test.motion for test in tests))
    title = "Restoring: loads of the struts on the model"
    with new_figure(1.2 + 3.4 * len(motions), 5.2, title) as figure:
        panels = figure.subplots(2, len(motions), squeeze=False, sharex="col")
        for column, motion in enumerate(motions):
            pairs = [(test, track) for test, track in zip(tests, tracks, strict=True)
                    if test.motion == motion]  # fmt: skip
            _draw_turns(panels[0, column], panels[1, column], pairs)
    return figure


def _draw_turns(force: "Axes", moment: "Axes", pairs: Sequence[tuple[Restoring, Track]]) -> None:
    scale, unit = (180.0 / math.pi, "deg") if pairs[0][0].rotates else (1e3, "mm")
    largest_first = sorted(pairs, key=_width, reverse=True)
    for k, (test, track) in enumerate(largest_first):
        colour = PALETTE[k % len(PALETTE)]
        x = scale * track.displacement
        force.plot(x, track.force, color=colour, lw=1.2, label=test.run)
        moment.plot(x, track.moment, color=colour, lw=1.2)
    widest, track = largest_first[0]
    ends = np.array([track.displacement.min(), track.displacement.max()])
    for panel, expected in ((force, widest.hydrostatic_force), (moment, widest.hydrostatic_moment)):
        if expected is not None:
            panel.plot(scale * ends, expected * ends, "--", color="0.3", lw=1.0,
                       label="hydrostatics and weight")  # fmt: skip
    force.set_title(widest.motion)
    force.set_ylabel("force [N]")
    moment.set_ylabel("moment [N m]")
    moment.set_xlabel(f"{widest.motion} [{unit}]")
    force.legend(loc="upper left", fontsize=7.5)


def _width(pair: tuple[Restoring, Track]) -> float:
    return float(np.ptp(pair[1].displacement))


def drift_figure(tows: Sequence[Tow], coefficients: CampaignCoefficients) -> "Figure":
    """Return force and moment over the velocity across the model, with the fitted curves."""
    title = "Static drift: loads of the water on the model, about the midpoint"
    with new_figure(6.4, 5.2, title) as figure:
        panels = figure.subplots(2, 1, sharex=True)
        loads = ((0, "force_n", "force"), (1, "moment_n_m", "moment"))
        static = coefficients.rows(method=STATIC_DRIFT)
        for k, runs in enumerate(dict.fromkeys(coefficients.entries[row].runs for row in static)):
            run_tows = [tow for tow in tows if tow.run in runs]
            for panel, (load, value, name) in zip(panels, loads, strict=True):
                rows = [
                    row
                    for row in static
                    if coefficients.entries[row].runs == runs
                    and term_of(coefficients.entries[row].name, coefficients.plane).row == load
                ]
                _draw_load(panel, run_tows, coefficients, rows, k, value, name)
        velocity = VELOCITY_LETTERS[coefficients.plane][0]
        panels[0].set_ylabel("force [N]")
        panels[1].set_ylabel("moment [N m]")
        panels[1].set_xlabel(f"velocity {velocity} across the model [m/s] (squares: straight tow)")
        for panel in panels:
            panel.legend(loc="best", fontsize=7.5)
    return figure


def _draw_load(
    panel: "Axes",
    tows: Sequence[Tow],
    coefficients: CampaignCoefficients,
    rows: Sequence[int],
    k: int,
    value: str,
    name: str,
) -> None:
    across = np.array([tow.across_m_s for tow in tows])
    loads = np.array([getattr(tow, value) for tow in tows])
    widths = np.array([getattr(tow, f"{name}_half_width") for tow in tows])
    colour = PALETTE[k % len(PALETTE)]
    grid = np.linspace(across.min(), across.max(), 100)
    moves = np.zeros((len(MOVES), len(grid)))
    moves[MOVES.index("v")] = grid
    terms = [term_of(coefficients.entries[row].name, coefficients.plane) for row in rows]
    curve = coefficients.values[rows] @ waves_of(terms, moves)
    slope = next(row for row, term in zip(rows, terms, strict=True) if term.degree == 1)
    entry = coefficients.entries[slope]
    panel.plot(grid, curve, color=colour, lw=1.0,
               label=f"{entry.name} = "
               f"{rounded(coefficients.values[slope], coefficients.half_widths[slope])} "
               f"{entry.unit}, U = {entry.speed_m_s:g} m/s")  # fmt: skip
    for kind, marker in ((RunKind.STATIC_DRIFT, "o"), (RunKind.STRAIGHT_TOW, "s")):
        mask = np.array([tow.kind is kind for tow in tows])
        if mask.any():
            panel.errorbar(across[mask], loads[mask], widths[mask], fmt=marker, ms=4,
                           color=colour, capsize=2)  # fmt: skip


def resistance_figure(tows: Sequence[Tow]) -> "Figure":
    """Return the straight tows over speed: resistance where it was measured, force and moment."""
    rows = [("force_n", "force", "N"), ("moment_n_m", "moment", "N m")]
    if any(not math.isnan(tow.resistance_n) for tow in tows):
        rows.insert(0, ("resistance_n", "resistance", "N"))
    title = "Straight tow: mean loads of the water on the model"
    with new_figure(6.4, 1.7 * len(rows) + 0.7, title) as figure:
        panels = figure.subplots(len(rows), 1, sharex=True)
        speeds = np.array([tow.speed_m_s for tow in tows])
        for panel, (value, name, unit) in zip(panels, rows, strict=True):
            loads = np.array([getattr(tow, value) for tow in tows])
            widths = np.array([getattr(tow, f"{name}_half_width") for tow in tows])
            panel.errorbar(speeds, loads, widths, fmt="s", ms=4, color=FIT, capsize=2)
            panel.axhline(0.0, color="0.5", lw=0.8)
            panel.set_ylabel(f"{name} [{unit}]")
        panels[-1].set_xlim(left=0.0)
        panels[-1].set_xlabel("speed [m/s]")
    return figure


def chart_figure(charts: Sequence[Chart]) -> "Figure":
    """Return one panel a quantity over the numbers of the repeats."""
    from matplotlib.ticker import MaxNLocator

    with new_figure(7.0, 1.8 * len(charts) + 0.6) as figure:
        panels = figure.subplots(len(charts), 1, sharex=True, squeeze=False)[:, 0]
        for panel, chart in zip(panels, charts, strict=True):
            numbers = range(1, chart.values.size + 1)
            panel.axhline(chart.centre, color="0.5", lw=0.8)
            for limit in (chart.low, chart.high):
                panel.axhline(limit, color="tab:red", lw=0.8, ls="--")
            panel.plot(numbers, chart.values, "o-", color="tab:blue", ms=4, lw=0.8)
            outside = list(chart.outside)
            panel.plot([i + 1 for i in outside], chart.values[outside], "o", color="tab:red", ms=6)
            if chart.step_at is not None:
                panel.axvline(chart.step_at[0] + 0.5, color="tab:orange", lw=1.2)
            panel.set_ylabel(f"{chart.quantity}\n[{chart.unit}]")
            panel.xaxis.set_major_locator(MaxNLocator(integer=True))
        panels[-1].set_xlabel("repeat of the control condition")
    return figure
