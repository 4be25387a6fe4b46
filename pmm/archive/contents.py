"""What a campaign's folder holds: set-points, the files with their hashes, notes."""

import hashlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Final

from hardware.description.errors import ConfigurationError, DataError
from pmm.archive.notebook import NOTES_FILE, NoteLine, read_notes
from pmm.campaign.campaign import Campaign
from pmm.campaign.campaign_file import read_campaign
from pmm.campaign.file_names import CAMPAIGN_FILE
from pmm.campaign.runs import AtRest, Run
from pmm.recorder.files import sha256
from pmm.remote import local_path

_SETTINGS: Final = ("coefficients.toml",)  # beside the campaign's file, read by its analysis


@dataclass(frozen=True)
class Stamp:
    """A file as it was seen: size, time of its last change, and hash."""

    size: int
    mtime_ns: int
    sha256: str

    def fits(self, path: Path) -> bool:
        """Whether size and time are still those of a file."""
        status = path.stat()
        return (self.size, self.mtime_ns) == (status.st_size, status.st_mtime_ns)


@dataclass(frozen=True)
class Contents:
    """A campaign's folder, read.

    Attributes
    ----------
    stamps
        By the file's path, relative to the folder where it lies in it.
    """

    folder: Path
    campaign: Campaign
    stamps: Mapping[str, Stamp]
    notes: tuple[NoteLine, ...]

    @property
    def records(self) -> tuple[Run | AtRest, ...]:
        """Runs and records at rest."""
        return records_of(self.campaign)

    @property
    def sha256(self) -> str:
        """One hash of all files that results rest on; notes are not among them."""
        lines = (
            f"{stamp.sha256} {name}\n"
            for name, stamp in sorted(self.stamps.items())
            if name != NOTES_FILE
        )
        return hashlib.sha256("".join(lines).encode()).hexdigest()

    def recording(self, run: Run | AtRest) -> str | None:
        """Return where a run's recording lies; ``None`` where there is none yet."""
        name = relative(run.recording_path(self.folder), self.folder)
        return name if name in self.stamps else None


def read_contents(folder: Path, last_stamps: Mapping[str, Stamp]) -> Contents:
    """Read a folder; a file whose size and time are known is not read again for its hash.

    Raises
    ------
    ConfigurationError
        If it is no campaign's folder, or its campaign file or notes are wrong.
    """
    if not (folder / CAMPAIGN_FILE).is_file():
        raise ConfigurationError(f"{folder}: no folder with a {CAMPAIGN_FILE}")
    campaign = read_campaign(folder / CAMPAIGN_FILE)
    stamps = {
        name: stamp(path, last_stamps.get(name))
        for path in _files(folder, campaign)
        if path.is_file()
        for name in (relative(path, folder),)
    }
    return Contents(folder, campaign, stamps, read_notes(folder))


def records_of(campaign: Campaign) -> tuple[Run | AtRest, ...]:
    """Return a campaign's runs and records at rest."""
    return (*campaign.runs, *campaign.at_rest)


def _files(folder: Path, campaign: Campaign) -> Iterator[Path]:
    for name in (CAMPAIGN_FILE, NOTES_FILE, *_SETTINGS):
        yield folder / name
    if campaign.radiation is not None:
        yield Path(campaign.radiation.file)
    for record in records_of(campaign):
        yield record.recording_path(folder)


def stamp(path: Path, last_stamp: Stamp | None = None) -> Stamp:
    """Return a file's stamp; the known one, without a look at its bytes, where it still fits."""
    if last_stamp is not None and last_stamp.fits(path):
        return last_stamp
    status = path.stat()
    return Stamp(status.st_size, status.st_mtime_ns, sha256(path))


def relative(path: Path, folder: Path) -> str:
    """Return a file's path relative to a folder, where it lies in it."""
    return path.relative_to(folder).as_posix() if path.is_relative_to(folder) else str(path)


def changes(folder: Path, last_stamps: Mapping[str, Stamp]) -> tuple[str, ...]:
    """Say what of a folder is not as it was seen; a hash is taken only where size or time differ.

    Recordings that are new are not looked for: a run that gets its first is not yet among
    ``last_stamps`` and is found when the folder is added again.
    """
    try:
        local_path(folder)
    except ConfigurationError:
        return ("the folder vanished",)
    except DataError as error:
        return (str(error),)
    if not folder.is_dir():
        return ("the folder vanished",)
    return tuple(_changes(folder, last_stamps))


def _changes(folder: Path, last_stamps: Mapping[str, Stamp]) -> Iterator[str]:
    for name, last_stamp in sorted(last_stamps.items()):
        path = folder / name
        if not path.is_file():
            yield f"{name} vanished"
        elif not last_stamp.fits(path) and sha256(path) != last_stamp.sha256:
            yield f"{name} changed"


def recorded_utc(path: Path) -> str:
    """Return when a recording began, as it says itself; else when its file was last changed."""
    return _started(path) or datetime.fromtimestamp(path.stat().st_mtime, UTC).isoformat()


def _started(path: Path) -> str:
    if path.suffix != ".nc":
        return ""
    import h5py

    try:
        with h5py.File(path) as file:
            return str(file.attrs.get("started_utc", ""))
    except OSError:  # a NetCDF of another kind
        return ""
