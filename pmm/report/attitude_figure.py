"""The figure of sinkage and trim: the means of all runs over carriage speed and over drift."""

import math
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING, Final

from analysis.attitude import AttitudeChannel
from pmm.coefficients.workflow import CampaignOutcome
from pmm.document.content import Figure
from pmm.document.style import PALETTE, drawn
from pmm.report.attitude import AttitudeRow, attitude_rows

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing

_CAPTION: Final = (
    "Mean sinkage (positive down) and trim (positive bow up) over carriage speed and over drift, "
    "with two standard uncertainties. Filled marks are tows, open ones oscillations."
)
_OVER: Final[tuple[tuple[str, Callable[[AttitudeRow], float]], ...]] = (
    ("carriage speed (m/s)", lambda row: row.speed_m_s),
    ("drift (°)", lambda row: row.drift_deg),
)
_SHOWN: Final[tuple[tuple[str, float, Callable[[AttitudeRow], AttitudeChannel]], ...]] = (
    ("sinkage (mm)", 1e3, lambda row: row.sinkage),
    ("trim (°)", 180.0 / math.pi, lambda row: row.trim),
)


def attitude_figures(outcome: CampaignOutcome) -> Iterator[Figure]:
    """Yield the figure where any run told sinkage and trim."""
    if rows := attitude_rows(outcome):
        yield Figure("attitude", _CAPTION, partial(attitude_figure, rows))


def attitude_figure(rows: Sequence[AttitudeRow]) -> "Drawing":
    """Draw four panels: sinkage above trim, over speed at left and over drift at right."""
    with drawn(10.0, 5.6) as figure:
        panels = figure.subplots(2, 2)
        for axes_row, (name, factor, told) in zip(panels, _SHOWN, strict=True):
            for axes, (along, place) in zip(axes_row, _OVER, strict=True):
                for row in rows:
                    _mark(axes, row, place(row), told(row), factor)
                axes.set_xlabel(along)
                axes.set_ylabel(name)
    return figure


def _mark(
    axes: "Axes", row: AttitudeRow, place: float, value: AttitudeChannel, factor: float
) -> None:
    axes.errorbar(
        place,
        factor * value.mean,
        2.0 * factor * value.mean_u,
        fmt="o",
        color=PALETTE[0],
        markerfacecolor="none" if row.frequency_hz else PALETTE[0],
    )
