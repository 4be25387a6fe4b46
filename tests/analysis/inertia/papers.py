"""The papers' figures against ours, each from the paper's own inputs.

A printed input may be off by half of its last digit, and so may the printed result. A figure holds
where what these inputs allow (the formula at all corners of their intervals) meets what the print
allows.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import product
from typing import Any


@dataclass(frozen=True)
class Printed:
    """A number as printed: its value and one unit of its last digit."""

    value: float
    last: float

    @property
    def ends(self) -> tuple[float, float]:
        """What the print allows."""
        return self.value - 0.5 * self.last, self.value + 0.5 * self.last


@dataclass(frozen=True)
class Figure:
    """One printed figure that follows from others.

    Attributes
    ----------
    where, what, unit
        Paper and table, quantity, unit.
    formula
        Called with the inputs' values by name.
    note
        Names a misprint; the figure is then not expected to hold.
    """

    where: str
    what: str
    unit: str
    printed: Printed
    formula: Callable[..., Any]
    inputs: Mapping[str, Printed]
    note: str = ""


@dataclass(frozen=True)
class Checked:
    """A figure computed: ours, and the interval that the inputs' rounding allows."""

    figure: Figure
    ours: float
    low: float
    high: float

    @property
    def holds(self) -> bool:
        """Whether paper and formula can be the same number."""
        low, high = self.figure.printed.ends
        slack = 1e-9 * max(abs(low), abs(high))
        return self.low <= high + slack and self.high >= low - slack


def check_figure(figure: Figure) -> Checked:
    """Compute a figure and its interval."""
    ours = float(figure.formula(**{key: number.value for key, number in figure.inputs.items()}))
    corners = [
        float(figure.formula(**dict(zip(figure.inputs, corner, strict=True))))
        for corner in product(*(number.ends for number in figure.inputs.values()))
    ]
    return Checked(figure, ours, min(corners, default=ours), max(corners, default=ours))


def all_figures() -> tuple[Figure, ...]:
    """Return every figure of both papers that can be computed from its own inputs."""
    from tests.analysis.inertia.papers_bifilar import bifilar_figures
    from tests.analysis.inertia.papers_swing import swing_figures

    return swing_figures() + bifilar_figures()


def comparison_table() -> str:
    """Return the table "paper against ours" as Markdown, a line per figure."""
    lines = [
        "| where | what | paper | ours | allowed by rounding | holds |",
        "|---|---|---|---|---|---|",
    ]
    for figure in all_figures():
        checked = check_figure(figure)
        verdict = "yes" if checked.holds else "**no**"
        verdict += f": {figure.note}" if figure.note else ""
        unit = "" if figure.unit == "1" else f" {figure.unit}"
        lines.append(
            f"| {figure.where} | {figure.what} | {figure.printed.value:g}{unit} | "
            f"{checked.ours:.6g} | {checked.low:.6g} to {checked.high:.6g} | {verdict} |"
        )
    return "\n".join(lines) + "\n"
