"""The tables of ``pmm gap CAMPAIGN``."""

import math
from typing import TYPE_CHECKING

from pmm.gap.coefficients import headings
from pmm.gap.describing import described
from pmm.gap.report import GapReport, joined
from pmm.gap.rows import said_of

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

_SHOWN_REGIMES = 12


def print_report(console: "Console", report: GapReport) -> None:
    """Print a diagnosis for people."""
    console.print(f"{report.campaign}: {report.sentence}", style="bold", soft_wrap=True)
    _print_used(console, report)
    _print_where(console, report)
    _print_which(console, report)
    _print_how_far(console, report)
    _print_coefficients(console, report)
    _print_remains(console, report)
    _print_next(console, report)


def _table(*headings: str, text: int = 1) -> "Table":
    """Return a table whose first ``text`` columns are words and the others numbers."""
    from rich.table import Table

    table = Table(box=None, padding=(0, 1), pad_edge=False)
    for number, heading in enumerate(headings):
        table.add_column(heading, justify="left" if number < text else "right", overflow="fold")
    return table


def _print_used(console: "Console", report: GapReport) -> None:
    held = f", {len(report.held_out)} withheld" if report.held_out else ""
    console.print(f"{len(report.runs)} runs used{held}, {len(report.left_out)} left out")
    for name, reason in report.left_out.items():
        console.print(f"LEFT OUT {name}: {reason}", soft_wrap=True)
    for note in report.notes:
        console.print(f"NOTE     {note}", soft_wrap=True)


def _print_where(console: "Console", report: GapReport) -> None:
    said = "E/u as stated and after the free coefficients, rms; 1 is noise alone"
    console.print(f"\nwhere: {said}", style="bold")
    table = _table("along the chain", "verdict", "stated", "rms", "numbers", "largest", text=2)
    for one in report.walk:
        table.add_row(one.what, one.verdict, *one.said, one.worst)
    console.print(table)
    if report.verdict not in ("none", "coefficients"):
        shares = [f"{name} {share:.2f}" for name, share in report.stages.items() if share > 0.005]
        console.print(f"stage: {', '.join(shares)}")
    largest = sorted(report.contrasts, key=lambda one: -one.gap_u)[:3]
    if any(one.beyond for one in largest):
        said = ", ".join(f"{one.what} ({one.gap_u:.2f})" for one in largest)
        console.print(f"largest in: {said}", soft_wrap=True)


def _print_which(console: "Console", report: GapReport) -> None:
    console.print("\nwhich", style="bold")
    table = _table("answer", "stage", "parameters (95 %)", "probability", "withheld [u]", text=3)
    for one in report.ranking:
        table.add_row(joined(one.answer), one.stage, "\n".join(one.parameters), *one.said)
    console.print(table)
    if report.effects:
        headings = ("effect in any answer", "stage", "cannot be told from", "probability", "class")
        table = _table(*headings, text=3)
        for effect in report.effects:
            table.add_row(effect.name, effect.stage, *said_of(effect))
        console.print(table)
    measures = report.ranking[0].measure
    if measures:
        console.print(f"what would tell: {'; '.join(measures)}", soft_wrap=True)
    if report.hidden:
        console.print(
            f"{len(report.hidden)} effects cannot be seen in these runs: "
            f"{', '.join(report.hidden)}",
            style="dim",
        )


def _print_how_far(console: "Console", report: GapReport) -> None:
    if not report.regimes:
        return
    said = "the withheld runs" if report.held_out else "each regime, predicted from the others"
    console.print(f"\nhow far: gap of {said}, in u, noise taken off", style="bold")
    table = _table("answer", "before", "after", "shrinks", "95 %")
    for one in report.controls:
        table.add_row(one.what, *one.said)
    console.print(table)
    table = _table("withheld", "before", "after", "second best", "polynomial")
    for row in report.regimes[:_SHOWN_REGIMES]:
        values = (row.before, row.after, row.second_best, row.polynomial)
        table.add_row(row.regime, *(_number(one) for one in values))
    console.print(table)


def _number(value: float) -> str:
    return "-" if math.isnan(value) else f"{value:.2f}"


def _print_coefficients(console: "Console", report: GapReport) -> None:
    chosen = [one for one in report.coefficients if one.moved]
    if not chosen:
        console.print("\nno coefficient moves by more than its uncertainty")
        return
    named = any(one.compared for one in chosen)
    title = "what it does to the coefficients" if named else "coefficients"
    console.print(f"\n{title}", style="bold")
    console.print(str(report.convention), soft_wrap=True)
    table = _table(*headings(chosen), text=2)
    for one in chosen:
        table.add_row(*one.said)
    console.print(table)


def _print_remains(console: "Console", report: GapReport) -> None:
    beyond = [one for one in report.remains if one.beyond]
    console.print("\nwhat remains", style="bold")
    if not beyond:
        console.print("nothing beyond u")
    for one in beyond:
        console.print(f"{one.what}: {one.gap_u:.2f} u rms, largest {one.worst}", soft_wrap=True)
    if report.description is not None:
        for line in described(report):
            console.print(line, soft_wrap=True)


def _print_next(console: "Console", report: GapReport) -> None:
    if not report.next_runs:
        return
    *others, last = report.next_runs[0]["between"]
    answers = f"{', '.join(others)} and {last}" if others else last
    console.print(f"\nnext: the run that tells {answers} apart best", style="bold", soft_wrap=True)
    for one in report.next_runs[:3]:
        console.print(f"{one['said']}: {one['gain_log_odds']:.1f} expected log odds")
