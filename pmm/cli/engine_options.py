"""Where work is done: options of all commands that share it out (``pmm/parallel.py``)."""

from collections.abc import Callable
from typing import Any, TypeVar

import click

F = TypeVar("F", bound=Callable[..., Any])
DEFAULT_TRIALS = 20_000  # of a Monte Carlo


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


def scheduler_option(function: F) -> F:
    """Give a command ``--scheduler ADDRESS``."""
    return click.option(
        "--scheduler", metavar="ADDRESS", help="A Dask scheduler in place of processes."
    )(function)
