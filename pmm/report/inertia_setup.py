"""The set-up of a test: drawn from its file's geometry, and its photo."""

from pathlib import Path
from typing import TYPE_CHECKING, Final

from pmm.document.labels import plain
from pmm.document.style import PALETTE, TRACE, new_figure
from pmm.inertia.sketch import Sketch

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_WIDEST_PX: Final = 1600  # of a photo, as a page shows it; halved it is coarse on a large screen
_BESIDE: Final = 0.08  # between measures, of the drawing's size


def setup_figure(name: str, sketches: tuple[Sketch, ...]) -> "Figure":
    """Draw each set-up to its scale, with its measures."""
    with new_figure(max(5.0 * len(sketches), 7.0), 5.0, f"{plain(name)}: set-up") as figure:
        for place, sketch in enumerate(sketches, 1):
            _draw(figure.add_subplot(1, len(sketches), place), sketch)
    return figure


def _draw(axes: "Axes", sketch: Sketch) -> None:
    for start, end in sketch.lines:
        axes.plot(*zip(start, end, strict=True), color=TRACE, lw=1.0)
    for start, end in sketch.bodies:
        axes.plot(*zip(start, end, strict=True), color=PALETTE[0], lw=6.0, alpha=0.5)
    for label, point in sketch.axes.items():
        axes.plot(*point, "^", color=TRACE, ms=9.0)
        axes.annotate(label, point, (8, 6), textcoords="offset points")
    for label, point in sketch.centres.items():
        axes.plot(*point, "o", color=PALETTE[1], ms=8.0)
        axes.annotate(label, point, (-8, -4), textcoords="offset points", ha="right")
    ends = [end for part in (*sketch.lines, *sketch.bodies) for end in part]
    wide, high = (max(side) - min(side) for side in zip(*ends, strict=True))
    size = max(wide, high)
    rank = {True: 0, False: 0}  # measures that stand, and those that lie
    for measure in sketch.dimensions:
        stands = measure.start[0] == measure.end[0]
        rank[stands] += 1
        beside = rank[stands] * _BESIDE * size
        x, y = (beside, 0.0) if stands else (0.0, beside)
        ends = [(end[0] + x, end[1] + y) for end in (measure.start, measure.end)]
        middle = ((ends[0][0] + ends[1][0]) / 2.0, (ends[0][1] + ends[1][1]) / 2.0)
        axes.annotate("", ends[0], ends[1], arrowprops={"arrowstyle": "<->", "lw": 0.8})
        axes.annotate(
            measure.text, middle, (4, 0) if stands else (0, 3), textcoords="offset points",
            ha="left" if stands else "center", va="center" if stands else "bottom",
        )  # fmt: skip
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.25)
    axes.axis("off")
    axes.set_title(plain(sketch.title), loc="left")


def photo_figure(path: Path) -> "Figure":
    """Show a picture; one that is wide is thinned."""
    from matplotlib.image import imread

    pixels = imread(path)
    step = -(-max(pixels.shape[:2]) // _WIDEST_PX)
    shown = pixels[::step, ::step]
    height, width = shown.shape[:2]
    with new_figure(8.0, 8.0 * height / width) as figure:
        axes = figure.add_subplot()
        axes.imshow(shown, cmap="gray" if shown.ndim == 2 else None)
        axes.axis("off")
    return figure
