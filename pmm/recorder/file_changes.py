"""Which files of a run are not what was written: by its marker, and by their own checksums."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from hardware.description.errors import DataError
from hardware.description.flags import DAMAGED, Flag, Severity
from pmm.recorder.files import HEADER, MARKER, RECORDING, SAMPLES, TEXTS, contents_of
from pmm.recorder.line_shapes import read_marker, read_recovered
from pmm.recorder.recording import RunData, marker_is_whole

_OTHER: Final = "its bytes are not those that were written"


def changed_files(run: RunData) -> dict[str, str]:
    """Return of each file of a run that is not what was written, what is the matter, in words.

    Files are those that the marker of a closed run names, or of which a recovery made others;
    of a run that was not closed, those that carry checksums of their own.
    """
    changes = {
        name: _difference(run.folder / name, contents) for name, contents in written(run).items()
    }
    if run.samples and run.samples.changes and changes.get(SAMPLES) in (None, "", _OTHER):
        changes[SAMPLES] = "; ".join(run.samples.changes)
    if (
        run.samples
        and run.samples.is_headed
        and _differs(run.folder / HEADER, run.samples.header_text)
    ):
        changes[HEADER] = f"is not the header that {SAMPLES} carries"
    if (run.folder / MARKER).exists() and not marker_is_whole(run.marker):
        changes[MARKER] = "is not what its checksum says"
    changes[RECORDING] = recording_damage(run.folder / RECORDING)
    return {name: words for name, words in changes.items() if words}


def text_flags(folder: Path) -> tuple[Flag, ...]:
    """Return a flag for each journal of text in a closed run's folder that was changed since.

    They are short, so that whoever opens the recording may look at them as well.
    """
    contents = (read_marker(folder) or {}).get("files", {}) | files_recovered(folder)
    changes = {
        name: _difference(folder / name, contents[name]) for name in TEXTS if name in contents
    }
    return tuple(
        Flag(DAMAGED, Severity.WARNING, f"{name}: {words}")
        for name, words in changes.items()
        if words
    )


def change_flags(changed: Mapping[str, str]) -> tuple[Flag, ...]:
    """Return a flag for each changed file."""
    return tuple(
        Flag("journal_changed", Severity.WARNING, f"{name}: {words}")
        for name, words in changed.items()
    )


def written(run: RunData) -> dict[str, dict[str, Any]]:
    """Return size and hash of each file as it was written, by the run or by a recovery."""
    contents = dict(run.marker["files"]) if run.marker else {}
    return contents | files_recovered(run.folder)


def files_recovered(folder: Path) -> dict[str, dict[str, Any]]:
    """Return size and hash of each file that a recovery made in place of a damaged one."""
    return dict(read_recovered(folder).get("files", {}))


def recording_damage(path: Path) -> str:
    """Say what of a recording is not what was written; nothing where it is whole or missing."""
    from analysis.readers import read_recording
    from analysis.readers.damage import check_whole

    if not path.exists():
        return ""
    try:
        check_whole(read_recording(path))
    except DataError as error:
        return str(error)
    return ""


def _difference(path: Path, contents: Mapping[str, Any]) -> str:
    """Say what of a file is not what was written; nothing where it is whole."""
    size = path.stat().st_size if path.exists() else 0
    if not path.exists() or size < contents["bytes"]:
        return f"has {size} of {contents['bytes']} bytes; it was cut after the run"
    return "" if contents_of(path) == contents else _OTHER


def _differs(path: Path, header: str) -> bool:
    """Tell whether a header's file is there and not whole, or another one."""
    try:
        text = path.read_text(encoding="utf-8")
    except OSError:
        return False
    except UnicodeDecodeError:
        return True
    return text != header
