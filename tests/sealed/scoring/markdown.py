"""Parts of a score as Markdown, for the documentation."""

from tests.sealed.scoring.score import Score
from tests.sealed.scoring.tables import Table


def described(score: Score) -> str:
    """Return seed, cases by kind, and the score's notes."""
    kinds = ", ".join(f"{count} {kind}" for kind, count in score.kinds.items())
    head = f"Seed `{score.seed}`, {score.cases} cases: {kinds}."
    notes = "\n".join(f"- {note}" for note in score.notes)
    return "\n\n".join(part for part in (head, notes) if part)


def tabulated(table: Table, level: int = 2) -> str:
    """Return a table under a heading of that level."""
    lines = [table.head, ("---",) * len(table.head), *table.rows]
    rows = "\n".join("| " + " | ".join(row) + " |" for row in lines)
    return f"{'#' * level} {table.caption}\n\n{rows}"
