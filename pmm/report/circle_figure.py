"""The figure of runs on a circle: loads of the water over the rate of turn, and what was fitted."""

import math
from collections.abc import Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np

from analysis.coefficients.body_cycle import BodyCycle, at_order
from analysis.coefficients.campaign_nonlinear import STATIC_DRIFT
from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.coefficients.term_waves import MOVES, waves_of
from analysis.coefficients.terms import term_of
from pmm.coefficients.workflow import CampaignOutcome
from pmm.document.content import Figure
from pmm.document.style import PALETTE, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing

_CAPTION: Final = (
    "Mean loads of the water on the model over the rate of turn, inertia taken off, with their "
    "95 % intervals; tows at the same speed stand at r = 0. Lines are the fit of all static runs."
)
_LOADS: Final = (("force", "force Y (N)"), ("moment", "moment N (N m)"))
_POINTS: Final = 60


def circle_figures(outcome: CampaignOutcome) -> Iterator[Figure]:
    """Yield the figure where any run went round a circle."""
    circles = [cycle for cycle in outcome.cycles if cycle.turn_rate_rad_s]
    speeds = {round(cycle.speed_m_s, 2) for cycle in circles}
    static = [cycle for cycle in outcome.cycles if not cycle.frequency_hz]
    cycles = [cycle for cycle in static if round(cycle.speed_m_s, 2) in speeds]
    if circles:
        yield Figure("circles", _CAPTION, partial(circle_figure, cycles, outcome.result))


def circle_figure(cycles: Sequence[BodyCycle], coefficients: CampaignCoefficients) -> "Drawing":
    """Draw force and moment, a colour for each drift angle and speed."""
    groups: dict[tuple[float, float], list[BodyCycle]] = {}  # by speed and drift
    for cycle in cycles:
        key = (round(cycle.speed_m_s, 2), round(math.degrees(cycle.drift_rad), 2))
        groups.setdefault(key, []).append(cycle)
    with new_figure(6.4, 5.6) as figure:
        panels = figure.subplots(2, 1, sharex=True)
        for row, (axes, (load, label)) in enumerate(zip(panels, _LOADS, strict=True)):
            for k, ((speed, drift), group) in enumerate(
                sorted(groups.items(), key=lambda item: item[0])
            ):
                colour = PALETTE[k % len(PALETTE)]
                _mark(axes, group, load, colour, f"drift {drift:g}°, {speed:g} m/s")
                _draw_fit(axes, group, coefficients, row, colour)
            axes.set_ylabel(label)
        panels[1].set_xlabel("rate of turn r (rad/s), to starboard")
        panels[0].legend(loc="best", fontsize=7.5)
    return figure


def _mark(axes: "Axes", cycles: Sequence[BodyCycle], load: str, colour: str, label: str) -> None:
    phasors = [cycle.hull.phasors.select([at_order(load, 0)]).real for cycle in cycles]
    values = [float(phasor.values[0]) for phasor in phasors]
    widths = [float(phasor.half_width()[0]) for phasor in phasors]
    rates = [cycle.turn_rate_rad_s for cycle in cycles]
    axes.errorbar(rates, values, widths, fmt="o", ms=4, color=colour, capsize=2, label=label)


def _draw_fit(
    axes: "Axes",
    cycles: Sequence[BodyCycle],
    coefficients: CampaignCoefficients,
    row: int,
    colour: str,
) -> None:
    first, names = cycles[0], {cycle.name for cycle in cycles}
    rows = [
        k
        for k in coefficients.rows(method=STATIC_DRIFT)
        if names & set(coefficients.entries[k].runs)
        and term_of(coefficients.entries[k].name, coefficients.plane).row == row
    ]
    if not rows:
        return
    rates = [cycle.turn_rate_rad_s for cycle in cycles]
    r = np.linspace(min(rates), max(rates), _POINTS)
    moves = np.zeros((len(MOVES), _POINTS))
    speed, drift = first.speed_m_s, first.drift_rad
    moves[MOVES.index("u")] = speed * math.cos(drift)
    moves[MOVES.index("v")] = first.point_ahead_m * r - speed * math.sin(drift)
    moves[MOVES.index("r")] = r
    terms = [term_of(coefficients.entries[k].name, coefficients.plane) for k in rows]
    axes.plot(r, coefficients.values[rows] @ waves_of(terms, moves), color=colour, lw=1.0)
