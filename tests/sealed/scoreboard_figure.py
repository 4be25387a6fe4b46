"""The scores over time: what is asked of the diagnosis most, with 95 % intervals and ceilings."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

from tests.sealed.scores import Kept
from tests.sealed.scoring.board import DIAGNOSIS
from tests.sealed.scoring.intervals import Figure
from tests.sealed.scoring.rows import BINS

if TYPE_CHECKING:
    from matplotlib.axes import Axes

NAME: Final = "images/scoreboard.svg"
PANELS: Final = {
    "top_1_by_class": "right class named",
    "stage": "right stage of the chain",
    "unknown": "unknown effect said to be unknown",
    "false_alarms": "false alarms",
}


def draw(kept: Sequence[Kept], docs: Path) -> None:
    """Draw some scores, in the order in which they were made, to :data:`NAME` below ``docs``."""
    import matplotlib as mpl
    from matplotlib.figure import Figure as Picture

    picture = Picture(figsize=(9.0, 5.0), layout="constrained")
    panels = picture.subplots(2, 2, sharex=True)
    for axes, (column, title) in zip(panels.flat, PANELS.items(), strict=True):
        _panel(axes, [one.name for one in kept], [whole(one, column) for one in kept])
        axes.set_title(title, fontsize=10, loc="left")
    panels[0, 0].legend(fontsize=8, frameon=False, loc="lower right")
    (docs / NAME).parent.mkdir(parents=True, exist_ok=True)
    with mpl.rc_context({"svg.hashsalt": NAME}):
        picture.savefig(docs / NAME, metadata={"Date": None})


def whole(kept: Kept, column: str) -> Figure | None:
    """Return a column of the diagnosis over all cases but the hidden ones."""
    row = next((one for one in kept.score.rows if one.name == DIAGNOSIS), None)
    return None if row is None else row.figure(BINS[-1].key, column)


def _panel(axes: "Axes", names: Sequence[str], figures: Sequence[Figure | None]) -> None:
    there = [(k, figure) for k, figure in enumerate(figures) if figure is not None]
    at = [k for k, _ in there]
    value = [figure.value for _, figure in there]
    below = [figure.value - figure.low for _, figure in there]
    above = [figure.high - figure.value for _, figure in there]
    axes.errorbar(at, value, (below, above), marker="o", capsize=3, label="diagnosis")
    ceilings = [(k, figure.ceiling) for k, figure in there if figure.ceiling is not None]
    if ceilings:
        axes.plot(*zip(*ceilings, strict=True), ls="", marker="_", ms=16, label="linear matcher")
    axes.set_xticks(range(len(names)), names, rotation=30, fontsize=8)
    highest = max((figure.high for _, figure in there), default=1.0)
    axes.set_ylim(0.0, 1.1 * highest if highest < 0.3 else 1.0)
    axes.grid(axis="y", alpha=0.3)
