"""``pmm analyse``: recordings in, harmonics with their intervals out."""

import math
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from pmm.cli.options import JSON, LEVEL, PLOT

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from analysis.resolver.analysis import Analysis
    from pmm.harmonics.request import HarmonicsRequest
    from pmm.harmonics.resolving import Failure, Resolved
    from pmm.harmonics.sources import Source

_COUNT = click.IntRange(min=1)


class _Finite(click.FloatRange):
    """A number that is no infinity and not NaN; positive unless it may be any."""

    def __init__(self, *, positive: bool = True) -> None:
        super().__init__(min=0.0 if positive else None, min_open=positive)

    def _describe_range(self) -> str:
        return "" if self.min is None else super()._describe_range()

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the number."""
        number = super().convert(value, param, ctx)
        if not math.isfinite(number):
            self.fail(f"{number} is not a finite number.", param, ctx)
        return number


_ANY, _POSITIVE = _Finite(positive=False), _Finite()


@click.command()
@click.argument("files", nargs=-1, required=True, metavar="FILE...")
@click.option("--reference", metavar="CHANNEL", help="Take the phase from this channel.")
@click.option("--frequency", type=_POSITIVE, metavar="HZ", help="Take a known frequency.")
@click.option("--edges", metavar="FILE", help="Times of the photocell's edges, a column of text.")
@click.option("--latency", type=_ANY, metavar="S", help="Delay of the photocell's pulses.")
@click.option(
    "--angle-offset",
    type=_ANY,
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
    type=_ANY,
    metavar="S",
    help="Open the first gate at this time.  [default: where the run is steady]",
)
@click.option("--periods", type=_COUNT, metavar="M", help="Periods to use after --opens-at.")
@click.option(
    "--steady-tolerance",
    type=_POSITIVE,
    metavar="X",
    help="How far first harmonics may stray in a steady stretch, relative.  [default: 0.05]",
)
@click.option(
    "--delay",
    "delays",
    multiple=True,
    metavar="CHANNEL=S",
    help="Open a channel's gates so much later than the reference's, for waves that travel from "
    "one to the other: seconds, or METRES/GROUP_VELOCITY; repeatable.",
)
@click.option(
    "--let-through",
    type=_POSITIVE,
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
    metavar="HZ",
    help="Detect the channels given with --channel from a carrier first.",
)
@click.option(
    "--bandwidth",
    type=_POSITIVE,
    metavar="HZ",
    help="Keep signals up to here of those on a carrier.  [default: 50]",
)
@click.option("--hann", is_flag=True, help="Taper each gate: for long gates with interference.")
@click.option(
    "--local-polynomials",
    is_flag=True,
    help="Take what a transient leaks off each harmonic: for runs that had not settled.",
)
@click.option(
    "--response-to",
    metavar="CHANNEL",
    help="Tell how the other channels of the first gate respond to this one at its lines, and how "
    "much stands between them: with --harmonics up to the highest line.",
)
@click.option(
    "--line",
    "lines",
    type=_COUNT,
    multiple=True,
    metavar="N",
    help="A harmonic that --response-to was given; repeatable.  [default: those where it moves]",
)
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
    metavar="HZ",
    help="In place of a time column.",
)
@click.option(
    "--calibration",
    metavar="FILE",
    help="Make forces of the gauges' readings with this file of `pmm evaluate`; none: leave the "
    "readings as they are.  [default: the one that the recording carries]",
)
@LEVEL
@PLOT
@click.option("--save", metavar="FOLDER", help="Write the recordings there, as NetCDF.")
@JSON
def analyse(files: tuple[str, ...], plot: str | None, as_json: bool, **options: Any) -> None:
    """Resolve recordings into mean and harmonics, with uncertainty.

    Each FILE is a recording (.csv, .txt, .dat, plain or .gz, or .nc) or a campaign: a folder with
    a campaign.toml and a recording per run. The phase comes from the photocell, else the encoder
    (shaft_angle), else displacement_aft or _fore, else the set-point's frequency, unless you say
    otherwise.

    \b
    pmm analyse run.csv --reference stroke --channel Fy
    pmm analyse campaign/ --plot plots

    Exit status: 0 done; 1 the data say no; 2 the request was wrong: an option, or the name of a
    file, folder, column or channel that cannot be. Of several, 1 if any file's data say no.
    """  # noqa: D301
    from pmm.cli.files import tell_damaged, tell_unchecked, tell_writers
    from pmm.cli.screen import messages, output
    from pmm.document.data import as_json as as_text
    from pmm.document.terminal import print_section
    from pmm.harmonics.request import HarmonicsRequest
    from pmm.harmonics.resolving import Failure, doubts
    from pmm.harmonics.sources import find_sources
    from pmm.report.harmonics_document import analysis_document, doubt_section, run_section

    request = HarmonicsRequest(**options)
    tell_writers(path for path in map(Path, files) if path.is_dir() or path.suffix == ".toml")
    selection = find_sources(files)
    _check(selection.sources, request, plot)
    resolved: list[Resolved] = []
    failures: list[Failure] = []
    for outcome in _resolve_each(selection.sources, request, plot):
        if isinstance(outcome, Failure):
            failures.append(outcome)
            _tell(outcome)
            continue
        resolved.append(outcome)
        if not as_json:
            print_section(output(), run_section(outcome.rows, request.level))
    flagged_files, rows = tuple(doubts(resolved)), [run.rows for run in resolved]
    if as_json:
        document = analysis_document(
            rows, failures, selection.not_recorded, flagged_files, request.level
        )
        click.echo(as_text(document))
    for path, flags in () if as_json else flagged_files:
        print_section(output(), doubt_section(path, flags))
    for path in selection.not_recorded:
        messages().print(f"not recorded yet: {path}")
    tell_unchecked(run.source.path for run in resolved)
    statuses = tell_damaged((run.file, run.flags) for run in rows)
    if statuses := statuses + [failure.exit_status for failure in failures]:
        click.get_current_context().exit(min(statuses))


def _resolve_each(
    sources: "Sequence[Source]", request: "HarmonicsRequest", plot: str | None
) -> "Iterator[Resolved | Failure]":
    """Resolve one run after the other; said on a terminal while it lasts.

    Figures take a hundred times as long as the numbers, so several runs' are drawn by a process
    for each core.
    """
    from analysis.threads import cores
    from pmm.cli.screen import busy
    from pmm.harmonics.resolving import resolve, untold
    from pmm.parallel import open_executor

    activity, jobs, draw = "analysing", 1, None
    if plot is not None:
        activity, jobs = "analysing and plotting", min(cores(), len(sources))
        draw = partial(_draw, Path(plot), request)
    with open_executor(max(1, jobs)) as executor:
        # Of the run at hand; another process has no screen.
        displays: list[Callable[[float], None]] = [untold]
        tell = untold if jobs > 1 else lambda part: displays[-1](part)
        columns = request.chosen_columns()
        work = partial(resolve, request=request, columns=columns, draw=draw, progress=tell)
        results = executor.map(work, sources)
        for number, source in enumerate(sources, 1):
            with busy(f"{activity} {source.stem}, {number} of {len(sources)}") as display:
                displays.append(display)
                outcome = next(results)
            yield outcome


def _draw(folder: Path, request: "HarmonicsRequest", analysis: "Analysis", name: str) -> None:
    from pmm.document.style import write_figures
    from pmm.report.plots import figures

    write_figures(figures(analysis, request.response_to, request.lines), folder, name)


def _check(sources: "Sequence[Source]", request: "HarmonicsRequest", plot: str | None) -> None:
    """Refuse what is asked before anything is read, and where it would be written."""
    from hardware.description.errors import ConfigurationError
    from pmm.cli.files import check_folder

    request.check(sources)
    stems = [source.stem for source in sources]
    for option, folder in (("--plot", plot), ("--save", request.save)):
        if folder is None:
            continue
        if twice := next((stem for stem in stems if stems.count(stem) > 1), None):
            raise ConfigurationError(
                f"several recordings are called {twice!r}, and what is written of them would be "
                "too; use a folder for each with --plot and --save"
            )
        check_folder(Path(folder), option)


def _tell(failure: "Failure") -> None:
    from pmm.cli.screen import error_line, messages
    from pmm.document.terminal import print_content
    from pmm.report.harmonics_tables import noticed

    print_content(noticed(failure.flags), messages())
    error_line(failure.full_message)
