"""A page of parts, each with lines, figures and tables: one file, no network, no script."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from pmm.report.inline import inline_svg
from pmm.report.page import write_template
from pmm.report.style import render
from pmm.report.table import Section
from pmm.report.tabulate import versions

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class Drawing:
    """A figure as markup, and what is said below it."""

    svg: str
    caption: str


@dataclass(frozen=True)
class Part:
    """A section of the page, with its figures."""

    section: Section
    drawings: tuple[Drawing, ...] = ()


@dataclass(frozen=True)
class Head:
    """What stands above the parts.

    Attributes
    ----------
    said
        The answer, one paragraph each.
    note
        How the numbers are to be read.
    notices
        Kind and text of what has to be known before.
    """

    title: str
    said: tuple[str, ...]
    note: str
    notices: tuple[tuple[str, str], ...] = ()


def drawn(figure: "Figure", name: str, caption: str) -> Drawing:
    """Return a figure for a page; ``name`` tells it from the page's others."""
    return Drawing(inline_svg(render(figure, "svg", name), name, caption), caption)


def write_parts(head: Head, parts: Sequence[Part], path: Path, *, command: str) -> None:
    """Write a page.

    Parameters
    ----------
    path
        The file to write; its folder is made if it is not there.
    command
        What was run to make it.
    """
    content = {
        "title": head.title,
        "said": head.said,
        "note": head.note,
        "notices": head.notices,
        "parts": parts,
        "command": command,
        "versions": versions(),
    }
    write_template("parts.html.jinja", content, path)
