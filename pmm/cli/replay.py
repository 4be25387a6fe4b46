"""``pmm replay``: a run's raw log through the live path again."""

from typing import Any

import click


@click.command()
@click.argument("folder", metavar="RUN")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON document, not a table.")
def replay(**options: Any) -> None:
    """Run a run's raw log through the live path again, and compare.

    RUN is the folder of a run. The frames of bus.blf and the lines of lines.jsonl are decoded by
    the rig that the run's header names; samples and pulses have to be the recorded ones bit by bit,
    and the harmonics of its gates the same. Exit status 1 if they are not, or if a file of the run
    is not what was written.
    """
    from pmm.cli.replaying import run

    run(options["folder"], as_json=options["as_json"])
