"""Expected uncertainty of each coefficient against tank time."""

import math
from typing import TYPE_CHECKING

from analysis.design.expectation import ExpectedCoefficient
from pmm.design.run_selection import Design
from pmm.document.style import PALETTE, TRACE, label_decades, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_STYLES = ("-", "--", ":", "-.")


def design_figure(name: str, design: Design) -> "Figure":
    """Draw a line for each coefficient: uncertainty over what is asked for, run by run."""
    with new_figure(7.2, 4.2) as figure:
        axes = figure.subplots()
        hours = [step.time_s / 3600.0 for step in design.steps]
        told = [
            {(row.name, row.where): row for row in step.expected_coefficients}
            for step in design.steps
        ]
        for k, last in enumerate(design.expected_coefficients):
            ratios = [_ratio(rows.get((last.name, last.where))) for rows in told]
            label = f"{last.name} at {last.where}" if last.where else last.name
            colour, style = PALETTE[k % len(PALETTE)], _STYLES[k // len(PALETTE) % len(_STYLES)]
            axes.plot(hours, ratios, style, color=colour, marker="o", markersize=2.5, label=label)
        axes.axhline(1.0, color=TRACE, linewidth=1.4)
        axes.set_yscale("log")
        label_decades(axes.yaxis)
        axes.set_xlabel("tank time [h]")
        targeted = any(
            math.isfinite(coefficient.wanted) for coefficient in design.expected_coefficients
        )
        over = "what is asked for" if targeted else "the believed value"
        axes.set_ylabel(f"expected standard uncertainty over {over}")
        if design.expected_coefficients:
            figure.legend(
                loc="outside right upper", ncols=1 + len(design.expected_coefficients) // 17
            )
        figure.suptitle(f"{name}: what the runs are expected to tell")
    return figure


def _ratio(coefficient: ExpectedCoefficient | None) -> float:
    if coefficient is None:
        return math.nan
    scale = coefficient.wanted if math.isfinite(coefficient.wanted) else abs(coefficient.believed)
    ratio = coefficient.standard_uncertainty / scale if scale else math.nan
    return ratio if math.isfinite(ratio) else math.nan
