"""The figure of propeller and rudder: normal force over rudder angle, force over thrust."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from analysis.steering.inflow import INFLOW, propeller_and_rudder
from analysis.steering.observations import SteeringRuns
from hardware.description.arrays import FloatArray
from pmm.document.notation import degrees
from pmm.document.style import PALETTE, TRACE, new_figure
from pmm.steering.workflow import CampaignSteering

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_POINTS = 61
_MARKS = (("o", "-"), ("s", "--"), ("^", ":"), ("D", "-."))


def steering_figure(steering: CampaignSteering) -> "Figure":
    """Draw normal force over rudder angle, and force ahead over thrust."""
    with new_figure(10.0, 4.4) as figure:
        left, right = figure.subplots(1, 2)
        _normal_force(left, steering)
        _load_variation(right, steering)
        figure.suptitle(f"{steering.name}: propeller and rudder")
    return figure


def _normal_force(axes: "Axes", steering: CampaignSteering) -> None:
    runs, groups = steering.runs, _groups(steering.runs)
    for (colour, mark, line), ((condition, rate), rows) in zip(
        _looks(), groups.items(), strict=False
    ):
        u, v, r = runs.motions[:, condition]
        drift, turning = (
            degrees(np.arctan2(-v, u)),
            r * steering.particulars.length_m / np.hypot(u, v),
        )
        angles = np.degrees(runs.rudder_rad[rows])
        axes.errorbar(
            angles, runs.values[4, rows], 2.0 * runs.uncertainty[4, rows], fmt=mark, color=colour,
            markersize=3.5,
            label=f"{drift}°, {round(turning, 6):z.2g}, {rate:.3g} 1/s",
        )  # fmt: skip
        if (curve := _fitted(steering, condition, rate, angles)) is not None:
            axes.plot(*curve, line, color=colour)
    axes.set_xlabel("rudder angle (°)")
    axes.set_ylabel("normal force (N)")
    axes.legend(title="drift, r L/U, revolutions", fontsize=7.0, title_fontsize=7.5, ncols=2)


def _groups(runs: SteeringRuns) -> dict[tuple[int, float], list[int]]:
    groups: dict[tuple[int, float], list[int]] = {}
    for k, condition in enumerate(runs.condition.tolist()):
        groups.setdefault((condition, round(float(runs.rate_hz[k]), 3)), []).append(k)
    return groups


def _looks() -> Iterator[tuple[str, str, str]]:
    """Yield colour, mark and line of one series after another: none is like another's."""
    for mark, line in _MARKS:
        for colour in PALETTE:
            yield colour, mark, line


def _fitted(
    steering: CampaignSteering, condition: int, rate_hz: float, angles: FloatArray
) -> tuple[FloatArray, FloatArray] | None:
    """Return the fitted curve of one motion and rate; ``None`` where the fit does not tell it."""
    parameters = steering.parameters
    if "epsilon" not in parameters.names:
        return None
    length, values = (
        steering.particulars.length_m,
        dict(zip(parameters.names, parameters.values, strict=True)),
    )
    inflow = np.array([values.get(name, 0.0) for name in INFLOW])
    inflow[INFLOW.index("l_R")] = length * values.get("l_R'", 0.0)
    over = np.radians(np.linspace(angles.min(), angles.max(), _POINTS))
    motion = np.repeat(steering.runs.motions[:, [condition]], _POINTS, axis=1)
    unit = np.ones((5, _POINTS))
    runs = SteeringRuns(("",) * _POINTS, motion, over, np.full(_POINTS, rate_hz), unit, unit)
    wake = np.full(_POINTS, parameters.wakes[3, condition])
    return np.degrees(over), propeller_and_rudder(runs, steering.particulars, wake, inflow)[1]


def _load_variation(axes: "Axes", steering: CampaignSteering) -> None:
    runs, slope = steering.runs, steering.parameters["1-t_P"]
    for mark, condition in zip("osD^v", runs.straight_runs, strict=False):
        rows = runs.condition == condition
        amidships = np.abs(runs.rudder_rad[rows]) < np.radians(0.5)
        thrust, along = runs.values[3, rows][amidships], runs.values[0, rows][amidships]
        if not len(thrust):
            continue
        speed = runs.motions[0, condition]
        axes.plot(thrust, along, mark, color=TRACE, label=f"{speed:.3g} m/s")
        ends = np.array([thrust.min(), thrust.max()])
        offset = float(np.mean(along - slope * thrust))
        axes.plot(ends, offset + slope * ends, color=TRACE)
    axes.axhline(0.0, color=TRACE, linewidth=0.6)
    axes.set_xlabel("thrust (N)")
    axes.set_ylabel("X, force along the model (N)")
    axes.legend()
