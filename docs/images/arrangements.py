"""Draw what joint, pivot, gauges and drift mean: ``python docs/images/arrangements.py``."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from hardware.description.arrangement import DriftBy, Joint
from pmm.document.style import PALETTE, TRACE, drawing, write_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

HERE = Path(__file__).resolve().parent
HALF = 0.5
ANGLE = math.radians(28.0)
MODEL, STRUT, FORCE = PALETTE[0], PALETTE[6], PALETTE[1]
_SIDE = ((-0.85, 0.16), (0.45, 0.16), (0.72, 0.1), (0.9, 0.0))
HULL = (*_SIDE, *((x, -y) for x, y in reversed(_SIDE)))

Point = tuple[float, float]


@dataclass(frozen=True)
class Frame:
    """A turned and shifted pair of axes, ahead and to starboard."""

    place: Point = (0.0, 0.0)
    angle: float = 0.0

    def at(self, ahead: float, across: float) -> Point:
        """Return a point of it on the page."""
        c, s = math.cos(self.angle), math.sin(self.angle)
        return self.place[0] + ahead * c - across * s, self.place[1] + ahead * s + across * c


def main() -> None:
    """Write ``arrangements.png`` beside this file."""
    with drawing():
        write_figure(arrangements(), HERE, "arrangements", ("png",))


def arrangements() -> "Figure":
    """Return the drawing: three joints above, three ways to set a drift angle below."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8.6, 5.8), layout="constrained")
    axes = figure.subplots(2, 3).ravel()
    for ax, (title, note) in zip(axes, _panels(axes), strict=True):
        ax.set_title(title, family="monospace")
        ax.text(0.5, -0.02, note, transform=ax.transAxes, ha="center", va="top", fontsize=8.0)
        ax.set_aspect("equal")
        ax.set_xlim(-1.15, 1.2)
        ax.set_ylim(0.72, -1.02)
        ax.set_axis_off()
    return figure


def _panels(axes: "list[Axes]") -> Iterator[tuple[str, str]]:
    slope = math.tan(ANGLE) * HALF
    _joint(axes[0], (-HALF, -slope), (HALF, slope), "model")
    yield f'joint = "{Joint.SLIDES_ON_MODEL}"', "tan a = (d_fore - d_aft) / 2l"
    rise = 2.0 * HALF * math.sin(ANGLE)
    reach = 2.0 * HALF * math.cos(ANGLE)
    _joint(axes[1], (-HALF, -rise / 2.0), (-HALF + reach, rise / 2.0), "rig")
    yield f'joint = "{Joint.SLIDES_ON_RIG}"', "sin a = (d_fore - d_aft) / 2l"
    _table(axes[2])
    yield f'joint = "{Joint.YAW_TABLE}"', "a is the table's own angle"
    drift = math.radians(17.0)
    rig = Frame(angle=drift)
    _rig(axes[3], rig)
    _model(axes[3], rig, [rig.at(-HALF, 0.0), rig.at(HALF, 0.0)], rig)
    yield f'drift_by = "{DriftBy.RIG_TURNED}"', "struts move across the model's mean heading"
    lift = math.tan(drift) * HALF
    ends = [(-HALF, -lift), (HALF, lift)]
    _rig(axes[4], Frame())
    _model(axes[4], Frame(), ends, rig)
    yield f'drift_by = "{DriftBy.STRUTS_OFFSET}"', "struts move across the tank"
    _rig(axes[5], Frame())
    _model(axes[5], Frame(), [(-HALF, 0.0), (HALF, 0.0)], rig)
    yield (
        f'drift_by = "{DriftBy.MODEL_TURNED}"',
        "struts move across the tank,\nattachments off the centre line",
    )
    for ax in axes:
        _way(ax)


def _way(ax: "Axes") -> None:
    ax.annotate("", (1.05, -0.93), (0.55, -0.93), arrowprops={"arrowstyle": "->", "color": TRACE})
    ax.text(0.52, -0.93, "U", ha="right", va="center", color=TRACE)


