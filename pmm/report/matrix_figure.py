"""The matrix of a plan as a figure: frequency against amplitude, and what the rig allows."""

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.kinds import RunKind
from pmm.document.style import FIT, PALETTE, TRACE, new_figure
from pmm.plan.findings import PlanVerdict
from pmm.plan.limits import limit_findings
from pmm.plan.plan import Plan
from pmm.plan.rig_file import RigFile
from pmm.plan.run_plan import RunPlan

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MARKS = {
    RunKind.OSCILLATION: ("o", PALETTE[0], 5.0),
    RunKind.CONTROL: ("s", PALETTE[3], 9.0),
    RunKind.DRY: ("^", PALETTE[2], 6.0),
    RunKind.KNOWN_MASS: ("v", PALETTE[4], 9.0),
    RunKind.RESTORING: ("D", PALETTE[5], 5.0),
}
_ACROSS = 3  # panels side by side
_POINTS = 200
_LOG_FROM = 6.0  # times the lowest frequency: then a logarithmic scale
_HEADROOM = 1.35


def matrix_figure(plan: Plan, rig: RigFile) -> "Figure":
    """Draw a panel for each motion; runs beyond a limit are crossed out.

    Amplitudes are those of a strut, half its stroke. Lines are the rig's limits of amplitude,
    velocity and acceleration.
    """
    groups = _groups(plan.runs)
    across = min(_ACROSS, max(1, len(groups)))
    down = max(1, math.ceil(len(groups) / across))
    with new_figure(
        1.0 + 3.4 * across, 0.9 + 2.7 * down, f"{plan.name}: {len(plan.runs)} runs"
    ) as figure:
        axes = figure.subplots(down, across, squeeze=False, sharex=True, sharey=True)
        panels = list(axes.flat)
        for (title, runs), panel in zip(groups, panels, strict=False):
            _panel(panel, title, runs, rig)
        for panel in panels[max(1, len(groups)) :]:
            panel.set_visible(False)
        _finish(figure, panels, groups, rig)
    return figure


def _groups(runs: Sequence[RunPlan]) -> list[tuple[str, list[RunPlan]]]:
    """Return the oscillations of each motion, medium and speed."""
    groups: dict[str, list[RunPlan]] = {}
    for run in runs:
        if run.oscillates:
            speed = run.set_point.carriage_speed_m_s
            where = "in air" if run.kind.in_air else f"U = {speed:g} m/s"
            groups.setdefault(f"{run.motion}, {where}", []).append(run)
    return list(groups.items())


def _panel(axes: "Axes", title: str, runs: Sequence[RunPlan], rig: RigFile) -> None:
    axes.set_title(title, loc="left")
    for kind, (marker, colour, size) in _MARKS.items():
        points = Counter(_point(run) for run in runs if run.kind is kind)
        _marks(axes, points, marker, color=colour, markersize=size, markerfacecolor="none",
               markeredgewidth=1.2, label=str(kind))  # fmt: skip
        for (x, y), count in points.items():
            if count > 1:
                axes.annotate(f"{count} x", (x, y), (0, 6), textcoords="offset points",
                              ha="center", fontsize=7.5, color=colour)  # fmt: skip
    refused = {_point(run): 1 for run in runs if any(_refused(run, rig))}
    _marks(axes, refused, "x", color=FIT, markersize=9.0, markeredgewidth=1.8, label="refused")


def _marks(
    axes: "Axes", points: Mapping[tuple[float, float], int], marker: str, **style: Any
) -> None:
    if points:
        x, y = zip(*sorted(points), strict=True)
        axes.plot(x, y, marker, **style)


def _point(run: RunPlan) -> tuple[float, float]:
    return run.set_point.frequency_hz, 1e3 * run.set_point.eccentricity_m


def _refused(run: RunPlan, rig: RigFile) -> Iterator[bool]:
    return (
        limit_finding.verdict is PlanVerdict.REFUSE for limit_finding in limit_findings(run, rig)
    )


def _finish(
    figure: "Figure",
    panels: Sequence["Axes"],
    groups: Sequence[tuple[str, list[RunPlan]]],
    rig: RigFile,
) -> None:
    """Set the common scales, draw the limits and name what is drawn, once."""
    points = [_point(run) for _, runs in groups for run in runs]
    if not points:
        panels[0].set_title("no oscillations", loc="left")
        return
    lowest, highest = 0.8 * min(f for f, _ in points), 1.25 * max(f for f, _ in points)
    largest = _HEADROOM * max(a for _, a in points)
    handles: dict[str, Any] = {}
    across = min(_ACROSS, len(groups))
    for number, panel in enumerate(panels[: len(groups)]):
        _limit_lines(panel, rig, np.geomspace(lowest, highest, _POINTS), largest)
        handles |= {str(get_line.get_label()): get_line for get_line in panel.get_lines()}
        if number % across == 0:
            panel.set_ylabel("amplitude [mm], half the stroke")
        if number + across >= len(groups):
            panel.set_xlabel("frequency [Hz]")
            panel.tick_params(labelbottom=True)
    panels[0].set_ylim(0.0, largest)
    _frequency_axis(panels[0], lowest, highest)
    figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=4)


def _frequency_axis(axes: "Axes", lowest_hz: float, highest_hz: float) -> None:
    """Scale the axis that all panels share: over a wide range by ratios, 1, 2, 5 and so on."""
    from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

    axes.set_xlim(lowest_hz, highest_hz)
    if highest_hz < _LOG_FROM * lowest_hz:
        return
    axes.set_xscale("log")
    axes.set_xlim(lowest_hz, highest_hz)
    axes.xaxis.set_major_locator(
        FixedLocator([digit * 10.0**power for power in range(-4, 3) for digit in (1.0, 2.0, 5.0)])
    )
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))


def _limit_lines(axes: "Axes", rig: RigFile, frequency_hz: FloatArray, largest_mm: float) -> None:
    """Draw the largest amplitude over frequency; a rod's second harmonic is left out."""
    omega = 2.0 * math.pi * frequency_hz
    half_stroke = math.inf if rig.limits.stroke_m is None else rig.limits.stroke_m / 2.0
    highest = min(rig.oscillator.eccentricity_m.high, half_stroke)
    lines = [("amplitude", np.full_like(omega, highest), "-")]
    if rig.limits.velocity_m_s is not None:
        lines.append(("velocity", rig.limits.velocity_m_s / omega, "--"))
    if rig.limits.acceleration_m_s2 is not None:
        lines.append(("acceleration", rig.limits.acceleration_m_s2 / omega**2, ":"))
    for name, amplitude_m, style in lines:
        if 1e3 * amplitude_m.min() < largest_mm:
            label = f"limit of {name}"
            axes.plot(frequency_hz, 1e3 * amplitude_m, style, color=TRACE, label=label)
