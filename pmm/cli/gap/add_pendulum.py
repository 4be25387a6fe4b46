"""``pmm gap add-pendulum``: put the causes that were found into a pendulum's simulation."""

from typing import Any

import click

from pmm.cli.gap_options import catalogue_options, most_option


@click.command("add-pendulum")
@click.argument("file", metavar="FILE.toml")
@click.argument("causes", nargs=-1, metavar="[EFFECT]...")
@most_option
@catalogue_options
@click.option("--json", "as_json", is_flag=True, help="Print one JSON document, not a text.")
def add_pendulum(**options: Any) -> None:
    """Write effects with their fitted parameters into the file of a pendulum or a free decay.

    The next "pmm gap pendulum FILE.toml" starts from them. With EFFECT, that one or those are
    fitted and added; without, what is found. The file as it was is kept beside it as FILE.toml.1
    (.2, ...). Where the cause cannot be told nothing is written. The options that "pmm gap
    pendulum" was given are given here too, so that the same cause is found.

    Exit status: 0 added; 1 no cause is found; 2 the request was wrong.
    """
    from pmm.cli.gap_add_pendulum_work import GapAddPendulumOptions, run

    run(GapAddPendulumOptions(**options))
