"""A score as tables of text: the screen, the page and ``docs/scoreboard.md`` show the same ones."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from tests.sealed.scoring.columns import COLUMNS
from tests.sealed.scoring.intervals import Figure
from tests.sealed.scoring.rows import BINS, RowScore
from tests.sealed.scoring.score import Score

TITLES: Final = {
    **{column.key: column.title for column in COLUMNS},
    "auroc": "AUROC of unknown",
}
CEILING: Final = "ceiling"


@dataclass(frozen=True)
class Table:
    """Rows of cells under a head; the first cell of each row names it."""

    caption: str
    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


def tables(score: Score) -> tuple[Table, ...]:
    """Return all tables of a score, the most telling ones first."""
    first = score.rows[0]
    return (
        _overview(score),
        _by_bin(first),
        *(_one_bin(score, one.key, one.title) for one in BINS[:-1] if _holds(first, one.key)),
        *_angles(score),
        *_reliability(first),
        *_left_out(score),
    )


def cell(figure: Figure | None) -> str:
    """Return ``0.84 [0.71, 0.92] n 41``; a dash where there is no figure."""
    if figure is None:
        return "-"
    return f"{figure.value:.3g} [{figure.low:.2g}, {figure.high:.2g}] n {figure.count}"


def _ceiling(figure: Figure | None) -> str:
    return "" if figure is None or figure.ceiling is None else f"{figure.ceiling:.3g}"


def _holds(row: RowScore, key: str) -> bool:
    return any(one.key == key and one.cases for one in row.bins)


def _overview(score: Score) -> Table:
    table = _one_bin(score, BINS[-1].key, f"All rows: {BINS[-1].title}")
    own = ("mean of the columns", *(f"{row.mean:.3f}" for row in score.rows), "")
    return Table(table.caption, table.head, (*table.rows, own))


def _one_bin(score: Score, key: str, title: str) -> Table:
    rows = []
    for column, name in TITLES.items():
        figures = [row.figure(key, column) for row in score.rows]
        if any(figures):
            reached = next((figure for figure in figures if figure is not None), None)
            rows.append((name, *(cell(figure) for figure in figures), _ceiling(reached)))
    return Table(title, ("", *(row.name for row in score.rows), CEILING), tuple(rows))


def _by_bin(row: RowScore) -> Table:
    shown = [one for one in row.bins if one.cases]
    rows = []
    for column, name in TITLES.items():
        figures = [one.figures.get(column) for one in shown]
        if any(figures):
            rows.append((name, *(with_ceiling(figure) for figure in figures)))
    head = ("", *(f"{one.title} ({one.cases})" for one in shown))
    return Table(f"{row.name}: by what there is to see", head, tuple(rows))


def with_ceiling(figure: Figure | None) -> str:
    """Return a cell with what a linear matcher reaches: ``0.84 [0.71, 0.92] n 41 of 0.9``."""
    above = _ceiling(figure)
    return cell(figure) + (f" of {above}" if above else "")


def _angles(score: Score) -> Iterator[Table]:
    rows = tuple(
        (
            row.name,
            f"{one.low_deg:g} to {one.high_deg:g}",
            with_ceiling(one.unknown),
            cell(one.auroc),
        )
        for row in score.rows
        for one in row.angles
    )
    if rows:
        head = ("", "angle to the nearest effect (deg)", "unknown said", "AUROC of unknown")
        yield Table("Outside the catalogue, by how nearly something in it imitates", head, rows)


def _reliability(row: RowScore) -> Iterator[Table]:
    rows = tuple(
        (f"{one.low:g} to {one.high:.2g}", str(one.count), f"{one.said:.3f}", f"{one.right:.3f}")
        for one in row.reliability
    )
    head = ("probability", "cases", "said", "right")
    yield Table(f"{row.name}: how often the most probable answer is right", head, rows)


def _left_out(score: Score) -> Iterator[Table]:
    there = score.left_out
    if there is None:
        return
    rows = (
        ("unknown said", with_ceiling(there.unknown)),
        ("unknown or a true likeness, right stage", cell(there.good)),
        ("stage", cell(there.stage)),
        ("another name above 0.9", cell(there.sure_and_wrong)),
    )
    caption = "The right effect left out of the catalogue"
    yield Table(caption, ("", "diagnosis"), rows)
    if there.by_effect:
        counts = tuple(
            (one.name, *map(str, (one.cases, one.unknown, one.good, one.sure_and_wrong)))
            for one in there.by_effect
        )
        head = ("", "cases", *(name for name, _ in (rows[0], rows[1], rows[3])))
        yield Table(f"{caption}, effect by effect", head, counts)
