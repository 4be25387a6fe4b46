"""``pmm gap answer``: the diagnosis of every case of a board, without its keys."""

import os

import click


@click.command()
@click.argument("folder", metavar="BOARD")
@click.option("--output", metavar="FOLDER", help="Where the answers go; BOARD/answers if not said.")
@click.option(
    "--leave-out",
    metavar="FILE.json",
    help="Effects to take out of the catalogue, by case; only these cases are answered.",
)
@click.option(
    "--workers",
    type=click.IntRange(1),
    default=os.cpu_count() or 1,
    show_default="one per core",
    help="Processes.",
)
@click.option("--overwrite", is_flag=True, help="Answer again what has an answer already.")
def answer(
    folder: str, output: str | None, leave_out: str | None, workers: int, overwrite: bool
) -> None:
    """Diagnose every case in BOARD/cases and write one answer each (docs/sealed.md).

    It looks at nothing but BOARD/cases. What is answered already is kept, so that a board that was
    broken off goes on. Exit status: 0 all answered, 1 some cases could not be diagnosed.
    """
    from pmm.cli.gap_answering import Request, run

    run(Request(folder, output, leave_out, workers, overwrite))
