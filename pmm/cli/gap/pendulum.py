"""``pmm gap pendulum``: why a pendulum test or a free decay and its simulation differ."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from pmm.cli.gap.options import CATALOGUE, MOST, CatalogueOptions
from pmm.cli.options import JSON

if TYPE_CHECKING:
    from pmm.document.content import Document


@click.command()
@click.argument("file", metavar="FILE.toml")
@MOST
@CATALOGUE
@click.option("--page", metavar="FILE.html", help="Write a page with figures.")
@click.option("--plot", metavar="FOLDER", help="Draw measured and simulated swings there.")
@JSON
def pendulum(
    file: str,
    most: int,
    page: str | None,
    plot: str | None,
    as_json: bool,
    **catalogue_options: Any,
) -> None:
    """Find what separates a free decay, a swing or a bifilar test from its simulation.

    Or a body on springs or afloat under a known force. FILE names the records and what is known of
    the set-up (docs/gap-pendulums.md). "No gap beyond u" is an answer.

    \b
    pmm gap pendulum roll.toml --page gap.html
    pmm gap pendulum roll.toml --effects quadratic_drag --effects mine.py
    pmm gap add-pendulum roll.toml

    Exit status: 0 diagnosed; 1 the data say no; 2 the request was wrong.
    """  # noqa: D301
    from pmm.cli.files import check_files, check_folder, write_asked_page
    from pmm.cli.screen import doing, pasted, say, show
    from pmm.gap.pendulum_conclusion import conclusion_of
    from pmm.gap.pendulum_document import document
    from pmm.gap.pendulum_examination import PendulumOptions, examine_pendulum

    choice, path = CatalogueOptions(**catalogue_options), Path(file)
    check_files({"--page": page}, [("FILE.toml", path), *choice.read])
    check_folder(plot, "--plot")
    options = PendulumOptions(choice.effects, choice.without, most)
    with doing("reading") as progress:
        examination = examine_pendulum(path, options, progress)
    content = document(path.stem, examination)
    words = ("--most", str(most), *choice.words())
    show(content, as_json=as_json)
    if conclusion_of(examination.diagnosis).adds and not as_json:
        say("", pasted("gap", "add-pendulum", file, *words))
    if plot is not None:
        _draw(content, Path(plot))
    write_asked_page(content, page, ("gap", "pendulum", file, *words))


def _draw(content: "Document", folder: Path) -> None:
    from pmm.cli.screen import messages
    from pmm.document.style import write_figure
    from pmm.gap.pendulum_document import RECORD

    records = (figure for figure in content.figures if figure.name.startswith(RECORD))
    for number, figure in enumerate(records, 1):
        for path in write_figure(figure.draw(), folder, f"gap-{number}", ("svg",)):
            messages().print(str(path))
