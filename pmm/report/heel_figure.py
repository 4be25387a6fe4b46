"""The figure of a model that heels: roll moment over heel and over drift, or heel over both."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Final

from analysis.attitude import AttitudeChannel
from hardware.description.heel import Held
from pmm.coefficients.workflow import CampaignOutcome
from pmm.document.content import Figure
from pmm.document.style import PALETTE, drawn
from pmm.report.heel import HeelRow, heel_rows

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing

_CAPTION: Final = (
    "The water's mean moment on the hull in roll over heel and over drift, and of a model that is "
    "free to roll its mean heel over speed and over drift, with two standard uncertainties. Filled "
    "marks are tows, open ones oscillations."
)
_DEGREES: Final = 180.0 / math.pi


@dataclass(frozen=True)
class _Panel:
    """What is drawn over what, and what the colours tell apart."""

    name: str
    factor: float
    told: Callable[[HeelRow], AttitudeChannel | None]
    along: str
    place: Callable[[HeelRow], float]
    group: Callable[[HeelRow], float]
    label: str


def _drift(row: HeelRow) -> float:
    return row.drift_deg


def _heel(row: HeelRow) -> float:
    return round(_DEGREES * row.heel.mean, 1)


def _speed(row: HeelRow) -> float:
    return row.speed_m_s


_OF_MOMENT: Final = (
    _Panel("K (N m)", 1.0, lambda row: row.moment, "heel (°)", _heel, _drift, "drift {:.3g}°"),
    _Panel("K (N m)", 1.0, lambda row: row.moment, "drift (°)", _drift, _heel, "heel {:.3g}°"),
)
_OF_HEEL: Final = (
    _Panel("mean heel (°)", _DEGREES, lambda row: row.heel, "carriage speed (m/s)", _speed, _drift,
           "drift {:.3g}°"),
    _Panel("mean heel (°)", _DEGREES, lambda row: row.heel, "drift (°)", _drift, _speed,
           "{:.3g} m/s"),
)  # fmt: skip


def heel_figures(outcome: CampaignOutcome) -> Iterator[Figure]:
    """Yield the figure where any run's model heels."""
    if rows := heel_rows(outcome):
        yield Figure("heel", _CAPTION, partial(heel_figure, rows))


def heel_figure(rows: Sequence[HeelRow]) -> "Drawing":
    """Draw the roll moment where there is a gauge for it, the heel where the model is free."""
    measured = any(row.moment is not None for row in rows)
    free = any(row.held == Held.FREE for row in rows)
    several = [*([_OF_MOMENT] if measured else []), *([_OF_HEEL] if free or not measured else [])]
    with drawn(10.0, 3.2 * len(several)) as figure:
        panels = figure.subplots(len(several), 2, squeeze=False)
        for axes_row, two in zip(panels, several, strict=True):
            for axes, panel in zip(axes_row, two, strict=True):
                _draw(axes, panel, rows)
    return figure


def _draw(axes: "Axes", panel: _Panel, rows: Sequence[HeelRow]) -> None:
    groups = sorted({panel.group(row) for row in rows})
    named: set[float] = set()
    for row in rows:
        value, group = panel.told(row), panel.group(row)
        if value is None:
            continue
        colour = PALETTE[groups.index(group) % len(PALETTE)]
        axes.errorbar(
            panel.place(row),
            panel.factor * value.mean,
            2.0 * panel.factor * value.mean_u,
            fmt="o",
            color=colour,
            markerfacecolor="none" if row.frequency_hz else colour,
            label=None if group in named else panel.label.format(group),
        )
        named.add(group)
    axes.set_xlabel(panel.along)
    axes.set_ylabel(panel.name)
    axes.legend()
