"""Figures of a ship's manoeuvres: tracks, zig-zags and spiral, with draws of its derivatives."""

from typing import TYPE_CHECKING

import numpy as np

from analysis.manoeuvring.march import Log
from analysis.manoeuvring.ship import PSI, X, Y
from hardware.description.arrays import FloatArray
from pmm.document.style import PALETTE, new_figure
from pmm.manoeuvre.prediction import SIDES, Prediction

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_FAINT = 0.18


def turning_figure(prediction: Prediction) -> "Figure":
    """Draw the tracks of both turning circles, advance up and starboard to the right."""
    length = prediction.ship.hull.length_m
    with new_figure(9.0, 4.6) as figure:
        axes = figure.add_subplot()
        for colour, side in zip(PALETTE, SIDES, strict=False):
            _, states, _ = _histories(prediction.logs[side])
            across, ahead = states[:, Y] / length, states[:, X] / length
            _lines(axes, across, ahead, colour, side)
            turn = prediction.turns[side]
            sign = SIDES[side]
            marks = (sign * turn.transfer[0], sign * turn.tactical_diameter[0])
            heights = (turn.advance[0], np.interp(np.pi, sign * states[:, PSI, 0], ahead[:, 0]))
            axes.plot(marks, heights, "o", color=colour, markersize=4.0)
        axes.set_aspect("equal")
        axes.set_xlabel("to starboard (L)")
        axes.set_ylabel("ahead (L)")
        axes.legend(loc="lower right")
        figure.suptitle(f"{prediction.file.name}: turning circles, 35° of rudder")
    return figure


def zigzag_figure(prediction: Prediction) -> "Figure":
    """Draw heading and rudder of both zig-zags that begin to starboard."""
    unit = prediction.ship.hull.length_m / prediction.ship.approach_m_s
    with new_figure(9.0, 6.0) as figure:
        for place, angle in enumerate((10, 20), 1):
            axes = figure.add_subplot(2, 1, place)
            times, states, rudders = _histories(prediction.logs[f"{angle}"])
            _lines(axes, times / unit, np.degrees(states[:, PSI]), PALETTE[0], "heading")
            rudder = np.degrees(rudders[:, 0])
            axes.plot(times[:, 0] / unit, rudder, "--", color=PALETTE[1], label="rudder")
            axes.set_title(f"{angle}/{angle}", loc="left")
            axes.set_ylabel("angle (°)")
            axes.legend(loc="lower left")
        axes.set_xlabel("time (L/U)")
        figure.suptitle(f"{prediction.file.name}: zig-zags")
    return figure


def spiral_figure(prediction: Prediction) -> "Figure":
    """Draw the spiral: both ways of the rudder, with the interval of each angle."""
    spiral, tail = prediction.spiral, 0.5 * (1.0 - prediction.level)
    rudder = np.degrees(spiral.rudder_rad)
    with new_figure(7.0, 4.5) as figure:
        axes = figure.add_subplot()
        ways = (("to port", spiral.down, PALETTE[0], ">-"), ("back", spiral.up, PALETTE[1], "<-"))
        for label, rates, colour, style in ways:
            axes.plot(rudder, rates[:, 0], style, color=colour, markersize=4.0, label=label)
            if rates.shape[1] > 1:
                low, high = np.transpose([_band(row[1:], tail) for row in rates])
                axes.fill_between(rudder, low, high, color=colour, alpha=_FAINT, linewidth=0.0)
        axes.axhline(0.0, color="black", linewidth=0.6)
        axes.axvline(0.0, color="black", linewidth=0.6)
        axes.set_xlabel("rudder (°, positive turns to starboard)")
        axes.set_ylabel("r' = r L / U")
        axes.legend(loc="upper left")
        figure.suptitle(f"{prediction.file.name}: spiral")
    return figure


def _band(draws: FloatArray, tail: float) -> tuple[float, float]:
    """Return the ends of the interval of the draws that came to a steady turn."""
    steady_draws = draws[np.isfinite(draws)]
    if not steady_draws.size:
        return np.nan, np.nan
    low, high = np.quantile(steady_draws, (tail, 1.0 - tail))
    return float(low), float(high)


def _histories(log: Log) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return times ``(k, n)``, states ``(k, 6, n)`` and rudder angles ``(k, n)``."""
    times = np.array([moment.time_s for moment in log.moments])
    states = np.array([moment.state for moment in log.moments])
    return times, states, np.array([moment.rudder_rad for moment in log.moments])


def _lines(axes: "Axes", x: FloatArray, y: FloatArray, colour: str, label: str) -> None:
    axes.plot(x[:, 1:], y[:, 1:], color=colour, alpha=_FAINT, linewidth=0.6)
    axes.plot(x[:, 0], y[:, 0], color=colour, linewidth=1.6, label=label)
