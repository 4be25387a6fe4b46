"""``pmm recover``: recordings out of whatever a crash left of runs."""

from typing import Any

import click


@click.command()
@click.argument("places", metavar="FOLDER...", nargs=-1, required=True)
@click.option("--json", "as_json", is_flag=True, help="Print one JSON document, not a table.")
def recover(**options: Any) -> None:
    """Make recordings of runs that were not closed.

    FOLDER is the folder of a run or of a campaign. Each run that was not closed gets its run.nc, up
    to the last sample that is whole. Nothing that is there is changed or removed; doing it again
    does nothing. What is not what was written is named, and made again where the run's other
    files tell how. Exit status 1 if there was such, or if a run has nothing to recover.
    """
    from pmm.cli.recovering import run

    run(options["places"], as_json=options["as_json"])
