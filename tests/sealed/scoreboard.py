"""``docs/scoreboard.md``: every score beside the others, then all about the newest."""

from collections.abc import Sequence
from pathlib import Path
from typing import Final

from hardware.description.errors import DataError
from tests.sealed.scores import FOLDER, Kept, all_scores
from tests.sealed.scoring.board import DIAGNOSIS
from tests.sealed.scoring.markdown import described, tabulated
from tests.sealed.scoring.rows import BINS
from tests.sealed.scoring.tables import TITLES, Table, tables, with_ceiling
from tests.sealed.targets import ceilings

INTRO: Final = (
    "Written by `python -m tests.sealed whole` or `page`; do not edit. [sealed.md](sealed.md) says "
    "what a board is, [sealed-scoring.md](sealed-scoring.md) what each figure counts: value, 95 % "
    'interval, number of cases; behind "of" stands the ceiling, what a linear matcher reaches on '
    "the same cases.\n\n"
    "The seed of a board is the hash of the commit that froze the diagnosis and its thresholds. "
    "A board is scored once; the first score stands first, every later one beside it. Seeds 0 to "
    "99 are for development and stand nowhere here."
)


def write_scoreboard(docs: Path) -> None:
    """Write the page from all scores that were kept.

    Raises
    ------
    DataError
        If there are none, or one cannot be read.
    """
    kept = all_scores(docs)
    if not kept:
        raise DataError(f"{docs / FOLDER}: no scores yet; `python -m tests.sealed whole` makes one")
    (docs / "scoreboard.md").write_text(page(kept), encoding="utf-8")


def page(kept: Sequence[Kept]) -> str:
    """Return the page of some scores, in the order in which they were made."""
    newest = kept[-1]
    machine = Table(f"{newest.name} was made on", ("", newest.name), tuple(newest.made_on.items()))
    parts = [
        f"# The scoreboard\n\n{INTRO}",
        *(tabulated(one) for one in (_list(kept), _targets(kept), _columns(kept))),
        f"## The newest score: {newest.name}\n\n{described(newest.score)}",
        *(tabulated(one, 3) for one in (*tables(newest.score), machine)),
    ]
    return "\n\n".join(parts) + "\n"


def _list(kept: Sequence[Kept]) -> Table:
    rows = tuple(
        (
            str(number),
            f"[{one.name}]({FOLDER}/{one.path.name})",
            one.made_on["date"],
            one.made_on["commit"],
            f"{one.made_on['cpu']}, {one.made_on['cores']} cores, Python {one.made_on['python']}",
            str(one.score.cases),
        )
        for number, one in enumerate(kept, start=1)
    )
    head = ("", "seed, with all figures", "scored", "at commit", "on", "cases")
    return Table("All scores", head, rows)


def _targets(kept: Sequence[Kept]) -> Table:
    newest = {target.key: target for target in kept[-1].targets}
    older = {target.key: target for one in kept for target in one.targets}
    rows = tuple(
        (target.what, target.limit, *(_verdict(one, key, target.limit) for one in kept))
        for key, target in {**older, **newest}.items()
    )
    names = tuple(one.name for one in kept)
    return Table("Targets of the diagnosis", ("", "limit", *names), rows)


def _verdict(kept: Kept, key: str, limit: str) -> str:
    """Return ``0.348 of 0.694, MISSED``, with the limit of that day where it was another."""
    there = next((target for target in kept.targets if target.key == key), None)
    if there is None or there.measured is None:
        return "not measured"
    reached = ceilings(kept.score).get(key)
    above = "" if reached is None else f" of {reached:.3g}"
    then = "" if there.limit == limit else f" ({there.limit})"
    return f"{there.measured:.3g}{above}, {there.word}{then}"


def _columns(kept: Sequence[Kept]) -> Table:
    own = [next((r for r in one.score.rows if r.name == DIAGNOSIS), None) for one in kept]
    key, title = BINS[-1].key, BINS[-1].title
    rows = []
    for column, name in TITLES.items():
        figures = [None if row is None else row.figure(key, column) for row in own]
        if any(figures):
            rows.append((name, *(with_ceiling(figure) for figure in figures)))
    rows.append(
        ("mean of the columns", *("-" if row is None else f"{row.mean:.3f}" for row in own))
    )
    names = tuple(one.name for one in kept)
    return Table(f"The diagnosis, score by score: {title}", ("", *names), tuple(rows))
