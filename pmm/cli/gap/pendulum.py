"""``pmm gap pendulum``: why a pendulum test or a free decay and its simulation differ."""

from typing import Any

import click

from pmm.cli.gap_options import catalogue_options, most_option


@click.command()
@click.argument("file", metavar="FILE.toml")
@most_option
@catalogue_options
@click.option("--page", metavar="FILE.html", help="Write a page with figures.")
@click.option("--plot", metavar="FOLDER", help="Draw measured and simulated swings there.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON document, not tables.")
def pendulum(**options: Any) -> None:
    """Find what separates a free decay, a swing or a bifilar test from its simulation.

    FILE names the records and what is known of the set-up (docs/gap-pendulums.md). "No gap beyond
    u" is an answer.

    \b
    pmm gap pendulum roll.toml --page gap.html
    pmm gap pendulum roll.toml --effects quadratic_drag --effects mine.py
    pmm gap add-pendulum roll.toml

    Exit status: 0 diagnosed; 1 the data say no; 2 the request was wrong.
    """  # noqa: D301
    from pmm.cli.gap_pendulum_work import GapPendulumOptions, run

    run(GapPendulumOptions(**options))
