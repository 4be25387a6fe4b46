"""``pmm plan``: look at a plan before it is run."""

import click

ACTIONS = ("check", "show")


class Actions(click.Group):
    """The group of what can be done with a plan."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the actions' names."""
        return list(ACTIONS)

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Find the action that is meant, or say which one may be."""
        if args[0] not in ACTIONS and not args[0].startswith("-"):
            from difflib import get_close_matches

            near = get_close_matches(args[0], ACTIONS, n=1, cutoff=0.4)
            hint = f"did you mean {near[0]!r}?" if near else f"actions: {', '.join(ACTIONS)}"
            ctx.fail(f"no action {args[0]!r}; {hint}")
        return super().resolve_command(ctx, args)


@click.group(cls=Actions)
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
