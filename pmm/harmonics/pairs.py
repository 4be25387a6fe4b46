"""From two names on a command line to two channels of recordings."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from analysis.readers.columns_options import parse_options
from analysis.readers.columns_toml import read_column_map
from hardware.description.errors import ConfigurationError
from pmm.campaign.recording_source import RecordingSource, open_recording

if TYPE_CHECKING:
    from analysis.readers import ColumnMap
    from analysis.readers.text_source import Progress
    from analysis.recording import Recording


@dataclass(frozen=True)
class NamedChannel:
    """``FILE:CHANNEL``; the file is ``None`` where it is left out, so is the channel."""

    file: Path | None
    channel: str | None

    @classmethod
    def parse(cls, text: str) -> "NamedChannel":
        """Take a text apart; a file of that whole name goes before a colon in it."""
        if Path(text).exists():
            return cls(Path(text), None)
        file, colon, channel = text.rpartition(":")
        if not colon or channel.startswith("//"):  # the colon of a URL
            return cls(Path(text), None)
        return cls(Path(file) if file else None, channel or None)


def read_pair(
    first: str,
    second: str,
    column_map: str | None,
    columns: Sequence[str],
    rates_hz: Sequence[float],
    progress: "Progress" = lambda _: None,
) -> "tuple[tuple[Recording, str], tuple[Recording, str]]":
    """Return two recordings, each with the name of a channel.

    Raises
    ------
    DataError, ConfigurationError
        As :func:`pmm.campaign.recording_source.open_recording`; or no channel is named where a file
        has several, no file is named first, both are one channel, or options contradict each other.
    """
    first_channel, second_channel = NamedChannel.parse(first), NamedChannel.parse(second)
    if first_channel.file is None:
        raise ConfigurationError(f"{first}: name the file of the first channel: FILE:CHANNEL")
    if column_map and columns:
        raise ConfigurationError("give --map or --column, not both")
    if len(rates_hz) > 2:
        raise ConfigurationError(f"{len(rates_hz)} sample rates for two files; give one or two")
    channel_map = parse_options(columns) if columns else None
    channel_map = read_column_map(column_map) if column_map else channel_map
    rates = (rates_hz[0], rates_hz[-1]) if rates_hz else (None, None)
    first_recording = _read(first_channel.file, channel_map, rates[0], progress)
    same_file = second_channel.file is None or second_channel.file == first_channel.file
    second_recording = (
        first_recording
        if same_file
        else _read(second_channel.file or first_channel.file, channel_map, rates[1], progress)
    )
    pair = (
        (first_recording, _channel(first_recording, first_channel)),
        (second_recording, _channel(second_recording, second_channel)),
    )
    if same_file and pair[0][1] == pair[1][1]:
        raise ConfigurationError(f"{first} and {second} are one channel; name two")
    return pair


def _read(
    path: Path, columns: "ColumnMap | None", rate_hz: float | None, progress: "Progress"
) -> "Recording":
    source = RecordingSource(path, columns=columns, sample_rate_hz=rate_hz)
    return open_recording(source, partial=True, progress=progress)


def _channel(recording: "Recording", named_channel: NamedChannel) -> str:
    if named_channel.channel is not None:
        recording.index(named_channel.channel)
        return named_channel.channel
    names = recording.channel_names
    if len(names) > 1:
        raise ConfigurationError(
            f"{recording.name} has {len(names)} channels; name one behind a colon: "
            f"{', '.join(names)}"
        )
    return names[0]
