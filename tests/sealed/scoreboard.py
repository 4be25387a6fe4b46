"""``docs/scoreboard.md``: the newest score in a minute, all others and all figures folded."""

from collections.abc import Sequence
from pathlib import Path
from typing import Final

from hardware.description.errors import DataError
from tests.sealed.scoreboard_figure import NAME, draw, whole
from tests.sealed.scores import FOLDER, Kept, all_scores
from tests.sealed.scoring.board import DIAGNOSIS
from tests.sealed.scoring.markdown import described, folded, tabulated
from tests.sealed.scoring.rows import BINS
from tests.sealed.scoring.tables import TITLES, Table, tables, with_ceiling
from tests.sealed.targets import ceilings

INTRO: Final = (
    "Written by `python -m tests.sealed whole` or `page`; do not edit. A board is some hundred "
    "made-up campaigns; whoever wrote the diagnosis did not know their answers "
    "([sealed.md](sealed.md)). It is scored once, and judges the diagnosis of its commit."
)
READING: Final = (
    'Each figure stands with its 95 % interval and number of cases; behind "of" is what a linear '
    "matcher reaches on the same cases ([sealed-scoring.md](sealed-scoring.md)). A seed is the "
    "hash of the commit that froze the diagnosis and its thresholds; seeds 0 to 99 are for "
    "development and stand nowhere here."
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
    draw(kept, docs)
    (docs / "scoreboard.md").write_text(page(kept), encoding="utf-8")


def page(kept: Sequence[Kept]) -> str:
    """Return the page of some scores, in the order in which they were made."""
    newest = kept[-1]
    machine = Table(f"{newest.name} was made on", ("", newest.name), tuple(newest.made_on.items()))
    parts = [
        f"# The scoreboard\n\n{INTRO}",
        _told(newest),
        f"![Scores over time]({NAME})",
        tabulated(_newest(newest)),
        READING,
        folded("All scores", tabulated(_list(kept)), tabulated(_targets(kept))),
        folded("The diagnosis, column by column", tabulated(_columns(kept))),
        folded(
            f"All about the newest score, {newest.name}",
            described(newest.score),
            *(tabulated(one) for one in (*tables(newest.score), machine)),
        ),
    ]
    return "\n\n".join(parts) + "\n"


def _told(kept: Kept) -> str:
    """Return what the newest score says, in plain sentences."""
    judged = [one for one in kept.targets if one.measured is not None]
    met = sum(one.word == "met" for one in judged)
    told = [
        f"The newest board, {kept.name}, of {kept.score.cases} cases, was scored on "
        f"{kept.made_on['date'][:10]}: {met} of {len(judged)} targets are met."
    ]
    named, alarms = whole(kept, "top_1_by_class"), whole(kept, "false_alarms")
    if named is not None:
        told.append(
            f"Where a known effect can be seen at all, its class is named in "
            f"{100.0 * named.value:.0f} % of {named.count} cases."
        )
    if alarms is not None:
        told.append(
            f"Of {alarms.count} cases without a gap {100.0 * alarms.value:.1f} % raise an alarm."
        )
    return " ".join(told)


def _newest(kept: Kept) -> Table:
    rows = tuple(
        (one.what, one.limit, _verdict(kept, one.key, one.limit))
        for one in kept.targets
        if one.measured is not None
    )
    return Table("Targets", ("", "limit", kept.name), rows)


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
