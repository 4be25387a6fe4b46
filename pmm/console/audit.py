"""Who did what, when: a line for each request that acts, beside the recordings, never rewritten."""

import json
from collections import deque
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Final

COMMANDS: Final = "commands.jsonl"
MOST: Final = 200  # lines that are shown


@dataclass(frozen=True)
class CommandRecord:
    """A request that acts.

    Attributes
    ----------
    utc
        When it came, in ISO 8601.
    name
        As whoever asks has given it at the login; empty without.
    role
        What their token lets them do.
    address
        Of the browser.
    session
        Its first characters: enough to tell browsers apart, too few to speak for one.
    taken
        Whether it was carried out.
    said
        The answer: what happened, or why not.
    """

    utc: str
    name: str
    role: str
    address: str
    session: str
    action: str
    given: str
    taken: bool
    said: str


def keep(folder: Path, record: CommandRecord) -> None:
    """Add a line to the folder's log.

    Raises
    ------
    OSError
        If it cannot be written.
    """
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / COMMANDS).open("a", encoding="utf-8") as file:
        file.write(json.dumps(asdict(record), ensure_ascii=False) + "\n")


def latest(folder: Path) -> list[dict[str, Any]]:
    """Return the last lines of the folder's log, from whichever console; none where there is none.

    A line that a crash has cut is left out.
    """
    try:
        with (folder / COMMANDS).open(encoding="utf-8", errors="replace") as file:
            lines = deque(file, MOST)
    except OSError:
        return []
    return [record for record in map(_read, lines) if record is not None]


def _read(line: str) -> dict[str, Any] | None:
    try:
        record = json.loads(line)
    except ValueError:
        return None
    return record if isinstance(record, dict) else None
