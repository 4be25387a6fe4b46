"""What ``pmm gap pendulum`` does: read, diagnose, print."""

import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import click

from analysis.gap.pendulum.diagnose import Diagnosis
from pmm.cli.folders import check_files, check_folder
from pmm.cli.gap_diagnose_work import progress
from pmm.cli.gap_options import Chosen
from pmm.cli.hints import pasted
from pmm.cli.screen import messages, output
from pmm.cli.sections import print_sections
from pmm.gap.pendulum_conclusion import conclusion_of
from pmm.gap.pendulum_document import document
from pmm.gap.pendulum_examine import Examined, Options, examine_pendulum
from pmm.gap.pendulum_sections import sections
from pmm.gap.pendulum_words import sentences

if TYPE_CHECKING:
    from rich.console import Console


@dataclass(frozen=True)
class GapPendulumOptions(Chosen):
    """The options, by their names there."""

    file: str
    most: int
    page: str | None
    plot: str | None
    as_json: bool

    @property
    def options(self) -> Options:
        """What the diagnosis is told."""
        return Options(self.effects, self.without, self.most)

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
    found = examined.diagnosis
    if request.as_json:
        told = document(path.stem, examined, sentences(found))
        click.echo(json.dumps(told, indent=1, allow_nan=False))
    else:
        _print(output(), examined)
        if conclusion_of(found).adds:
            added = pasted("gap", "add-pendulum", request.file, *request.words())
            output().print(f"\n{added}", soft_wrap=True)
    if request.plot is not None:
        _draw(found, Path(request.plot))
    if request.page is not None:
        from pmm.report.pendulum_page import write_pendulum_page

        words = (*request.words(), "--page", request.page)
        command = pasted("gap", "pendulum", request.file, *words)
        write_pendulum_page(examined, path.stem, Path(request.page), command=command)
        messages().print(f"page: {request.page}")


def _draw(found: Diagnosis, folder: Path) -> None:
    from pmm.report.pendulum_figures import swings_figure
    from pmm.report.style import write_figure

    for at in range(len(found.problem.trials)):
        for path in write_figure(swings_figure(found, at), folder, f"gap-{at + 1}", ("svg",)):
            messages().print(str(path), soft_wrap=True)


def _print(console: "Console", examined: Examined) -> None:
    found = examined.diagnosis
    for line in sentences(found):
        console.print(line, style="bold", soft_wrap=True)
    for note in examined.notes:
        console.print(f"NOTE  {note}", soft_wrap=True)
    print_sections(console, sections(found))
