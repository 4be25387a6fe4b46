"""A score as one page: figure, tables and how it was made in a single file, offline."""

from pathlib import Path

from pmm.document.page import inline_svg, write_template
from pmm.document.style import render
from pmm.version import provenance
from tests.sealed.scoring.figure import score_figure
from tests.sealed.scoring.score import Score
from tests.sealed.scoring.tables import tables


def write_page(score: Score, path: Path, *, title: str, command: str) -> None:
    """Write a score as one HTML page that needs nothing besides itself.

    Parameters
    ----------
    path
        The file to write; its folder is made if it is not there.
    command
        What was run to make it.
    """
    svg = render(score_figure(score), "svg", "score")
    content = {
        "title": title,
        "command": command,
        "score": score,
        "tables": tables(score),
        "drawing": inline_svg(svg, "score", "what each row reaches"),
        "versions": provenance(),
    }
    write_template("page.html.jinja", content, path, "tests.sealed.scoring")
