"""Options that several commands have, and how a command is given many."""

import math
from collections.abc import Callable
from typing import Any, Final, TypeVar

import click

F = TypeVar("F", bound=Callable[..., Any])
DEFAULT_LEVEL: Final = 0.95  # probability of the intervals

JSON: Final = click.option(
    "--json", "as_json", is_flag=True, help="Print one JSON document instead of tables."
)
PLOT: Final = click.option("--plot", metavar="FOLDER", help="Write figures there, as SVG and PNG.")


def with_options(*options: Callable[[Any], Any]) -> Callable[[F], F]:
    """Give a command options and arguments, in the order of its help."""

    def give(command: F) -> F:
        for option in reversed(options):
            command = option(command)
        return command

    return give


def probability(ctx: click.Context, param: click.Parameter, value: float | None) -> float | None:  # noqa: ARG001
    """Refuse what is no probability, with a word for who wrote it in per cent."""
    if value is None or (math.isfinite(value) and 0.0 < value < 1.0):
        return value
    per_cent = f"; for {value:g} % write {value / 100.0:g}" if 1.0 < value < 100.0 else ""
    raise click.BadParameter(f"{value:g} is no probability between 0 and 1{per_cent}.")


def jobs_option(default: str) -> Callable[[F], F]:
    """Return ``--jobs N``; ``None`` where it is not given, the default is the command's to take.

    Parameters
    ----------
    default
        The default in words, for the help.
    """
    return click.option(
        "--jobs", type=click.IntRange(1), metavar="N", show_default=default, help="Processes."
    )


SCHEDULER: Final = click.option(
    "--scheduler",
    metavar="ADDRESS",
    help="A Dask scheduler in place of processes, or slurm:N for N jobs of a queue.",
)

LEVEL: Final = click.option(
    "--level",
    type=float,
    callback=probability,
    metavar="P",
    default=DEFAULT_LEVEL,
    show_default=True,
    help="Probability of the intervals.",
)
