"""A score for programs."""

from dataclasses import asdict
from typing import Any, Final

from pmm.gap.scoring.score import Score

SCHEMA: Final = "sealed-score-1"


def document(score: Score) -> dict[str, Any]:
    """Return a score as a JSON document: every figure with interval, count and ceiling."""
    return {"schema": SCHEMA, **asdict(score)}
