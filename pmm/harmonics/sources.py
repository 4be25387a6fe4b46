"""From files that are named to recordings."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from hardware.description.errors import ConfigurationError, DataError
from pmm.campaign.campaign import Campaign
from pmm.campaign.campaign_file import read_campaign
from pmm.campaign.file_names import CAMPAIGN_FILE
from pmm.campaign.recording_source import RAW, RecordingSource, open_recording
from pmm.recorder.files import RECORDING
from pmm.remote import local_path

if TYPE_CHECKING:
    from analysis.readers import ColumnMap
    from analysis.readers.text_source import Progress
    from analysis.recording import Recording


@dataclass(frozen=True)
class Source:
    """One recording to be read, with what its campaign says of it.

    Attributes
    ----------
    campaign, campaign_path
        What its campaign file says, and where that lies; ``None`` for a file of its own.
    """

    recording: RecordingSource
    campaign: Campaign | None = None
    campaign_path: Path | None = None

    @property
    def as_recorded(self) -> Campaign | None:
        """The campaign with the tables that the run was recorded with."""
        return self.campaign and self.campaign.as_recorded(self.recording.name or "")

    @property
    def path(self) -> Path:
        """Where the recording lies."""
        return self.recording.path

    @property
    def stem(self) -> str:
        """The file's name without its endings; its folder's, where run control has put it."""
        if self.path.name == RECORDING:
            return self.path.parent.name
        return Path(self.path.name.removesuffix(".gz")).stem


@dataclass(frozen=True)
class SourceList:
    """The recordings that a command's arguments name.

    Attributes
    ----------
    not_recorded
        Where the recordings of a campaign's other runs would lie; they are not there yet.
    """

    sources: tuple[Source, ...] = ()
    not_recorded: tuple[Path, ...] = ()

    def __add__(self, other: "SourceList") -> "SourceList":
        """Return both."""
        return SourceList(self.sources + other.sources, self.not_recorded + other.not_recorded)


def find_sources(paths: Sequence[str]) -> SourceList:
    """Return the recordings that are meant; a campaign stands for those of all its runs.

    Raises
    ------
    DataError
        For a campaign without any recording.
    ConfigurationError
        If a campaign file is wrong, or a folder has none; or as :func:`pmm.remote.local_path`.
    """
    return sum((_find(local_path(path)) for path in paths), SourceList())


def _find(path: Path) -> SourceList:
    if path.is_dir():
        if not (path / CAMPAIGN_FILE).exists():
            raise ConfigurationError(
                f"{path}: a folder without a {CAMPAIGN_FILE}; name the recordings in it, "
                "or write one (docs/campaigns.md)"
            )
        path = path / CAMPAIGN_FILE
    if path.suffix != ".toml":
        return SourceList((Source(RecordingSource(path)),))
    return _find_in_campaign(path)


def _find_in_campaign(path: Path) -> SourceList:
    campaign = read_campaign(path)
    if not campaign.runs:
        raise ConfigurationError(f"{path}: the campaign has no runs; add a table [[runs]] for each")
    sources, not_recorded = [], []
    for run in campaign.runs:
        recording = run.recording_path(path.parent)
        if run.file is None and not recording.exists():
            not_recorded.append(recording)
        else:
            run_source = RecordingSource.of(campaign, run, path.parent)
            sources.append(Source(run_source, campaign, path))
    if not sources:
        raise DataError(
            f"{path}: none of its {len(campaign.runs)} runs is recorded yet; the first would be "
            f"{not_recorded[0]}"
        )
    return SourceList(tuple(sources), tuple(not_recorded))


def read_source(
    source: Source,
    columns: "ColumnMap | None" = None,
    *,
    sample_rate_hz: float | None = None,
    edges: str | None = None,
    calibration: str | None = None,
    progress: "Progress" = lambda _: None,
) -> "Recording":
    """Read one recording.

    Parameters
    ----------
    columns
        In place of the campaign's own column map.
    edges
        File of the photocell's edge times; ``{stem}`` in it stands for the recording's name.
    calibration
        File of the gauges' calibration; :data:`pmm.campaign.recording_source.RAW` for none; by
        default the recording's own.
    progress
        Told which part of a text file has been read, from 0 to 1.

    Raises
    ------
    DataError, ConfigurationError
        As :func:`pmm.campaign.recording_source.open_recording` does.
    """
    from pmm.campaign.calibration import read_calibration

    recording_source = replace(source.recording, sample_rate_hz=sample_rate_hz)
    if columns is not None:
        recording_source = replace(recording_source, columns=columns)
    if edges is not None:
        recording_source = replace(
            recording_source, edges_file=Path(edges.replace("{stem}", source.stem))
        )
    if calibration is not None:
        gauge_calibration = RAW if calibration == RAW else read_calibration(Path(calibration))
        recording_source = replace(recording_source, calibration=gauge_calibration)
    return open_recording(recording_source, partial=True, progress=progress)
