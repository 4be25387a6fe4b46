"""Harmonics as phasors: in phase to the right, quadrature up, with what is not known about them."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from analysis.resolver.analysis import Analysis
from analysis.resolver.harmonics import Harmonics
from hardware.description.arrays import FloatArray
from pmm.document.labels import Display, display, loads_first, shown_name
from pmm.document.style import PALETTE, new_figure
from pmm.report.gate import caption, reading_of, single_periods
from pmm.report.region import Ellipse, ellipses

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, SubFigure


_PANELS_ABREAST = 4
_MARKERS = "os^Dv"  # the next one where the colours begin again
_MOST_DOTS = 500  # of a figure, so that an SVG stays small


@dataclass(frozen=True)
class _Phasor:
    """One harmonic of one channel, in the unit that it is shown in.

    ``singles`` are those of single periods, shape ``(periods, 2)``.
    """

    label: str
    color: str
    marker: str
    value: FloatArray
    singles: FloatArray
    ellipse: Ellipse | None

    def reach(self, centre: FloatArray) -> float:
        """Return the largest distance along either axis that anything drawn has from a point."""
        half = self.ellipse.half_major if self.ellipse else 0.0
        singles = np.abs(self.singles - centre).max(initial=0.0)
        return float(max(np.abs(self.value - centre).max() + half, singles))


def phasor_figure(analysis: Analysis, reading_index: int = 0) -> "Figure":
    """Draw each harmonic of one reading as phasors, channels of the same unit together.

    The upper panel of a harmonic shows the phasors from the origin, the lower one how the gate's
    single periods scatter about each, magnified. Ellipses hold the true phasor with 95 %
    confidence (:func:`pmm.report.region.region_factor`); there is none where too few periods
    give no interval. Each panel has its own scale.

    Raises
    ------
    ConfigurationError
        If there is no such reading.
    """
    reading = reading_of(analysis, reading_index)
    phasors = _phasors(analysis, reading)
    blocks = _blocks(analysis, reading)
    abreast = min(reading.order, _PANELS_ABREAST)
    with new_figure(
        max(7.5, 2.8 * abreast),
        0.4 + 5.8 * len(blocks),
        f"{shown_name(reading.run)}: {caption(reading)}",
    ) as figure:
        parts = figure.subfigures(len(blocks), 1, squeeze=False)[:, 0]
        for part, (rows, orders) in zip(parts, blocks, strict=True):
            unit = display(reading.units[rows[0]])
            grid = part.subplots(2, abreast, squeeze=False)
            for column in range(abreast):
                if column >= len(orders):
                    grid[0, column].remove()
                    grid[1, column].remove()
                    continue
                harmonic_phasors = [phasors[row][orders[column] - 1] for row in rows]
                _draw_from_origin(grid[0, column], harmonic_phasors, orders[column])
                _draw_scatter(grid[1, column], harmonic_phasors)
            _label(grid[:, : len(orders)], unit)
            _legend(part, [phasors[row][0] for row in rows], reading)
    return figure


def _blocks(analysis: Analysis, reading: Harmonics) -> list[tuple[list[int], range]]:
    """Rows of channels that share a unit, with the harmonics that fit abreast."""
    by_unit: dict[str, list[int]] = {}
    for row in loads_first(analysis.recording):
        by_unit.setdefault(reading.units[row], []).append(row)
    return [
        (rows, range(first, min(first + _PANELS_ABREAST, reading.order + 1)))
        for rows in by_unit.values()
        for first in range(1, reading.order + 1, _PANELS_ABREAST)
    ]


def _phasors(analysis: Analysis, reading: Harmonics) -> list[list[_Phasor]]:
    singles, regions = single_periods(analysis, reading), ellipses(reading)
    thinned = singles[:: dot_step(reading)]
    values = reading.coefficients[:, 1:].reshape(-1, reading.order, 2)
    return [
        [
            _Phasor(
                shown_name(name),
                PALETTE[row % len(PALETTE)],
                _MARKERS[row // len(PALETTE) % len(_MARKERS)],
                values[row, n] * factor,
                thinned[:, row, n] * factor,
                _scaled(regions[row][n], factor),
            )
            for n in range(reading.order)
        ]
        for row, name in enumerate(reading.channel_names)
        for factor in (display(reading.units[row]).factor,)
    ]


def dot_step(reading: Harmonics) -> int:
    """Return which of the single periods are drawn: every first, second, ... one."""
    dots = reading.periods * reading.order * len(reading.channel_names)
    return -(-dots // _MOST_DOTS)


def _scaled(ellipse: Ellipse | None, factor: float) -> Ellipse | None:
    if ellipse is None:
        return None
    return Ellipse(ellipse.half_major * factor, ellipse.half_minor * factor, ellipse.angle_rad)


def _draw_from_origin(axes: "Axes", phasors: list[_Phasor], order: int) -> None:
    for phasor in phasors:
        axes.plot(*phasor.singles.T, ".", ms=5.0, color=phasor.color, alpha=0.4, mew=0)
        axes.plot(*np.array([[0.0, 0.0], phasor.value]).T, color=phasor.color, lw=1.6)
        axes.plot(*phasor.value, phasor.marker, ms=4.0, color=phasor.color, mew=0)
        _draw_ellipse(axes, phasor, phasor.value)
    axes.set_title(f"harmonic {order}")
    _frame(axes, max(phasor.reach(np.zeros(2)) for phasor in phasors))


def _draw_scatter(axes: "Axes", phasors: list[_Phasor]) -> None:
    for phasor in phasors:
        axes.plot(
            *(phasor.singles - phasor.value).T, ".", ms=6.0, color=phasor.color, alpha=0.45, mew=0
        )
        _draw_ellipse(axes, phasor, np.zeros(2))
    axes.set_title("spread about that value")
    _frame(axes, max(phasor.reach(phasor.value) for phasor in phasors))


def _draw_ellipse(axes: "Axes", phasor: _Phasor, centre: FloatArray) -> None:
    from matplotlib.patches import Ellipse as Patch

    if phasor.ellipse is None:
        return
    axes.add_patch(
        Patch(
            (float(centre[0]), float(centre[1])),
            2.0 * phasor.ellipse.half_major,
            2.0 * phasor.ellipse.half_minor,
            angle=float(np.degrees(phasor.ellipse.angle_rad)),
            fill=False,
            edgecolor=phasor.color,
            lw=1.1,
        )
    )


def _frame(axes: "Axes", reach: float) -> None:
    limit = 1.12 * reach if reach > 0.0 else 1.0
    axes.set_xlim(-limit, limit)
    axes.set_ylim(-limit, limit)
    axes.set_aspect("equal")
    axes.locator_params(nbins=4)
    axes.axhline(0.0, color="#888888", lw=0.6, zorder=0.5)
    axes.axvline(0.0, color="#888888", lw=0.6, zorder=0.5)


def _label(grid: NDArray[np.object_], unit: Display) -> None:
    for axes in grid[1]:
        axes.set_xlabel(f"in phase ({unit.label})")
    for axes in grid[:, 0]:
        axes.set_ylabel(f"quadrature ({unit.label})")


def _legend(part: "SubFigure", phasors: list[_Phasor], reading: Harmonics) -> None:
    from matplotlib.lines import Line2D

    step = dot_step(reading)
    handles: list[Artist] = [
        Line2D([], [], color=phasor.color, marker=phasor.marker, ms=4.0, label=phasor.label)
        for phasor in phasors
    ]
    dots = "single periods" if step == 1 else f"single periods (1 in {step})"
    handles.append(
        Line2D([], [], ls="", marker=".", ms=6.0, color="#555555", alpha=0.5, label=dots)
    )
    has_region = any(phasor.ellipse for phasor in phasors)
    region = "95 % region of the mean phasor" if has_region else "no 95 % region: too few periods"
    handles.append(
        Line2D([], [], ls="", marker="o", mfc="none", mec="#555555", ms=7.0, label=region)
    )
    part.legend(handles=handles, loc="outside lower left", ncols=4)
