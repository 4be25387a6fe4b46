"""Every command that came in: when, from where, and what became of it; a line of JSON each."""

import json
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Final

COMMANDS: Final = "commands.jsonl"


@dataclass(frozen=True)
class CommandRecord:
    """A command.

    Attributes
    ----------
    utc
        When it came, in ISO 8601.
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
