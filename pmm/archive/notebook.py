"""The notes of a campaign: lines in a file of its folder, each with time, run and author."""

import json
import os
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Final

from hardware.description.errors import ConfigurationError

NOTES_FILE: Final = "notes.jsonl"


@dataclass(frozen=True)
class NoteLine:
    """One line; the run's name is empty where it is of the campaign."""

    time_utc: str
    run: str
    author: str
    text: str


def read_notes(folder: Path) -> tuple[NoteLine, ...]:
    """Return the notes of a folder, none where there is no file.

    Raises
    ------
    ConfigurationError
        If a line is no note; the message has its number.
    """
    path = folder / NOTES_FILE
    if not path.exists():
        return ()
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except UnicodeDecodeError as error:
        raise ConfigurationError(f"{path}: no text of UTF-8: {error}") from None
    return tuple(_note(line, f"{path}:{n}") for n, line in enumerate(lines, 1) if line.strip())


def _note(line: str, place: str) -> NoteLine:
    try:
        table: Any = json.loads(line)
        note = NoteLine(**table)
    except (ValueError, TypeError):
        note = None
    if note is None or not all(isinstance(value, str) for value in asdict(note).values()):
        raise ConfigurationError(
            f"{place}: no note; a line has time_utc, run, author and text, as JSON"
        )
    return note


def write_note(folder: Path, note: NoteLine) -> None:
    """Append a note to the file of a folder.

    Raises
    ------
    ConfigurationError
        If the text is empty or more than one line.
    """
    for name, text in (("note", note.text), ("author", note.author)):
        if not text.strip() or not text.isprintable():
            raise ConfigurationError(f"{name} {text!r}: write one line of printable text")
    read_notes(folder)
    path = folder / NOTES_FILE
    line = json.dumps(asdict(note), ensure_ascii=False) + "\n"
    with path.open("ab+") as file:
        if file.tell() and not _ends_line(path):
            line = "\n" + line
        file.write(line.encode())
        file.flush()
        os.fsync(file.fileno())


def _ends_line(path: Path) -> bool:
    with path.open("rb") as file:
        file.seek(-1, os.SEEK_END)
        return file.read() == b"\n"
