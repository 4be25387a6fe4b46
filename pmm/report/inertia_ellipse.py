"""The inertia ellipse in the centre plane, with the axes that were measured."""

import math
from typing import TYPE_CHECKING

import numpy as np

from analysis.inertia.principal_axes import inertia_ellipse
from pmm.document.labels import plain
from pmm.document.style import FIT, PALETTE, TRACE, new_figure
from pmm.inertia.outcome import PlaneAxes

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def ellipse_figure(name: str, plane_axes: PlaneAxes) -> "Figure":
    """Draw the ellipse in body axes, bow to the right and down as it is.

    The radius in a direction is the inverse of the gyradius about it; bars on the measured axes
    are one standard uncertainty.
    """
    with new_figure(8.0, 6.2, f"{plain(name)}: inertia ellipse") as figure:
        axes = figure.add_subplot()
        points = inertia_ellipse(plane_axes.roll_m, plane_axes.yaw_m, plane_axes.angle_rad, 721)
        axes.plot(points[:, 0], points[:, 1], color=PALETTE[0], lw=1.4, label="1/gyradius")
        _draw_principal(axes, plane_axes)
        _draw_measured(axes, plane_axes)
        axes.set_aspect("equal", adjustable="datalim")
        axes.invert_yaxis()
        axes.set_xlabel("forward, x (1/m)")
        axes.set_ylabel("down, z (1/m)")
        axes.set_title(
            f"psi = {math.degrees(plane_axes.angle_rad):.2f} deg, principal gyradii "
            f"{1e3 * plane_axes.roll_m:.1f} and {1e3 * plane_axes.yaw_m:.1f} mm",
            loc="left",
        )
        figure.legend(loc="outside lower left", ncols=4)
    return figure


def _draw_principal(axes: "Axes", plane_axes: PlaneAxes) -> None:
    """Draw the principal axes through the centre of gravity."""
    for label, turn, length in (
        ("principal x", math.pi / 2.0 - plane_axes.angle_rad, 1.0 / plane_axes.roll_m),
        ("principal z", -plane_axes.angle_rad, 1.0 / plane_axes.yaw_m),
    ):
        x, z = length * math.sin(turn), length * math.cos(turn)
        style = "--" if label.endswith("x") else ":"
        axes.plot([-x, x], [-z, z], style, color=TRACE, label=label)


def _draw_measured(axes: "Axes", plane_axes: PlaneAxes) -> None:
    label = "about these axes, ±u"
    for row, (angle, gyradius) in enumerate(sorted(plane_axes.measured, key=lambda pair: pair[0])):
        reach = np.array([gyradius.value - gyradius.uncertainty, gyradius.value])
        reach = 1.0 / np.append(reach, gyradius.value + gyradius.uncertainty)
        axes.plot(reach * math.sin(angle), reach * math.cos(angle), "-", color=FIT, lw=2.0)
        place = (math.sin(angle) / gyradius.value, math.cos(angle) / gyradius.value)
        axes.plot(*place, "o", ms=5.0, color=FIT, label=label)
        _name(axes, place, angle, f"{1e3 * gyradius.value:.1f} mm", row)
        label = ""


def _name(axes: "Axes", place: tuple[float, float], angle: float, text: str, row: int) -> None:
    """Write a measured axis beside its point: outside above and below, inside at the ends."""
    upright = abs(math.cos(angle)) > 0.5
    away = -1.0 if math.cos(angle) > 0.0 else 1.0  # positive is up
    inward = 12.0 if math.cos(angle) > 0.1 else -12.0
    axes.annotate(
        f"{math.degrees(angle):.0f} deg, {text}",
        place,
        xytext=(0.0, away * (18.0 + 13.0 * (row % 3))) if upright else (-16.0, inward),
        textcoords="offset points",
        ha="center" if upright else "right",
        va="center",
        fontsize=8.0,
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.0},
        arrowprops={"arrowstyle": "-", "color": FIT, "lw": 0.7, "shrinkB": 3.0},
    )
