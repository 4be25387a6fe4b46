"""Figures of all rows of a world's first cases, from the marks that were kept of them."""

from collections.abc import Iterator, Sequence
from typing import Any, Final

import numpy as np

from tests.sealed.answering import DIAGNOSIS
from tests.sealed.scoring.answers import UNKNOWN
from tests.sealed.scoring.by_world import (
    ORACLE,
    PAIRED,
    SURE,
    Figure,
    Marks,
    figures_of,
    mean_figure,
)
from tests.sealed.scoring.columns import COLUMNS
from tests.sealed.scoring.intervals import auroc
from tests.sealed.scoring.rows import mean_of
from tests.sealed.variations import VARIATIONS

Line = dict[str, Any]

MATCHER: Final = "linear matcher"
SHOWN: Final = tuple(PAIRED.values())
"""Columns that the table of rows shows."""
_SAMPLED: Final = tuple(one.name for one in VARIATIONS if one.part == 1.0)


def figures_beside(lines: Sequence[Line]) -> dict[str, Figure]:
    """Return the figures of a world's lines that take other rows, or the case again."""
    marks = {
        name: [Marks(one["is_clear"], one["values"], one["stated"]) for one in row]
        for name, row in _rows(lines).items()
        if name in (DIAGNOSIS, ORACLE)
    }
    out = {key: one for key, one in figures_of(marks).items() if key in PAIRED} if marks else {}
    alike = [line["alike"][name] for line in lines for name in _SAMPLED if name in line["alike"]]
    for at, key in enumerate(("invariance_class", "invariance_probability")):
        out[key] = mean_figure(np.array([float(one[at]) for one in alike]))
    cut = [line["cut"] for line in lines if line["cut"]]
    held = [same for same, *sure in cut if min(sure) >= SURE]
    out["invariance_cut"] = mean_figure(np.array(held))
    means = row_means([line for line in lines if line["counts"]])
    others = [mean for name, mean in means.items() if name not in (DIAGNOSIS, ORACLE)]
    if others:
        ahead = means[DIAGNOSIS] - max(others)
        out["ahead_of_others"] = (ahead, ahead, ahead, len(lines))
    return out


def rows_beside(lines: Sequence[Line]) -> Iterator[tuple[str, dict[str, Figure], float | None]]:
    """Yield each row's name, its figures from SNR 10 on, and its mean of columns.

    The linear matcher's are what it can reach, not answers: it has no mean.
    """
    means = row_means([line for line in lines if line["counts"]])
    for name, row in _rows(lines).items():
        clear = [mark["values"] for mark in row if mark["is_clear"]]
        said = {key: np.array([x for one in clear for x in one[key]]) for key in SHOWN}
        yield name, {key: mean_figure(values) for key, values in said.items()}, means.get(name)
    there = [line["matched"] for line in lines if line["rows"][DIAGNOSIS]["is_clear"]]
    reached = {key: np.array([one[key] for one in there if key in one]) for key in SHOWN}
    if lines:
        yield MATCHER, {key: mean_figure(values) for key, values in reached.items()}, None


def row_means(lines: Sequence[Line]) -> dict[str, float]:
    """Return the mean of columns of every row."""
    found = {name: _figures(lines, row) for name, row in _rows(lines).items()}
    shown = {key for row in found.values() for key in row}
    return {name: mean_of(row, shown) for name, row in found.items()}


def _rows(lines: Sequence[Line]) -> dict[str, list[Line]]:
    return {
        name: [line["rows"][name] for line in lines] for name in (lines[0]["rows"] if lines else ())
    }


def _figures(lines: Sequence[Line], row: Sequence[Line]) -> dict[str, float]:
    found = {
        one.key: one.figure([x for mark in row for x in mark["values"][one.key]]) for one in COLUMNS
    }
    verdicts = [line["verdict"] for line in lines]
    inside, outside = (
        [mark["unknown"] for mark, verdict in zip(row, verdicts, strict=True) if verdict == which]
        for which in (UNKNOWN, "gap")
    )
    found["auroc"] = auroc(inside, outside)
    return {key: figure.value for key, figure in found.items() if figure is not None}
