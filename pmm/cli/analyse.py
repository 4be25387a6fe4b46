"""``pmm analyse``: recordings in, harmonics with their intervals out."""

import math
from typing import Any

import click

DEFAULT_LEVEL = 0.95  # probability of the intervals


_POSITIVE = click.FloatRange(min=0.0, min_open=True)
_COUNT = click.IntRange(min=1)


def _finite(
    ctx: click.Context,  # noqa: ARG001
    param: click.Parameter,  # noqa: ARG001
    value: float | None,
) -> float | None:
    if value is not None and not math.isfinite(value):
        raise click.BadParameter(f"{value} is not a finite number.")
    return value


def _probability(ctx: click.Context, param: click.Parameter, value: float) -> float:
    _finite(ctx, param, value)
    if 0.0 < value < 1.0:
        return value
    per_cent = f"; for {value:g} % write {value / 100.0:g}" if 1.0 < value < 100.0 else ""
    raise click.BadParameter(f"{value:g} is no probability between 0 and 1{per_cent}.")


def _all_finite(
    ctx: click.Context, param: click.Parameter, values: tuple[float, ...]
) -> tuple[float, ...]:
    for value in values:
        _finite(ctx, param, value)
    return values


@click.command()
@click.argument("files", nargs=-1, required=True, metavar="FILE...")
@click.option("--reference", metavar="CHANNEL", help="Take the phase from this channel.")
@click.option(
    "--frequency", type=_POSITIVE, callback=_finite, metavar="HZ", help="Take a known frequency."
)
@click.option("--edges", metavar="FILE", help="Times of the photocell's edges, a column of text.")
@click.option(
    "--latency", type=float, callback=_finite, metavar="S", help="Delay of the photocell's pulses."
)
@click.option(
    "--angle-offset",
    type=float,
    callback=_finite,
    metavar="DEG",
    help="Shaft angle at the photocell's mark.",
)
@click.option(
    "--channel",
    "channels",
    multiple=True,
    metavar="NAME",
    help="Resolve this channel; repeatable.  [default: all but the reference and the shaft angle]",
)
@click.option("--harmonics", type=_COUNT, metavar="N", help="Highest harmonic.  [default: 3]")
@click.option(
    "--gate", type=_COUNT, metavar="M", help="Periods per gate.  [default: the steady stretch]"
)
@click.option(
    "--opens-at",
    type=float,
    callback=_finite,
    metavar="S",
    help="Open the first gate at this time.  [default: where the run is steady]",
)
@click.option("--periods", type=_COUNT, metavar="M", help="Periods to use after --opens-at.")
@click.option(
    "--steady-tolerance",
    type=_POSITIVE,
    callback=_finite,
    metavar="X",
    help="How far first harmonics may stray in a steady stretch, relative.  [default: 0.05]",
)
@click.option(
    "--let-through",
    type=_POSITIVE,
    callback=_all_finite,
    multiple=True,
    metavar="HZ",
    help="Tell how much of a vibration of this frequency gets into each harmonic; repeatable.",
)
@click.option(
    "--classic", is_flag=True, help="Show beside it what the measuring modes of 1963 would read."
)
@click.option(
    "--carrier",
    type=_POSITIVE,
    callback=_finite,
    metavar="HZ",
    help="Detect the channels given with --channel from a carrier first.",
)
@click.option(
    "--bandwidth",
    type=_POSITIVE,
    callback=_finite,
    metavar="HZ",
    help="Keep signals up to here of those on a carrier.  [default: 50]",
)
@click.option("--hann", is_flag=True, help="Taper each gate: for long gates with interference.")
@click.option("--no-drift", is_flag=True, help="Leave a linear drift in.")
@click.option(
    "--map",
    "column_map",
    metavar="TOML",
    help="Which column of a text file is what; other columns are not read.",
)
@click.option(
    "--column",
    "columns",
    multiple=True,
    metavar='"NAME=SOURCE[:UNIT]"',
    help="The same, one column at a time; repeatable. The time column is time=SOURCE:UNIT.",
)
@click.option(
    "--sample-rate",
    type=_POSITIVE,
    callback=_finite,
    metavar="HZ",
    help="In place of a time column.",
)
@click.option(
    "--calibration",
    metavar="FILE",
    help="Make forces of the gauges' readings with this file of `pmm evaluate`; none: leave the "
    "readings as they are.  [default: the one that the recording carries]",
)
@click.option(
    "--level",
    type=float,
    callback=_probability,
    metavar="P",
    default=DEFAULT_LEVEL,
    show_default=True,
    help="Probability of the intervals.",
)
@click.option("--plot", metavar="FOLDER", help="Write figures there, as SVG and PNG.")
@click.option("--save", metavar="FOLDER", help="Write the recordings there, as NetCDF.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON document instead of tables.")
def analyse(**options: Any) -> None:
    """Resolve recordings into mean and harmonics, with uncertainty.

    Each FILE is a recording (.csv, .txt, .dat, plain or .gz, or .nc) or a campaign: a folder with
    a campaign.toml and a recording per run. The phase comes from the photocell, else the encoder
    (shaft_angle), else displacement_aft, else the set-point's frequency, unless you say otherwise.

    \b
    pmm analyse run.csv --reference stroke --channel Fy
    pmm analyse campaign/ --plot plots

    Exit status: 0 done; 1 the data say no; 2 the request was wrong: an option, or the name of a
    file, folder, column or channel that cannot be. Of several, 1 if any file's data say no.
    """  # noqa: D301
    from pmm.cli.analyse_options import AnalyseOptions
    from pmm.cli.analysing import run

    run(AnalyseOptions(**options))
