"""``pmm gap``: why rig and simulation differ."""

from importlib import import_module

import click

from pmm.cli.group import NamingGroup

# Job -> module with a click command of that name, "_" for "-"; imported when it is asked for.
_JOBS = {
    "add": "pmm.cli.gap_add",
    "answer": "pmm.cli.gap_answer",
    "pendulum": "pmm.cli.gap_pendulum",
    "add-pendulum": "pmm.cli.gap_add_pendulum",
    "diagnose": "pmm.cli.gap_diagnose",
}


class Jobs(NamingGroup):
    """The group of the jobs."""

    names = _JOBS
    kind = "job"

    def get_command(self, ctx: click.Context, name: str) -> click.Command | None:
        """Import a job."""
        if name not in _JOBS:
            return None
        command = getattr(import_module(_JOBS[name]), name.replace("-", "_"))
        return command if isinstance(command, click.Command) else None

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Take a campaign, or its options, in place of a job for its diagnosis."""
        if args and args[0] not in {*_JOBS, "-h", "--help"}:
            from pathlib import Path

            if args[0].startswith("-") or Path(args[0]).exists():
                args = ["diagnose", *args]
        return super().parse_args(ctx, args)

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Find the job that is meant; what is none may be a campaign that is not there."""
        if args[0] not in _JOBS and not args[0].startswith("-"):
            from difflib import get_close_matches

            near = get_close_matches(args[0], _JOBS, n=1, cutoff=0.7)
            hint = f"did you mean the job {near[0]!r}?" if near else f"jobs: {', '.join(_JOBS)}"
            ctx.fail(f"{args[0]}: no such folder or campaign file; {hint}")
        return super().resolve_command(ctx, args)

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """List what a campaign in place of a job takes, then the jobs."""
        diagnose = self.get_command(ctx, "diagnose")
        if diagnose is not None:
            options = [one for one in diagnose.get_params(ctx) if isinstance(one, click.Option)]
            own = [one.get_help_record(ctx) for one in options]
            with formatter.section("Options with a campaign"):
                formatter.write_dl([one for one in own if one is not None])
        self.format_commands(ctx, formatter)


@click.group(cls=Jobs, options_metavar="", subcommand_metavar="CAMPAIGN|COMMAND [OPTIONS]")
def gap() -> None:
    """Find out why rig and simulation differ.

    "pmm gap CAMPAIGN" diagnoses a campaign, as "pmm gap diagnose CAMPAIGN" does.

    \b
    pmm gap my-campaign --hold-out frequency=1.1 --page gap.html
    pmm gap pendulum roll.toml --page gap.html
    pmm gap answer board
    """  # noqa: D301
