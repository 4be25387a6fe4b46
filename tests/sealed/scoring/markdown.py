"""Parts of a score as Markdown, for the documentation."""

from tests.sealed.scoring.score import Score
from tests.sealed.scoring.tables import Table


def described(score: Score) -> str:
    """Return seed, cases by kind, and the score's notes."""
    kinds = ", ".join(f"{count} {kind}" for kind, count in score.kinds.items())
    head = f"Seed `{score.seed}`, {score.cases} cases: {kinds}."
    notes = "\n".join(f"- {note}" for note in score.notes)
    return "\n\n".join(part for part in (head, notes) if part)


def tabulated(table: Table) -> str:
    """Return a table under its caption."""
    lines = [table.head, ("---",) * len(table.head), *table.rows]
    rows = "\n".join("| " + " | ".join(row) + " |" for row in lines)
    return f"**{table.caption}**\n\n{rows}"


def folded(summary: str, *parts: str) -> str:
    """Return parts that are shown when somebody asks for them."""
    inside = "\n\n".join(parts)
    return f"<details>\n<summary>{summary}</summary>\n\n{inside}\n\n</details>"
