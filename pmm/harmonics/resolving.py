"""One recording is read and resolved; what fails is said and stops no other."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

from analysis.readers import write_recording
from analysis.resolver.analysis import Analysis
from analysis.resolver.first_harmonics import first_harmonics
from analysis.resolver.reference import NoReferenceError
from analysis.resolver.reference_choice import ReferenceChoice
from analysis.resolver.settings import ResolverSettings
from analysis.resolver.windows import analyse_windows
from hardware.description.errors import ConfigurationError, DataError, PmmError
from hardware.description.flags import Flag
from pmm.campaign.plausibility import implausible
from pmm.harmonics.request import HarmonicsRequest
from pmm.harmonics.rows import RunRows, run_rows
from pmm.harmonics.sources import Source, read_source

if TYPE_CHECKING:
    from analysis.readers import ColumnMap
    from analysis.readers.text_source import Progress
    from analysis.recording import Recording
    from analysis.run_harmonics import RunHarmonics

_NO_REFERENCE: Final = "--frequency HZ, --reference CHANNEL"
_COLUMN_LEFT_OUT: Final = (
    "; a column of the file that is not in the column map is not read: add it there or with "
    "--column, or say keep_others = true in the map"
)
Draw = Callable[[Analysis, str], object]


@dataclass(frozen=True)
class Resolved:
    """A recording's rows, and what the checks across its campaign need of it."""

    source: Source
    rows: RunRows
    run_harmonics: "RunHarmonics | None"


@dataclass(frozen=True)
class Failure:
    """A file that could not be resolved, why, and what was noticed when it was read."""

    file: str
    message: str
    exit_status: int
    flags: tuple[Flag, ...] = ()

    @property
    def full_message(self) -> str:
        """The message, with the file's name."""
        is_named = Path(self.file).name in self.message
        return self.message if is_named else f"{self.file}: {self.message}"


def untold(_part: float) -> None:
    """Take how much is done, from 0 to 1, and show nothing."""


def resolve(
    source: Source,
    request: HarmonicsRequest,
    columns: "ColumnMap | None",
    draw: Draw | None,
    progress: "Progress" = untold,
) -> Resolved | Failure:
    """Read and resolve one recording; what the reader noticed is kept whatever happens then.

    Parameters
    ----------
    columns
        The request's column map.
    draw
        Writes the figures of an analysis under a recording's name.
    """
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
        return _resolved(recording, source, request, columns, draw)
    except PmmError as error:
        hint = f" ({_NO_REFERENCE})" if isinstance(error, NoReferenceError) else ""
        return Failure(str(source.path), f"{error}{hint}", error.exit_status, flags)


def _resolved(
    recording: "Recording",
    source: Source,
    request: HarmonicsRequest,
    columns: "ColumnMap | None",
    draw: Draw | None,
) -> Resolved:
    campaign = source.as_recorded
    choice = request.choice(campaign.reference if campaign else ReferenceChoice())
    settings = request.settings(campaign.analysis if campaign else ResolverSettings())
    delays_s = request.delays_s()
    channels = (*settings.channels, choice.channel, request.response_to, *delays_s)
    _check_channels(recording, channels, columns)
    if request.save is not None:
        folder = Path(request.save)
        folder.mkdir(parents=True, exist_ok=True)
        write_recording(recording, folder / f"{source.stem}.nc")
    if request.carrier is not None:
        recording = _detected(recording, settings.channels, request.carrier, request.bandwidth)
    analyses = analyse_windows(recording, choice, settings, delays_s)
    if draw is not None:
        draw(analyses[0], source.stem)
        for analysis in analyses[1:]:
            draw(analysis, f"{source.stem}-{analysis.recording.channel_names[0]}")
    rows = run_rows(
        analyses,
        file=str(source.path),
        level=request.level,
        vibrations_hz=request.let_through,
        classic=request.classic,
        response_to=request.response_to,
        lines=request.lines,
    )
    return Resolved(source, rows, first_harmonics(recording, analyses[0]) if campaign else None)


def _check_channels(
    recording: "Recording", names: Sequence[str | None], columns: "ColumnMap | None"
) -> None:
    """Refuse channels that are named and not there: that is the request's fault."""
    for name in names:
        try:
            recording.index(name) if name is not None else None
        except DataError as error:
            left_out = columns is not None and columns.channels and not columns.keep_others
            hint = _COLUMN_LEFT_OUT if left_out else ""
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


def doubts(resolved: Sequence[Resolved]) -> Iterator[tuple[Path, tuple[Flag, ...]]]:
    """Yield for each campaign which units and signs look wrong in all its runs."""
    sources = {run.source.campaign_path: run.source for run in resolved}
    for path, source in sources.items():
        campaign = source.campaign
        if path is None or campaign is None:
            continue
        harmonics = [
            run.run_harmonics
            for run in resolved
            if run.source.campaign_path == path and run.run_harmonics
        ]
        if flags := implausible(campaign, harmonics):
            yield path, flags
