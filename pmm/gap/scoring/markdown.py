"""A score as a page of the documentation."""

from collections.abc import Mapping, Sequence

from pmm.gap.scoring.score import Score
from pmm.gap.scoring.tables import Table, tables


def markdown(
    score: Score,
    made_on: Mapping[str, str],
    *,
    title: str,
    intro: str,
    first: Sequence[Table] = (),
) -> str:
    """Return a score as Markdown.

    Parameters
    ----------
    made_on
        Machine, commit and date, for the foot of the page.
    intro
        What stands between title and tables.
    first
        Tables before the score's own.
    """
    kinds = ", ".join(f"{count} {kind}" for kind, count in score.kinds.items())
    head = f"# {title}\n\n{intro}\n\nSeed `{score.seed}`, {score.cases} cases: {kinds}."
    notes = "\n".join(f"- {note}" for note in score.notes)
    body = "\n\n".join(_table(one) for one in (*first, *tables(score)))
    foot = "\n".join(f"| {name} | {value} |" for name, value in made_on.items())
    return (
        "\n\n".join(
            part for part in (head, notes, body, "## Made on\n\n| | |\n|---|---|\n" + foot) if part
        )
        + "\n"
    )


def _table(table: Table) -> str:
    lines = [table.head, ("---",) * len(table.head), *table.rows]
    return f"## {table.caption}\n\n" + "\n".join("| " + " | ".join(row) + " |" for row in lines)
