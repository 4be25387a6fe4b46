"""A score for programs."""

from dataclasses import asdict
from pathlib import Path
from typing import Any, Final

from tests.sealed.scoring.files import checked, read_json
from tests.sealed.scoring.score import Score

SCHEMA: Final = "sealed-score-1"


def document(score: Score) -> dict[str, Any]:
    """Return a score as a JSON document: every figure with interval, count and ceiling."""
    return {"schema": SCHEMA, **asdict(score)}


def read_document(path: Path) -> Score:
    """Read a score that was written as JSON; what stands beside it there is passed over.

    Raises
    ------
    ValueError
        With every error of the file.
    """
    return checked(Score, path, read_json(path, SCHEMA))
