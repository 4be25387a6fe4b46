"""What ``pmm analyse`` does: read, resolve, then print, plot and save."""

import json
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from analysis.readers import write_recording
from analysis.resolver.analysis import analyse
from analysis.resolver.reference import NoReferenceError
from analysis.resolver.reference_choice import ReferenceChoice
from analysis.resolver.settings import ResolverSettings
from analysis.threads import cores
from hardware.description.errors import ConfigurationError, DataError, PmmError
from pmm.cli.analyse_options import AnalyseOptions
from pmm.cli.file_notices import tell_damaged, tell_unchecked
from pmm.cli.folders import check_folder
from pmm.cli.hints import COLUMN_LEFT_OUT, NO_REFERENCE
from pmm.cli.inputs import Found, Source, chosen_columns, find_sources, read_source
from pmm.cli.printing import print_run
from pmm.cli.screen import busy, error_line, messages, output, print_flags
from pmm.document.data import plain
from pmm.document.run_rows import RunRows, run_rows
from pmm.parallel import open_executor

if TYPE_CHECKING:
    from analysis.plausibility import RunHarmonics
    from analysis.readers import ColumnMap
    from analysis.readers.text_source import Progress
    from analysis.recording import Recording
    from hardware.description.flags import Flag

JSON_SCHEMA = "pmm-analysis-1"


@dataclass(frozen=True)
class Analysed:
    """A recording's rows, and what the checks across its campaign need of it."""

    source: Source
    rows: RunRows
    seen: "RunHarmonics | None"


@dataclass(frozen=True)
class Failure:
    """A file that could not be analysed, why, and what was noticed when it was read."""

    file: str
    message: str
    exit_status: int
    flags: "tuple[Flag, ...]" = ()


def run(request: AnalyseOptions) -> None:
    """Analyse all files, each printed when it is done; what fails does not stop the others.

    Raises
    ------
    DataError, ConfigurationError
        If the request itself is wrong. A file's own error ends up in the exit status.
    """
    found = find_sources(request.files)
    _check(request, found)
    columns = chosen_columns(request.column_map, request.columns)
    done: list[Analysed] = []
    failed: list[Failure] = []
    for one in _each(found.sources, request, columns):
        if isinstance(one, Failure):
            failed.append(one)
            _report(one)
            continue
        done.append(one)
        if not request.as_json:
            print_run(output(), one.rows, request.level)
    doubts = list(_doubts(done))
    if request.as_json:
        text = document([one.rows for one in done], failed, found, request.level, doubts)
        click.echo(json.dumps(text, indent=1, allow_nan=False))
    else:
        _print_doubts(doubts)
    for path in found.not_recorded:
        messages().print(f"not recorded yet: {path}")
    tell_unchecked(one.source.path for one in done)
    statuses = tell_damaged((one.rows.file, one.rows.flags) for one in done)
    if statuses := statuses + [failure.exit_status for failure in failed]:
        click.get_current_context().exit(min(statuses))


def _each(
    sources: Sequence[Source], request: AnalyseOptions, columns: "ColumnMap | None"
) -> Iterator[Analysed | Failure]:
    """Analyse one run after the other; said on a terminal while it lasts.

    Figures take a hundred times as long as the numbers, so several runs' are drawn by a process
    for each core.
    """
    doing, jobs = "analysing", 1
    if request.plot is not None:
        doing, jobs = "analysing and plotting", min(cores(), len(sources))
    with open_executor(max(1, jobs)) as executor:
        # Of the run at hand; another process has no screen.
        shown: list[Callable[[float], None]] = [_untold]
        tell = _untold if jobs > 1 else lambda part: shown[-1](part)
        work = partial(_try_source, request=request, columns=columns, progress=tell)
        results = executor.map(work, sources)
        for number, source in enumerate(sources, 1):
            with busy(f"{doing} {source.stem}, {number} of {len(sources)}") as told:
                shown.append(told)
                one = next(results)
            yield one


def _check(request: AnalyseOptions, found: Found) -> None:
    ways = {
        "--reference": request.reference,
        "--frequency": request.frequency,
        "--edges": request.edges,
    }
    given = [name for name, value in ways.items() if value is not None]
    if len(given) > 1:
        raise ConfigurationError(f"give one reference, not {' and '.join(given)}")
    if request.edges and len(found.sources) > 1 and "{stem}" not in request.edges:
        raise ConfigurationError(
            f"--edges {request.edges}: one file of edges for several recordings; put {{stem}} "
            "where the recording's name stands in the names of their edge files"
        )
    if request.bandwidth is not None and request.carrier is None:
        raise ConfigurationError("--bandwidth belongs to --carrier; give both or neither")
    for option, folder in (("--plot", request.plot), ("--save", request.save)):
        if folder:
            _check_names(found)
            check_folder(Path(folder), option)
    if request.save:
        _check_not_there(Path(request.save), found)


def _check_names(found: Found) -> None:
    stems = [source.stem for source in found.sources]
    twice = next((stem for stem in stems if stems.count(stem) > 1), None)
    if twice is not None:
        raise ConfigurationError(
            f"several recordings are called {twice!r}, and what is written of them would be too; "
            "use a folder for each with --plot and --save"
        )


