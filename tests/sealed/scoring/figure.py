"""The board as a drawing: what each row reaches in each bin, and the ceiling."""

from typing import TYPE_CHECKING, Final

from pmm.document.style import PALETTE, TRACE, drawing
from tests.sealed.scoring.rows import RowScore
from tests.sealed.scoring.score import Score

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_SHOWN: Final = (
    ("detection", "gap seen"),
    ("stage", "stage"),
    ("top_1_by_class", "top-1 by class"),
    ("unknown", "unknown said"),
    ("pairs", "pairs"),
    ("shrinkage", "true shrinkage"),
)
_BINS: Final = ("hidden", "low", "middle", "high")
_LABELS: Final = ("< 3", "3-10", "10-30", "> 30")


def score_figure(score: Score) -> "Figure":
    """Return one panel a column: figures with intervals over SNR, rows side by side."""
    from matplotlib.figure import Figure

    with drawing():
        figure = Figure(figsize=(9.5, 5.4), layout="constrained")
        panels = figure.subplots(2, 3, sharex=True, sharey=True).ravel()
        for axes, (column, title) in zip(panels, _SHOWN, strict=True):
            for number, row in enumerate(score.rows):
                _draw(axes, row, column, number, len(score.rows))
            _draw_ceiling(axes, score.rows[0], column)
            axes.set_title(title, loc="left")
            axes.set_ylim(-0.05, 1.05)
            axes.set_xticks(range(len(_BINS)), _LABELS)
        for axes in panels[3:]:
            axes.set_xlabel("signal to noise")
        handles, names = panels[0].get_legend_handles_labels()
        figure.legend(handles, names, loc="outside lower center", ncols=min(len(names), 6))
    return figure


def _draw(axes: "Axes", row: RowScore, column: str, number: int, count: int) -> None:
    color = PALETTE[number % len(PALETTE)]
    marker = "osD^vP*"[number // len(PALETTE) % 7] if number else "o"
    places, values, below, above = [], [], [], []
    for at, key in enumerate(_BINS):
        there = row.figure(key, column)
        if there is not None:
            places.append(at + 0.6 * ((number + 0.5) / count - 0.5))
            values.append(there.value)
            below.append(max(there.value - there.low, 0.0))
            above.append(max(there.high - there.value, 0.0))
    # Shares below zero (a gap that grew) lie under the panel; the tables have them.
    axes.errorbar(places, values, (below, above), fmt=marker, color=color, ms=4, lw=0.8,
                  label=row.name)  # fmt: skip


def _draw_ceiling(axes: "Axes", row: RowScore, column: str) -> None:
    for at, key in enumerate(_BINS):
        there = row.figure(key, column)
        if there is not None and there.ceiling is not None:
            axes.hlines(there.ceiling, at - 0.4, at + 0.4, color=TRACE, ls="--", lw=1.0)
