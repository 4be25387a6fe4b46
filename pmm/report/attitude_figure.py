"""The figures of sinkage, trim and heel: means of all runs over speed, drift or heel."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, Final

from hardware.description.heel import RollConstraint
from pmm.coefficients.workflow import CampaignOutcome
from pmm.document.content import Figure
from pmm.document.style import PALETTE, new_figure
from pmm.report.attitude import AttitudeRow, HeelRow, attitude_rows, heel_rows

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing

    from analysis.attitude import AttitudeChannel

_ATTITUDE_CAPTION: Final = (
    "Mean sinkage (positive down) and trim (positive bow up) over carriage speed and over drift, "
    "with two standard uncertainties. Filled marks are tows, open ones oscillations."
)
_HEEL_CAPTION: Final = (
    "The water's mean moment on the hull in roll over heel and over drift, and of a model that is "
    "free to roll its mean heel over speed and over drift, with two standard uncertainties. Filled "
    "marks are tows, open ones oscillations."
)
_DEGREES: Final = 180.0 / math.pi
_SPEED, _DRIFT, _HEEL = "carriage speed (m/s)", "drift (°)", "heel (°)"
_ALONG: Final[dict[str, Callable[[Any], float]]] = {
    _SPEED: lambda row: row.speed_m_s,
    _DRIFT: lambda row: row.drift_deg,
    _HEEL: lambda row: round(_DEGREES * row.heel.mean, 1),
}
_LABELS: Final = {_SPEED: "{:.3g} m/s", _DRIFT: "drift {:.3g}°", _HEEL: "heel {:.3g}°"}


@dataclass(frozen=True)
class _Panel:
    """Which channel of the rows is drawn over what, and what the colours tell apart, if they do."""

    name: str
    factor: float
    key: str
    along: str
    group: str = ""

    def draw(self, axes: "Axes", rows: Sequence[Any]) -> None:
        """Mark every row that has the channel; with colours, label the first of each."""
        group = _ALONG.get(self.group, lambda _: 0.0)
        groups, named = sorted({group(row) for row in rows}), set[float]()
        for row in rows:
            value: AttitudeChannel | None = getattr(row, self.key)
            if value is None:
                continue
            group_value = group(row)
            colour = PALETTE[groups.index(group_value) % len(PALETTE)]
            axes.errorbar(
                _ALONG[self.along](row),
                self.factor * value.mean,
                2.0 * self.factor * value.mean_u,
                fmt="o",
                color=colour,
                markerfacecolor="none" if row.frequency_hz else colour,
                label=None if group_value in named or not self.group
                else _LABELS[self.group].format(group_value),
            )  # fmt: skip
            named.add(group_value)
        axes.set_xlabel(self.along)
        axes.set_ylabel(self.name)
        if self.group:
            axes.legend()


_OF_ATTITUDE: Final = tuple(
    tuple(_Panel(name, factor, key, along) for along in (_SPEED, _DRIFT))
    for name, factor, key in (("sinkage (mm)", 1e3, "sinkage"), ("trim (°)", _DEGREES, "trim"))
)
_OF_MOMENT: Final = (
    _Panel("K (N m)", 1.0, "moment", _HEEL, _DRIFT),
    _Panel("K (N m)", 1.0, "moment", _DRIFT, _HEEL),
)
_OF_HEEL: Final = (
    _Panel("mean heel (°)", _DEGREES, "heel", _SPEED, _DRIFT),
    _Panel("mean heel (°)", _DEGREES, "heel", _DRIFT, _SPEED),
)


def attitude_figures(outcome: CampaignOutcome) -> Iterator[Figure]:
    """Yield the figures of what any run told: sinkage and trim, and heel."""
    if rows := attitude_rows(outcome):
        yield Figure("attitude", _ATTITUDE_CAPTION, partial(attitude_figure, rows))
    if heeled := heel_rows(outcome):
        yield Figure("heel", _HEEL_CAPTION, partial(heel_figure, heeled))


def attitude_figure(rows: Sequence[AttitudeRow]) -> "Drawing":
    """Draw four panels: sinkage above trim, over speed at left and over drift at right."""
    return _figure(_OF_ATTITUDE, rows, 2.8)


def heel_figure(rows: Sequence[HeelRow]) -> "Drawing":
    """Draw the roll moment where there is a gauge for it, the heel where the model is free."""
    measured = any(row.moment is not None for row in rows)
    free = any(row.held == RollConstraint.FREE for row in rows)
    panel_rows = [
        *([_OF_MOMENT] if measured else []),
        *([_OF_HEEL] if free or not measured else []),
    ]
    return _figure(panel_rows, rows, 3.2)


def _figure(
    panel_rows: Sequence[Sequence[_Panel]], rows: Sequence[Any], height: float
) -> "Drawing":
    with new_figure(10.0, height * len(panel_rows)) as figure:
        panels = figure.subplots(len(panel_rows), 2, squeeze=False)
        for axes_row, panel_row in zip(panels, panel_rows, strict=True):
            for axes, panel in zip(axes_row, panel_row, strict=True):
                panel.draw(axes, rows)
    return figure
