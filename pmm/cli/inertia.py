"""``pmm inertia``: from the record of any pendulum to a model's mass properties."""

from collections.abc import Callable
from typing import Any

import click

from pmm.cli.group import CommandGroup


@click.group(cls=CommandGroup, kind="job")
def inertia() -> None:
    """Find mass, centre of gravity, inertia and gyradii, with a budget.

    Each job reads a small TOML file that names the records and the geometry with their
    uncertainties (docs/inertia-files.md). Exit status: 0 done, 1 the data say no (a target missed,
    a known weight not met, a record that carries no period), 2 the file is wrong.

    \b
    pmm inertia bifilar examples/inertia/hull.toml --output model.toml --plot plots
    """  # noqa: D301


def _job(name: str) -> Callable[[Callable[..., None]], click.Command]:
    """Make a job's command, with the options that all of them have."""

    def make(function: Callable[..., None]) -> click.Command:
        options = (
            click.argument("file", metavar="FILE"),
            click.option("--json", "as_json", is_flag=True, help="Print one JSON document."),
            click.option("--output", metavar="TOML", help="Write the section [model] there."),
            click.option("--overwrite", is_flag=True, help="Replace that file if it is there."),
            click.option("--plot", metavar="FOLDER", help="Write figures there, as SVG and PNG."),
        )
        for option in reversed(options):
            function = option(function)
        return inertia.command(name)(function)

    return make


_fits = click.option(
    "--fits",
    is_flag=True,
    help="Fit each record by the forms F1 to F4 too, and show their periods.",
)


def _run(name: str, options: dict[str, Any]) -> None:
    from pmm.cli.inertia_running import InertiaOptions, run

    run(InertiaOptions(name, **options))


@_job("swing")
@_fits
def swing(**options: Any) -> None:
    """Swing: alone, with the model, and its checks."""
    _run("swing", options)


@_job("bifilar")
@_fits
def bifilar(**options: Any) -> None:
    """Bifilar suspension: yaw, pitch or roll, depth, principal axes."""
    _run("bifilar", options)


@_job("pendulum")
@_fits
def pendulum(**options: Any) -> None:
    """Compound pendulum: about one axis, or two (Lamboley)."""
    _run("pendulum", options)


@_job("incline")
def incline(**options: Any) -> None:
    """Inclining test: depth of the centre of gravity."""
    _run("incline", options)


@_job("combine")
def combine(**options: Any) -> None:
    """Put parts together and take others off."""
    _run("combine", options)


@_job("ballast")
def ballast(**options: Any) -> None:
    """Find where given weights go."""
    _run("ballast", options)


@_job("plan")
def plan(**options: Any) -> None:
    """Forecast a test: uncertainty, best line length, resonance."""
    _run("plan", options)
