"""The figure of the water's memory: what was measured at rest, and what was fitted to it."""

import math
from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np

from pmm.coefficients.workflow import CampaignOutcome
from pmm.document.content import Figure
from pmm.document.style import PALETTE, new_figure
from pmm.report.memory import UNITS, band_hz

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing

    from analysis.memory.result import MeasuredMemory
    from hardware.description.arrays import FloatArray

_CAPTION: Final = (
    "Added mass and damping at rest with their intervals, and the memory that was fitted to them: "
    "solid in the measured band, dashed where it is extrapolated."
)
_POINTS: Final = 120
_DRAWN_BEYOND: Final = 1.3  # of the highest frequency, as a factor


def memory_figures(outcome: CampaignOutcome) -> Iterator[Figure]:
    """Yield a figure of each fit."""
    for k, memory in enumerate(outcome.memories, 1):
        yield Figure(f"memory-{k}", _CAPTION, partial(memory_figure, memory, outcome.result.level))


def memory_figure(memory: "MeasuredMemory", level: float) -> "Drawing":
    """Draw added mass and damping of each element over frequency, measured and fitted."""
    measured = memory.measured
    low, high = band_hz(memory)
    frequencies_hz = np.linspace(low / 2.0, _DRAWN_BEYOND * high, _POINTS)
    curves = memory.curves(2.0 * math.pi * frequencies_hz)
    measured_values, half = (
        measured.shaped(values)
        for values in (measured.uncertain.values, measured.uncertain.half_width(level))
    )
    fitted, fitted_half = (
        measured.shaped(values) for values in (curves.values, curves.half_width(level))
    )
    rows = len(measured.elements)
    with new_figure(8.0, 2.2 * rows + 0.8) as figure:
        panels = figure.subplots(rows, 2, squeeze=False, sharex=True)
        for k, (names, pair) in enumerate(zip(measured.names, measured.elements, strict=True)):
            for kind in (0, 1):
                axes = panels[k][kind]
                points = (measured_values[k, kind], half[k, kind])
                axes.errorbar(measured.omega_rad_s / (2.0 * math.pi), *points, fmt="o", ms=3.5,
                              capsize=2, color=PALETTE[0], label="measured")  # fmt: skip
                _draw(axes, frequencies_hz, fitted[k, kind], fitted_half[k, kind], (low, high))
                axes.set_ylabel(f"{names[kind]} ({UNITS[sum(pair)][kind]})")
        for axes in panels[-1]:
            axes.set_xlabel("frequency (Hz)")
        panels[0][0].legend(loc="best", fontsize=7.5)
    return figure


def _draw(
    axes: "Axes", frequencies_hz: "FloatArray", fitted: "FloatArray", half: "FloatArray",
    band: tuple[float, float],
) -> None:  # fmt: skip
    inside = (frequencies_hz >= band[0]) & (frequencies_hz <= band[1])
    colour = PALETTE[1]
    axes.plot(frequencies_hz, fitted, "--", color=colour, lw=0.9, label="extrapolated")
    axes.plot(frequencies_hz[inside], fitted[inside], color=colour, lw=1.3, label="fitted")
    axes.fill_between(
        frequencies_hz, fitted - half, fitted + half, color=colour, alpha=0.15, lw=0.0
    )
