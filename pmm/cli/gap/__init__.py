"""``pmm gap``: why rig and simulation differ."""

from collections.abc import Sequence
from pathlib import Path

import click

from pmm.cli.group import CommandGroup


class Jobs(CommandGroup):
    """The group of the jobs; a campaign in place of one is diagnosed."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Take a campaign, or its options, in place of a job for its diagnosis."""
        is_job = args and args[0] in {*self.names, "-h", "--help"}
        if args and not is_job and (args[0].startswith("-") or Path(args[0]).exists()):
            args = ["diagnose", *args]
        return super().parse_args(ctx, args)

    def unknown(self, word: str, names: Sequence[str]) -> str:
        """Return what is said of a word that is no job: it may be a campaign that is not there."""
        from difflib import get_close_matches

        near = get_close_matches(word, names, n=1, cutoff=0.7)
        hint = f"did you mean the job {near[0]!r}?" if near else f"jobs: {', '.join(names)}"
        return f"{word}: no such folder or campaign file; {hint}"

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """List what a campaign in place of a job takes, then the jobs."""
        diagnose = self.get_command(ctx, "diagnose")
        if diagnose is not None:
            options = [
                parameter
                for parameter in diagnose.get_params(ctx)
                if isinstance(parameter, click.Option)
            ]
            records = [option.get_help_record(ctx) for option in options]
            with formatter.section("Options with a campaign"):
                formatter.write_dl([record for record in records if record is not None])
        self.format_commands(ctx, formatter)


_LINES = {
    "add": "Write an effect with its fitted parameters into the campaign file.",
    "answer": "Diagnose every case in BOARD/cases and write one answer each (docs/sealed.md).",
    "pursue": "Propose runs, take in their recordings and diagnose again.",
    "pendulum": "Find what separates a free decay, a swing or a bifilar test from its simulation.",
    "add-pendulum": "Write effects with their fitted parameters into the file of a pendulum.",
    "diagnose": "Say where rig and simulation differ.",
}  # of the help


@click.group(
    cls=Jobs,
    package="pmm.cli.gap",
    names=_LINES,
    options_metavar="",
    subcommand_metavar="CAMPAIGN|COMMAND [OPTIONS]",
)
def gap() -> None:
    """Find out why rig and simulation differ.

    "pmm gap CAMPAIGN" diagnoses a campaign, as "pmm gap diagnose CAMPAIGN" does.

    \b
    pmm gap my-campaign --hold-out frequency=1.1 --page gap.html
    pmm gap pendulum roll.toml --page gap.html
    pmm gap answer board
    """  # noqa: D301
