"""``pmm simulate``: a campaign file in, a campaign folder with a recording per run out."""

from typing import Any

import click


@click.command()
@click.argument("campaign", metavar="CAMPAIGN.toml")
@click.option("--output", metavar="FOLDER", help="Where to write.  [default: the campaign's name]")
@click.option("--seed", type=click.IntRange(min=0), help="Of all noise, in place of the file's.")
@click.option(
    "--run", "runs", multiple=True, metavar="NAME", help="Simulate this run only; repeatable."
)
@click.option(
    "--effect",
    "effects",
    multiple=True,
    metavar="NAME[:PARAM=VALUE,...]",
    help='Switch an effect on, besides those of the file; repeatable; "pmm effects" lists them.',
)
@click.option("--effects-file", metavar="FILE.py", help="A Python file with effects of your own.")
@click.option("--plot", metavar="FOLDER", help="Draw each run's signals stage by stage there.")
@click.option("--overwrite", is_flag=True, help="Replace recordings that are there.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON document, not a table.")
def simulate(**options: Any) -> None:
    """Simulate the runs of a campaign and write its recordings.

    The folder gets the campaign file and a NetCDF recording per run; "pmm analyse FOLDER" then
    analyses them. No recording is overwritten unless you say so.
    """
    from pmm.cli.simulating import SimulateOptions, run

    run(SimulateOptions(**options))
