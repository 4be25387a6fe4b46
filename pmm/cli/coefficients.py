"""``pmm coefficients``: a campaign's recordings in, added mass, damping and derivatives out."""

import math
from collections.abc import Callable
from typing import Any, TypeVar

import click

from pmm.cli.engine_options import DEFAULT_TRIALS, jobs_option, scheduler_option

SYSTEMS = ("dimensional", "prime", "mmg", "seakeeping")
FORMS = ("manoeuvring", "seakeeping")
F = TypeVar("F", bound=Callable[..., Any])


def _probability(
    ctx: click.Context,  # noqa: ARG001
    param: click.Parameter,  # noqa: ARG001
    value: float | None,
) -> float | None:
    if value is None or (math.isfinite(value) and 0.0 < value < 1.0):
        return value
    raise click.BadParameter(f"{value:g} is no probability between 0 and 1.")


def shared_options(function: F) -> F:
    """Add what ``pmm coefficients`` and ``pmm report`` have in common."""
    options = (
        click.argument("campaigns", nargs=-1, required=True, metavar="CAMPAIGN..."),
        click.option(
            "--settings",
            metavar="TOML",
            help="Settings file.  [default: coefficients.toml in the first campaign, if there]",
        ),
        click.option("--form", type=click.Choice(FORMS), help="Names and signs.  [manoeuvring]"),
        click.option("--system", type=click.Choice(SYSTEMS), help="Units.  [dimensional]"),
        click.option(
            "--inertia",
            metavar="model|dry|TOML",
            help="What is taken off: [model] of the campaign, its dry runs, or a file of "
            "`pmm inertia`.",
        ),
        click.option(
            "--want", "wanted", multiple=True, metavar="NAME",
            help="A coefficient that has to be there; repeatable.",
        ),
        click.option(
            "--leave-out", multiple=True, metavar="RUN", help="A run not to use; repeatable."
        ),
        click.option(
            "--reference", "references", multiple=True, metavar="FILE",
            help="A table to hold the values against (CSV, NetCDF of Capytaine); repeatable.",
        ),
        click.option(
            "--uncertainty",
            type=click.Choice(("linear", "monte-carlo")),
            help="Draw a Monte Carlo beside the linear budget.  [linear]",
        ),
        click.option(
            "--trials", type=click.IntRange(min=1000), metavar="N",
            help=f"Of the Monte Carlo.  [{DEFAULT_TRIALS}]",
        ),
        click.option("--seed", type=click.IntRange(min=0), metavar="N", help="Of the trials.  [0]"),
        click.option(
            "--level", type=float, callback=_probability, metavar="P",
            help="Probability of the intervals.  [0.95]",
        ),
        jobs_option("one for each core; 1 where there is little to do"),
        scheduler_option,
    )  # fmt: skip
    for option in reversed(options):
        function = option(function)
    return function


@click.command()
@shared_options
@click.option("--plot", metavar="FOLDER", help="Write figures there, as SVG and PNG.")
@click.option("--csv", "csv_file", metavar="FILE", help="Write the table there.")
@click.option("--netcdf", metavar="FILE", help="Write everything there, budgets included.")
@click.option("--simman", metavar="FOLDER", help="Write each run's SIMMAN deliverables there.")
@click.option("--overwrite", is_flag=True, help="Replace files that are there.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON document instead of tables.")
def coefficients(**options: Any) -> None:
    """Find a campaign's coefficients, each with its interval and budget.

    Each CAMPAIGN is a folder with a campaign.toml and a recording per run, as `pmm run` and `pmm
    simulate` leave it, or written by hand beside recordings of another system. Several are taken
    as one, of one rig and one model.

    \b
    pmm coefficients campaign/ --plot plots --system prime
    pmm coefficients campaign/ --uncertainty monte-carlo --jobs 2 --json

    Exit status: 0 done; 1 the data say no (a run that cannot be used, a wanted coefficient that
    the runs do not determine); 2 the request was wrong (missing inertia, two runs of one name,
    another geometry, an unknown name).
    """  # noqa: D301
    from pmm.cli.coefficients_running import run

    run(options)
