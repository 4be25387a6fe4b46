"""``pmm plan``: look at a plan before it is run."""

import click

from pmm.cli.group import CommandGroup


@click.group(cls=CommandGroup, kind="action")
def plan() -> None:
    """Check and show a plan of runs, before the rig moves.

    A plan (docs/plans.md) names its rig (docs/rig-file.md). Exit status: 0 the rig can run it, 1 it
    cannot, 2 a file is wrong.

    \b
    pmm plan check examples/vertical/plan.toml
    """  # noqa: D301


@plan.command()
@click.argument("file", metavar="PLAN.toml")
@click.option("--all", "every", is_flag=True, help="Each run of a finding, not the worst alone.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON document, not a table.")
def check(file: str, every: bool, as_json: bool) -> None:
    """Say what the rig cannot do, and what the field advises against."""
    from pmm.cli.plan_work import check as run

    run(file, every=every, as_json=as_json)


@plan.command()
@click.argument("file", metavar="PLAN.toml")
@click.option("--plot", metavar="FOLDER", help="Draw the matrix there, as SVG and PNG.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON document, not a table.")
def show(file: str, plot: str | None, as_json: bool) -> None:
    """Print the runs in their order, and how long they take."""
    from pmm.cli.plan_work import show as run

    run(file, plot=plot, as_json=as_json)
