"""``pmm gap answer``: the diagnosis of every case of a board, without its keys."""

from typing import Any

import click

from pmm.cli.engine_options import jobs_option, scheduler_option


@click.command()
@click.argument("folder", metavar="BOARD")
@click.option("--output", metavar="FOLDER", help="Where the answers go; BOARD/answers if not said.")
@click.option(
    "--leave-out",
    metavar="FILE.json",
    help="Effects to take out of the catalogue, by case; only these cases are answered.",
)
@jobs_option("one for each core")
@scheduler_option
@click.option("--overwrite", is_flag=True, help="Answer again what has an answer already.")
def answer(**options: Any) -> None:
    """Diagnose every case in BOARD/cases and write one answer each (docs/sealed.md).

    It looks at nothing but BOARD/cases. What is answered already is kept, so that a board that was
    broken off goes on. Exit status: 0 all answered, 1 some cases could not be diagnosed.
    """
    from pmm.parallel import one_thread

    one_thread()  # the matrices are small: threads would wait for each other
    from pmm.cli.gap_answering import GapAnswerOptions, run

    run(GapAnswerOptions(**options))