def _rig(ax: "Axes", rig: Frame, feet: tuple[float, ...] = (-HALF, HALF)) -> None:
    """The rail along the rig, and a strut's line of motion at each foot."""
    from matplotlib.patches import Polygon

    corners = [rig.at(-0.75, -0.66), rig.at(0.75, -0.66), rig.at(0.75, -0.72), rig.at(-0.75, -0.72)]
    ax.add_patch(Polygon(corners, color="#BBBBBB"))
    for foot in feet:
        ax.plot(*zip(rig.at(foot, -0.66), rig.at(foot, 0.5), strict=True), ":", color=TRACE, lw=0.8)


def _model(ax: "Axes", rig: Frame, ends: list[Point], heading: Frame) -> None:
    """Hull on its heading, and the struts that reach its attachments from the rail."""
    from matplotlib.patches import Polygon

    middle = ((ends[0][0] + ends[1][0]) / 2.0, (ends[0][1] + ends[1][1]) / 2.0)
    hull = Frame(middle, heading.angle)
    ax.add_patch(Polygon([hull.at(*one) for one in HULL], fc="#D3E6F3", ec=MODEL, lw=1.2))
    ax.plot(*zip(hull.at(-0.95, 0.0), hull.at(1.02, 0.0), strict=True), "-.", color=MODEL, lw=0.7)
    for end in ends:
        _strut(ax, rig, end)
        ax.plot(*end, "o", color=STRUT, ms=4.0)


def _strut(ax: "Axes", rig: Frame, end: Point) -> None:
    c, s = math.cos(rig.angle), math.sin(rig.angle)
    ahead = end[0] * c + end[1] * s
    ax.plot(
        *zip(rig.at(ahead, -0.66), end, strict=True), color=STRUT, lw=2.2, solid_capstyle="butt"
    )


def _joint(ax: "Axes", aft: Point, fore: Point, slides_on: str) -> None:
    """A model at an angle on two struts: what slides, and what the gauges read."""
    heading = Frame(angle=ANGLE)
    _rig(ax, Frame())
    _model(ax, Frame(), [aft, fore], heading)
    slot = Frame(fore, ANGLE) if slides_on == "model" else Frame((fore[0], -0.69), 0.0)
    _slot(ax, slot)
    ax.plot(*aft, "o", color="white", mec=STRUT, mew=1.6, ms=7.0)
    _gauges(ax, aft, ANGLE, ("X", "F_aft"))
    _gauges(ax, fore, ANGLE, ("", "F_fore"))
    ax.text(aft[0] + 0.06, -0.54, "pivot", fontsize=8.0)


def _table(ax: "Axes") -> None:
    """One strut and a turntable."""
    from matplotlib.patches import Circle

    _rig(ax, Frame(), (0.0,))
    _model(ax, Frame(), [(0.0, 0.0), (0.0, 0.0)], Frame(angle=ANGLE))
    ax.add_patch(Circle((0.0, 0.0), 0.1, fc="white", ec=STRUT, lw=1.6, zorder=3))
    _gauges(ax, (0.0, 0.0), ANGLE, ("X", "force"))


def _slot(ax: "Axes", frame: Frame) -> None:
    for side in (-0.035, 0.035):
        line = zip(frame.at(-0.14, side), frame.at(0.14, side), strict=True)
        ax.plot(*line, color=STRUT, lw=1.1, zorder=4)


def _gauges(ax: "Axes", place: Point, angle: float, names: tuple[str, str]) -> None:
    """Arrows along the model's axes, and dashed ones along the rig's."""
    size = 0.34
    for turn, style, label in ((angle, "-", True), (0.0, "--", False)):
        frame = Frame(place, turn)
        for name, tip in zip(names, (frame.at(size, 0.0), frame.at(0.0, size)), strict=True):
            if not name:
                continue
            look = {"arrowstyle": "-|>", "color": FORCE, "ls": style, "lw": 1.0, "shrinkA": 0.0}
            ax.annotate("", tip, place, arrowprops=look, zorder=5)
            if label:
                ax.text(tip[0] - 0.03, tip[1] + 0.08, name, color=FORCE, fontsize=8.0, ha="right")


if __name__ == "__main__":
    main()
