"""``pmm gap``: why rig and simulation differ, and how well that is found out."""

from importlib import import_module

import click

# Job -> module with a click command of the same name; each is imported when it is asked for.
_JOBS = {
    "answer": "pmm.cli.gap_answer",
    "check": "pmm.cli.gap_check",
}


class Jobs(click.Group):
    """The group of the jobs."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the jobs' names."""
        return list(_JOBS)

    def get_command(self, ctx: click.Context, name: str) -> click.Command | None:
        """Import a job."""
        if name not in _JOBS:
            return None
        command = getattr(import_module(_JOBS[name]), name)
        return command if isinstance(command, click.Command) else None

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Find the job that is meant, or say which one may be."""
        if args[0] not in _JOBS and not args[0].startswith("-"):
            from difflib import get_close_matches

            near = get_close_matches(args[0], _JOBS, n=1, cutoff=0.4)
            hint = f"did you mean {near[0]!r}?" if near else f"jobs: {', '.join(_JOBS)}"
            ctx.fail(f"no job {args[0]!r}; {hint}")
        return super().resolve_command(ctx, args)


@click.group(cls=Jobs)
def gap() -> None:
    """Find out why rig and simulation differ, and check how well that is done.

    \b
    pmm gap answer board
    pmm gap check board --page board.html
    """  # noqa: D301
