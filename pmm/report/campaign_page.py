"""A campaign's report: one page that needs nothing besides itself, on screen and on paper."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from analysis.coefficients.recommendation import recommended
from pmm.coefficients.reading import sha256_of
from pmm.coefficients.workflow import Outcome
from pmm.document.flag_lines import FlagLine, flag_lines
from pmm.document.inline import inline_svg
from pmm.document.style import render
from pmm.report.campaign_tables import (
    Grid,
    budget_table,
    finding_tables,
    given_table,
    recommended_table,
    run_table,
    value_tables,
)
from pmm.report.coefficient_plots import figures
from pmm.report.page import write_template
from pmm.version import provenance


@dataclass(frozen=True)
class Drawing:
    """A figure of the page."""

    svg: str
    caption: str


@dataclass(frozen=True)
class Section:
    """A part of the page; what it does not have is empty."""

    name: str
    anchor: str
    text: str = ""
    tables: tuple[Grid, ...] = ()
    drawings: tuple[Drawing, ...] = ()
    flags: tuple[FlagLine, ...] = ()


@dataclass(frozen=True)
class _File:
    name: str
    sha256: str
    text: str


def write_campaign_page(
    outcome: Outcome, path: Path, *, title: str, command: str, files: Sequence[Path]
) -> None:
    """Write a campaign's report as one HTML page.

    Parameters
    ----------
    path
        The file to write; its folder is made if it is not there.
    command
        What was run to make it, so that it can be made again.
    files
        Configuration that was read: shown in full, with hashes.
    """
    content = {
        "title": title,
        "summary": _summary(outcome),
        "sections": list(_sections(outcome)),
        "command": command,
        "versions": provenance(),
        "files": [_File(one.name, sha256_of(one), _text(one)) for one in files],
    }
    write_template("campaign.html.jinja", content, path)


def _summary(outcome: Outcome) -> list[tuple[str, str]]:
    found = outcome.result
    agree = sum(one.agrees for one in found.checks)
    outside = sum(not one.within for one in found.references)
    rows = [
        ("campaign", ", ".join(outcome.names)),
        ("runs", f"{len(outcome.cycles)} used, {len(outcome.failed)} could not be"),
        ("plane and form", f"{found.plane}, {found.form}"),
        ("system", found.normalisation),
        ("values", f"{len(recommended(found))} recommended, of {len(found.entries)} in all"),
        ("repeats that stand off", str(len(found.outliers))),
        ("kinds of flags", str(len(flag_lines(outcome.all_flags)))),
    ]
    if found.checks:
        rows.append(("checks between runs", f"{agree} of {len(found.checks)} agree"))
    if found.references:
        rows.append(("beside tables", f"{outside} of {len(found.references)} outside"))
    return rows


def _sections(outcome: Outcome) -> Iterator[Section]:
    found = outcome.result
    values = (recommended_table(found), *value_tables(found))
    yield Section("Coefficients", "coefficients", tables=values)
    yield Section("Figures", "figures", drawings=tuple(_drawings(outcome)))
    findings = tuple(finding_tables(found))
    if findings:
        yield Section("What was found", "findings", tables=findings)
    flags = flag_lines(outcome.all_flags)
    text = "" if flags else "Nothing."
    yield Section("What was flagged", "flags", text=text, flags=flags)
    yield Section("Uncertainty", "budget", tables=(given_table(outcome), budget_table(found)))
    yield Section("Runs", "runs", tables=(run_table(outcome),))


def _drawings(outcome: Outcome) -> Iterator[Drawing]:
    for name, caption, draw in figures(outcome.result):
        svg = render(draw(), "svg", name)
        yield Drawing(inline_svg(svg, name, caption), caption)


def _text(path: Path) -> str:
    return path.read_text(encoding="utf-8", errors="replace")
