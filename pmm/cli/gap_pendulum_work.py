"""What ``pmm gap pendulum`` does: read, diagnose, print."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import click

from pmm.cli.folders import check_files, check_folder
from pmm.cli.gap_diagnose_work import progress
from pmm.cli.gap_options import Chosen
from pmm.cli.hints import pasted
from pmm.cli.screen import messages, output
from pmm.document.content import Document
from pmm.document.data import as_json
from pmm.document.terminal import print_document
from pmm.gap.pendulum_conclusion import conclusion_of
from pmm.gap.pendulum_document import RECORD, document
from pmm.gap.pendulum_examine import PendulumOptions, examine_pendulum


@dataclass(frozen=True)
class GapPendulumOptions(Chosen):
    """The options, by their names there."""

    file: str
    most: int
    page: str | None
    plot: str | None
    as_json: bool

    @property
    def options(self) -> PendulumOptions:
        """What the diagnosis is told."""
        return PendulumOptions(self.effects, self.without, self.most)

    def words(self) -> Iterator[str]:
        """Yield the options that decide what is found, as they are typed."""
        yield from ("--most", str(self.most))
        yield from super().words()


def run(request: GapPendulumOptions) -> None:
    """Diagnose a file's records and print what was found."""
    path = Path(request.file)
    check_files({"--page": request.page}, [("FILE.toml", path), *request.read])
    if request.plot is not None:
        check_folder(Path(request.plot), "--plot")
    with progress() as shown:
        examined = examine_pendulum(path, request.options, shown)
    told = document(path.stem, examined)
    if request.as_json:
        click.echo(as_json(told))
    else:
        print_document(output(), told)
        if conclusion_of(examined.diagnosis).adds:
            added = pasted("gap", "add-pendulum", request.file, *request.words())
            output().print(f"\n{added}", soft_wrap=True)
    if request.plot is not None:
        _draw(told, Path(request.plot))
    if request.page is not None:
        from pmm.document.page import write_page

        words = (*request.words(), "--page", request.page)
        command = pasted("gap", "pendulum", request.file, *words)
        write_page(told, Path(request.page), command=command)
        messages().print(f"page: {request.page}")


def _draw(told: Document, folder: Path) -> None:
    from pmm.document.style import write_figure

    records = (one for one in told.figures if one.name.startswith(RECORD))
    for at, one in enumerate(records, 1):
        for path in write_figure(one.draw(), folder, f"gap-{at}", ("svg",)):
            messages().print(str(path), soft_wrap=True)
