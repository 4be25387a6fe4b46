"""A score as one page: figure, tables and how it was made in a single file, offline."""

from importlib.resources import files
from pathlib import Path

from pmm.gap.scoring.figure import score_figure
from pmm.gap.scoring.score import Score
from pmm.gap.scoring.tables import tables
from pmm.report.inline import inline_svg
from pmm.report.style import render
from pmm.report.tabulate import versions
from pmm.whole_file import write_whole


def write_page(score: Score, path: Path, *, title: str, command: str) -> None:
    """Write a score as one HTML page that needs nothing besides itself.

    Parameters
    ----------
    path
        The file to write; its folder is made if it is not there.
    command
        What was run to make it.
    """
    from jinja2 import Environment, StrictUndefined
    from markupsafe import Markup

    # All text is escaped; drawing and style alone are markup.
    environment = Environment(
        autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    environment.filters["markup"] = Markup
    template = environment.from_string(
        files("pmm.gap.scoring").joinpath("page.html.jinja").read_text(encoding="utf-8")
    )
    svg = render(score_figure(score), "svg", "score")
    page = template.render(
        title=title,
        command=command,
        score=score,
        tables=tables(score),
        style=_style(),
        drawing=inline_svg(svg, "score", "what each row reaches"),
        versions=versions(),
    )
    path.parent.mkdir(parents=True, exist_ok=True)
    write_whole(path, page)


def _style() -> str:
    """Return the style sheet of the reports, so that all pages look alike."""
    report = files("pmm.report").joinpath("page.html.jinja").read_text(encoding="utf-8")
    return report.partition("<style>")[2].partition("</style>")[0]
