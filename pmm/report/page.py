"""One page that holds a report: tables, figures and provenance in a single file, offline."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import Any

from analysis.resolver.analysis import Analysis
from pmm.document.flag_lines import FlagLine, flag_lines
from pmm.document.inline import inline_svg
from pmm.document.labels import plain
from pmm.document.style import render
from pmm.report.plots import FIGURES
from pmm.report.tabulate import GateTable, gate_table, provenance, versions
from pmm.whole_file import write_whole

_CAPTIONS = {
    "gate": "The record, the window that was found or given and the gate, with the fit over the "
    "trace; beside it the end of the gate, and the residual of the fit.",
    "phasors": "Harmonics as phasors with their 95 % regions: in phase to the right, quadrature "
    "up. Below each, how the gate's single periods spread about it, magnified.",
    "spectrum": "Amplitude spectrum over the gate, and the part of a vibration that the resolver "
    "lets through into each harmonic.",
}


@dataclass(frozen=True)
class _Drawing:
    svg: str
    caption: str


@dataclass(frozen=True)
class _Section:
    """One analysis on the page."""

    name: str
    anchor: str
    flags: tuple[FlagLine, ...]
    tables: tuple[GateTable, ...]
    drawings: tuple[_Drawing, ...]
    provenance: list[tuple[str, str]]


def write_page(analyses: Sequence[Analysis], path: Path, *, title: str, command: str) -> None:
    """Write a report of some analyses as one HTML page.

    The page needs nothing besides itself: no other file, no network, no script. It reads in light
    and dark, on a phone and in print. Figures are those of each analysis's first gate, tables of
    all gates.

    Parameters
    ----------
    path
        The file to write; its folder is made if it is not there.
    title
        Heading of the page.
    command
        What was run to make it, so that it can be made again.
    """
    sections = [_section(analysis, f"run{k}") for k, analysis in enumerate(analyses, start=1)]
    content = {"title": title, "command": command, "sections": sections, "versions": versions()}
    write_template("page.html.jinja", content, path)


def write_template(
    name: str, content: Mapping[str, Any], path: Path, package: str = "pmm.report"
) -> None:
    """Fill a package's template and write it as a page; all pages share one style.

    Parameters
    ----------
    content
        Plain text by the template's names: all of it is escaped. The drawings alone are markup, and
        their text was escaped in them.
    """
    from jinja2 import Environment, StrictUndefined
    from markupsafe import Markup

    environment = Environment(
        autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    environment.filters["markup"] = Markup
    template = environment.from_string(files(package).joinpath(name).read_text(encoding="utf-8"))
    style = files("pmm.document").joinpath("page.css").read_text(encoding="utf-8")
    page = template.render(style=style, **content)
    path.parent.mkdir(parents=True, exist_ok=True)
    # A file name may hold bytes that are no text; they must not cost the page.
    write_whole(path, page.encode("utf-8", errors="replace"))


def _section(analysis: Analysis, anchor: str) -> _Section:
    return _Section(
        name=analysis.recording.name,
        anchor=anchor,
        flags=flag_lines(analysis.flags),
        tables=tuple(gate_table(analysis, reading) for reading in analysis.readings),
        drawings=tuple(_drawing(analysis, kind, anchor) for kind in FIGURES),
        provenance=provenance(analysis),
    )


def _drawing(analysis: Analysis, kind: str, anchor: str) -> _Drawing:
    prefix = f"{anchor}-{kind}"
    svg = render(FIGURES[kind](analysis), "svg", prefix)
    return _Drawing(
        inline_svg(svg, prefix, f"{kind} of {plain(analysis.recording.name)}"), _CAPTIONS[kind]
    )
