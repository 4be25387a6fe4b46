"""A campaign's coefficients as tables for people."""

from typing import TYPE_CHECKING

from analysis.coefficients.campaign_result import CampaignCoefficients
from pmm.cli.screen import print_flags
from pmm.coefficients.workflow import Outcome
from pmm.document.flag_lines import joined
from pmm.document.notation import counted
from pmm.report.campaign_tables import Grid, beside_tables, recommended_table, value_tables

if TYPE_CHECKING:
    from rich.console import Console


def print_outcome(console: "Console", outcome: Outcome) -> None:
    """Print what to use, what was found about it and noticed, and then all other values."""
    found = outcome.result
    used = counted(len(outcome.cycles), "run")
    console.print(f"{', '.join(outcome.names)}: {used}, {found.plane}, {found.form} form")
    print_recommended(console, found)
    print_flags(console, outcome.noticed, hints=False)
    for grid in (*beside_tables(found), *value_tables(found)):
        _print_grid(console, grid)


def print_recommended(console: "Console", found: CampaignCoefficients) -> None:
    """Print the values to be used first, and what was found about them."""
    _print_grid(console, recommended_table(found))
    _print_findings(console, found)


def _print_findings(console: "Console", found: CampaignCoefficients) -> None:
    console.print()
    forms: dict[tuple[str, str], list[str]] = {}
    for choice in found.choices:
        forms.setdefault((choice.load, choice.message), []).extend(choice.runs)
    for (load, message), runs in forms.items():
        console.print(f"form    {load} of {joined(runs)}: {message}", soft_wrap=True)
    if found.checks:
        agree = sum(one.agrees for one in found.checks)
        console.print(f"checks  {agree} of {len(found.checks)} between runs agree")
    apart = [one.message for one in found.checks if not one.agrees]
    for said in (*apart, *(one.message for one in found.outliers)):
        console.print(f"WARNING {said}", style="yellow", soft_wrap=True)
    for missing in found.missing:
        console.print(f"missing {missing.name}: {missing.message}", soft_wrap=True)


def _print_grid(console: "Console", grid: Grid) -> None:
    from rich.table import Table

    table = Table(title=grid.title, title_justify="left", box=None, padding=(0, 1), pad_edge=False)
    for k, head in enumerate(grid.heads):
        right = k in grid.numbers
        table.add_column(head, justify="right" if right else "left", overflow="fold")
    for row in grid.rows:
        table.add_row(*row)
    console.print()
    console.print(table)
    for line in grid.notes:
        console.print(line, soft_wrap=True)
