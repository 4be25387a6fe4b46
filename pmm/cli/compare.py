"""``pmm compare``: two channels that show the same: gain, lag, clock rate and dead band."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from pmm.cli.options import JSON, LEVEL, PLOT

if TYPE_CHECKING:
    from analysis.recording import Recording


@click.command()
@click.argument("first", metavar="FILE[:CHANNEL]")
@click.argument("second", metavar="[FILE]:CHANNEL")
@click.option("--derivative", "order", type=int, default=0, show_default=True, metavar="N",
              help="The second is this derivative of the first; negative: the first of the second.",
              )  # fmt: skip
@click.option("--lever", "levers", multiple=True, metavar="CHANNEL",
              help="A channel beside the first that the second feels by an arm, which is found; "
              "repeatable.")  # fmt: skip
@click.option("--band", "band_hz", type=float, nargs=2, metavar="LOW HIGH",
              help="Frequencies that count, Hz.  [default: where both stand out of the noise]",
              )  # fmt: skip
@click.option("--most-lag", "most_lag_s", type=float, metavar="S",
              help="Largest lag that is looked for.  [default: 10, or a quarter of the record]",
              )  # fmt: skip
@click.option(
    "--from", "from_s", type=float, metavar="S", help="Begin here, on the second's clock."
)
@click.option("--to", "to_s", type=float, metavar="S", help="End here.")
@click.option("--map", "column_map", metavar="TOML", help="Which column of the files is what.")
@click.option("--column", "columns", multiple=True, metavar='"NAME=SOURCE[:UNIT]"',
              help="The same, one column at a time; repeatable.")  # fmt: skip
@click.option("--sample-rate", "rates_hz", type=float, multiple=True, metavar="HZ",
              help="In place of time columns; twice for two files, in their order.")  # fmt: skip
@LEVEL
@PLOT
@JSON
def compare(
    first: str,
    second: str,
    column_map: str | None,
    columns: tuple[str, ...],
    rates_hz: tuple[float, ...],
    level: float,
    plot: str | None,
    as_json: bool,
    **options: Any,
) -> None:
    """Compare two channels that show the same quantity: a camera and an accelerometer, a demand.

    The gain, the lag, how the lag grows (the clock rate) and the dead band of the second channel
    over the first, with intervals. A file with one channel needs no name behind it; the second file
    is left out where it is the first.

    \b
    pmm compare run.csv:demand :position
    pmm compare camera.csv:heave imu.csv:az --derivative 2 --plot plots
    """  # noqa: D301
    from analysis.comparison.compare import compare as compared
    from analysis.comparison.settings import ComparisonSettings
    from pmm.cli.files import check_folder
    from pmm.cli.screen import busy, show
    from pmm.document.style import write_figures
    from pmm.harmonics.pairs import read_pair
    from pmm.report.comparison_document import comparison_document

    check_folder(plot, "--plot")
    arguments = {key: value for key, value in options.items() if value is not None}
    settings = ComparisonSettings(**arguments)
    settings.check()
    with busy("reading") as progress:
        first_channel, second_channel = read_pair(
            first, second, column_map, columns, rates_hz, progress
        )
    result = compared(*first_channel, *second_channel, settings)
    document = comparison_document(result, level)
    show(document, as_json=as_json)
    if plot is not None:
        write_figures(document.figures, Path(plot), _stem(first_channel[0], second_channel[0]))


def _stem(first: "Recording", second: "Recording") -> str:
    return first.name if first.name == second.name else f"{first.name}-{second.name}"