def _check_not_there(folder: Path, found: Found) -> None:
    there = [folder / f"{source.stem}.nc" for source in found.sources]
    there = [path for path in there if path.exists()]
    if there:
        names = ", ".join(map(str, there))
        raise ConfigurationError(f"{names}: exists already; --save to another folder")


def _doubts(done: "Sequence[Analysed]") -> "Iterator[tuple[Path, tuple[Flag, ...]]]":
    """Say of each campaign which units and signs look wrong in all its runs."""
    from pmm.campaign.plausibility import implausible

    sources = {one.source.campaign_path: one.source for one in done}
    for path, source in sources.items():
        campaign = source.campaign
        if path is None or campaign is None:
            continue
        seen = [one.seen for one in done if one.source.campaign_path == path and one.seen]
        if flags := implausible(campaign, seen):
            yield path, flags


def _print_doubts(doubts: "Sequence[tuple[Path, tuple[Flag, ...]]]") -> None:
    for path, flags in doubts:
        output().print(f"all runs of {path}", soft_wrap=True)
        print_flags(output(), flags)


def _untold(_part: float) -> None:
    """Tell nobody how far it is."""


def _try_source(
    source: Source, request: AnalyseOptions, columns: "ColumnMap | None", progress: "Progress"
) -> Analysed | Failure:
    """Read and analyse one recording; what the reader noticed is kept whatever happens then."""
    flags: tuple[Flag, ...] = ()
    try:
        recording = read_source(
            source,
            columns,
            sample_rate_hz=request.sample_rate,
            edges=request.edges,
            calibration=request.calibration,
            progress=progress,
        )
        flags = recording.flags
        return _analyse_recording(recording, source, request, columns)
    except PmmError as error:
        hint = f" ({NO_REFERENCE})" if isinstance(error, NoReferenceError) else ""
        return Failure(str(source.path), f"{error}{hint}", error.exit_status, flags)


def _analyse_recording(
    recording: "Recording", source: Source, request: AnalyseOptions, columns: "ColumnMap | None"
) -> Analysed:
    from analysis.resolver.first_harmonics import first_harmonics

    campaign = source.as_recorded
    choice = request.choice(campaign.reference if campaign else ReferenceChoice())
    settings = request.settings(campaign.analysis if campaign else ResolverSettings())
    _check_channels(recording, (*settings.channels, choice.channel), columns)
    if request.save is not None:
        folder = Path(request.save)
        folder.mkdir(parents=True, exist_ok=True)
        write_recording(recording, folder / f"{source.stem}.nc")
    if request.carrier is not None:
        recording = _detected(recording, settings.channels, request.carrier, request.bandwidth)
    analysis = analyse(recording, choice, settings)
    if request.plot is not None:
        from pmm.document.style import write_figures
        from pmm.report.plots import figures

        write_figures(figures(analysis), Path(request.plot), source.stem)
    rows = run_rows(
        analysis,
        file=str(source.path),
        level=request.level,
        vibrations_hz=request.let_through,
        classic=request.classic,
    )
    return Analysed(source, rows, first_harmonics(recording, analysis) if campaign else None)


def _check_channels(
    recording: "Recording", names: Sequence[str | None], columns: "ColumnMap | None"
) -> None:
    """Refuse channels that are named and not there: that is the request's fault."""
    for name in names:
        try:
            recording.index(name) if name is not None else None
        except DataError as error:
            left_out = columns is not None and columns.channels and not columns.keep_others
            hint = COLUMN_LEFT_OUT if left_out else ""
            raise ConfigurationError(f"{error}{hint}") from None


def _detected(
    recording: "Recording",
    channels: Sequence[str],
    carrier_hz: float,
    bandwidth_hz: float | None,
) -> "Recording":
    """Take channels off their carrier, the optional first stage of the resolver."""
    from analysis.resolver.carrier import demodulate

    if not channels:
        raise ConfigurationError("--carrier: say with --channel which channels ride on it")
    bandwidth = {} if bandwidth_hz is None else {"bandwidth_hz": bandwidth_hz}
    return demodulate(recording, channels, carrier_hz, **bandwidth)


def _report(failure: Failure) -> None:
    print_flags(messages(), failure.flags)
    error_line(_with_file(failure))


def _with_file(failure: Failure) -> str:
    named = Path(failure.file).name in failure.message
    return failure.message if named else f"{failure.file}: {failure.message}"


def document(
    done: list[RunRows],
    failed: list[Failure],
    found: Found,
    level: float,
    doubts: "Sequence[tuple[Path, tuple[Flag, ...]]]" = (),
) -> dict[str, Any]:
    """Return what ``--json`` prints; ``docs/campaigns.md`` describes it."""
    text: dict[str, Any] = plain(
        {
            "schema": JSON_SCHEMA,
            "level": level,
            "runs": done,
            "campaigns": [{"file": str(path), "flags": flags} for path, flags in doubts],
            "not_recorded": [str(path) for path in found.not_recorded],
            "failed": [
                {"file": one.file, "message": one.message, "flags": one.flags} for one in failed
            ],
        }
    )
    return text
