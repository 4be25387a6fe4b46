"""All scores so far, each kept as its own JSON: a board is scored once.

``docs/scores/<first seven digits of the seed>.json`` holds one score each, with machine, commit and
date; ``docs/scoreboard.md`` is written from all of them.
"""

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Final

from benchmarks.outcome import Verdict
from hardware.description.errors import DataError
from tests.sealed.scoring.document import SCHEMA, document, read_document
from tests.sealed.scoring.files import checked, read_json
from tests.sealed.scoring.score import Score
from tests.sealed.targets import verdicts

FOLDER: Final = "scores"
DEVELOPMENT: Final = 100  # seeds below that are for development and are never kept
_NEEDED: Final = ("date", "commit", "cpu", "cores", "python")


@dataclass(frozen=True)
class _Beside:
    made_on: Mapping[str, str]
    targets: tuple[Verdict, ...]


@dataclass(frozen=True)
class Kept:
    """One score with what it was made on.

    Attributes
    ----------
    targets
        As they were held against the limits of that day.
    """

    path: Path
    score: Score
    made_on: Mapping[str, str]
    targets: tuple[Verdict, ...]

    @property
    def name(self) -> str:
        """First digits of the commit whose hash is the seed."""
        return self.path.stem


def is_development(seed: str) -> bool:
    """Tell whether a seed (in hexadecimal, as in ``board.toml``) is one for development."""
    return int(seed, 16) < DEVELOPMENT


def place(docs: Path, seed: str) -> Path:
    """Return where the score of a seed is kept."""
    return docs / FOLDER / f"{seed.zfill(40)[:7]}.json"


def refuse_another(docs: Path, seed: str) -> None:
    """Refuse to score a seed for development, or one that was scored already.

    Raises
    ------
    DataError
        With what to do instead.
    """
    there = place(docs, seed)
    if is_development(seed):
        raise DataError(
            f"seed {int(seed, 16)} is for development: its score is not kept in {docs}; without "
            "--docs it is shown"
        )
    if there.exists():
        first = read(there)
        raise DataError(
            f"seed {there.stem} was scored on {first.made_on['date']}, {there}: a board is scored "
            "once. `python -m tests.sealed score BOARD` without --docs repeats a score and keeps "
            "nothing; a new score takes the hash of another commit"
        )


def dumped(found: Score, made_on: Mapping[str, str]) -> str:
    """Return a score with machine, commit, date and verdicts as the text of its JSON."""
    table: dict[str, Any] = {
        **document(found),
        "made_on": dict(made_on),
        "targets": [asdict(one) for one in verdicts(found)],
    }
    return json.dumps(table, indent=1, allow_nan=False) + "\n"


def keep(docs: Path, found: Score, made_on: Mapping[str, str]) -> Path:
    """Keep a score among the others; return its file.

    Raises
    ------
    DataError
        If its seed is one for development, or was scored already.
    """
    refuse_another(docs, found.seed)
    path = place(docs, found.seed)
    path.parent.mkdir(exist_ok=True)
    path.write_text(dumped(found, made_on))
    return path


def read(path: Path) -> Kept:
    """Read a score that was kept.

    Raises
    ------
    DataError
        If it is no score, or does not say when and on what it was made.
    """
    try:
        score, beside = read_document(path), checked(_Beside, path, read_json(path, SCHEMA))
    except ValueError as error:
        raise DataError(str(error)) from None
    lacks = [key for key in _NEEDED if key not in beside.made_on]
    if lacks:
        raise DataError(f"{path}: made_on lacks {', '.join(lacks)}")
    return Kept(path, score, beside.made_on, beside.targets)


def all_scores(docs: Path) -> list[Kept]:
    """Return all scores that were kept, in the order in which they were made."""
    found = [read(path) for path in sorted((docs / FOLDER).glob("*.json"))]
    return sorted(found, key=lambda one: one.made_on["date"])
