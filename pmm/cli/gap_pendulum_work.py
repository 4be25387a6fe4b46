"""What ``pmm gap pendulum`` does: read, diagnose, print."""

import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import click

from analysis.gap.pendulum.diagnose import Diagnosis, diagnose_trials
from analysis.gap.pendulum.said import said
from analysis.gap.pendulum.verdict import NONE, UNKNOWN, told_apart
from pmm.cli.gap_diagnose_work import progress
from pmm.cli.screen import output
from pmm.gap.pendulum import load_problem
from pmm.gap.pendulum_document import document, parameters

if TYPE_CHECKING:
    from rich.console import Console

_SHOWN = 6
_LEAST = 1e-4  # probability that is worth a row


@dataclass(frozen=True)
class Request:
    """The options, by their names there."""

    file: str
    most: int
    plot: str | None
    as_json: bool


def run(request: Request) -> None:
    """Diagnose a file's records and print what was found."""
    path = Path(request.file)
    with progress() as told:
        found = diagnose_trials(load_problem(path), most=request.most, progress=told)
    figures: list[Path] = []
    if request.plot is not None:
        from pmm.gap.pendulum_figure import draw

        figures = draw(found, Path(request.plot))
    if request.as_json:
        click.echo(json.dumps(document(path.stem, found), indent=1))
        return
    _print(output(), found)
    for figure in figures:
        output().print(str(figure), soft_wrap=True)


def _print(console: "Console", found: Diagnosis) -> None:
    for line in said(found):
        console.print(line, style="bold", soft_wrap=True)
    best = ", ".join(found.verdict.best) or "none: no gap beyond u"
    console.print(f"most probable  {best} ({_percent(next(iter(found.verdict.by_set.values())))})")
    for name, rows in parameters(found.best).items():
        for key, one in rows.items():
            console.print(f"  {name}: {key} = {one['value']:.4g} ± {one['uncertainty']:.2g}")
    _table(
        console,
        ["answer", "probability"],
        [(name, _percent(share)) for name, share in _probable(found)],
    )
    _table(
        console,
        ["where", "gap before [u]", "after [u]"],
        [(one.kind, f"{one.before:.2f}", f"{one.after:.2f}") for one in found.where],
    )
    _table(
        console,
        ["law of damping", "ln evidence ratio", "withheld gap [u]", "told apart"],
        list(_laws(found)),
    )
    _table(
        console,
        ["in place of", "could be", "ln evidence ratio"],
        [(one.instead_of, one.name, f"{one.log_ratio:.1f}") for one in found.alternatives],
    )
    for regime in found.regimes:
        _table(
            console,
            [f"withheld: {regime.name}", "gap [u]", "shrinks by", "95 %"],
            [
                (
                    ", ".join(one.causes) or "no cause",
                    f"{one.gap:.1f}",
                    _percent(one.shrinkage),
                    f"{_percent(one.low)} to {_percent(one.high)}",
                )
                for one in (regime.before, *regime.foretold)
            ],
        )
    _table(
        console,
        ["next run", "expected separation [sigma]"],
        [(one.what, f"{one.separation:.1f}") for one in found.proposals[:_SHOWN]],
    )


def _probable(found: Diagnosis) -> Iterator[tuple[str, float]]:
    """Yield classes and single causes that are not out of the question, and both verdicts."""
    for name, share in {**found.verdict.by_class, **found.verdict.by_cause}.items():
        if share > _LEAST or name in (NONE, UNKNOWN):
            yield name, share


def _laws(found: Diagnosis) -> Iterator[tuple[str, ...]]:
    for at, law in enumerate(found.laws):
        apart = "yes" if told_apart(found.laws[0], law) else "no"
        left = ", ".join(f"{gap:.1f}" for gap in law.withheld)
        yield law.name, f"{law.log_ratio:.1f}", left, apart if at else ""


def _percent(share: float) -> str:
    return f"{100.0 * share:.1f} %"


def _table(console: "Console", heads: list[str], rows: list[tuple[str, ...]]) -> None:
    from rich.table import Table

    if not rows:
        return
    table = Table(box=None, padding=(0, 2), pad_edge=False)
    for at, head in enumerate(heads):
        table.add_column(head, justify="right" if at else "left")
    for row in rows:
        table.add_row(*row)
    console.print()
    console.print(table)
