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
    is_rival,
    mean_figure,
)
from tests.sealed.scoring.columns import COLUMNS
from tests.sealed.scoring.intervals import median, ranked
from tests.sealed.scoring.rows import mean_of
from tests.sealed.variations import VARIATIONS

Line = dict[str, Any]

MATCHER: Final = "linear matcher"
SHOWN: Final = tuple(PAIRED.values())
"""Columns that the table of rows shows."""
_DRAWS, _SEED = 200, 20263
_SAMPLED: Final = tuple(one.name for one in VARIATIONS if one.part == 1.0)


def figures_beside(lines: Sequence[Line], learned: Sequence[Line] = ()) -> dict[str, Figure]:
    """Return the figures of a world's lines that take other rows, or the case again.

    Parameters
    ----------
    learned
        Lines of rows that learn, one of which is a rival too: where every case has one.
    """
    marks = {
        name: [Marks(one["is_clear"], one["values"], one["stated"]) for one in row]
        for name, row in _rows(lines).items()
        if name in (DIAGNOSIS, ORACLE)
    }
    out = {key: one for key, one in figures_of(marks).items() if key in PAIRED} if marks else {}
    sampled = [
        [line["alike"][name] for name in _SAMPLED if name in line["alike"]] for line in lines
    ]
    by_case = np.array([np.mean(one, axis=0) for one in sampled if one]).reshape(-1, 2)
    out["invariance_class"], out["invariance_probability"] = map(mean_figure, by_case.T)
    cut = [line["cut"] for line in lines if line["cut"]]
    held = [same for same, *sure in cut if min(sure) >= SURE]
    out["invariance_cut"] = mean_figure(np.array(held))
    rivals = [line for line in _with_learned(lines, learned) if line["counts"]]
    if rivals:
        rng = np.random.default_rng(_SEED)
        drawn = [
            _ahead([rivals[at] for at in rng.integers(0, len(rivals), len(rivals))])
            for _ in range(_DRAWS)
        ]
        low, high = np.quantile(drawn, (0.025, 0.975))
        out["ahead_of_others"] = (_ahead(rivals), float(low), float(high), len(rivals))
    return out


def _ahead(lines: Sequence[Line]) -> float:
    """Return by how much the diagnosis's mean of columns is above the best rival's."""
    means = row_means(lines)
    return means[DIAGNOSIS] - max(mean for name, mean in means.items() if is_rival(name))


def _with_learned(lines: Sequence[Line], learned: Sequence[Line]) -> Sequence[Line]:
    by_case = {(one["campaign"], one["seed"]): one["rows"] for one in learned}
    keys = [(line["campaign"], line["seed"]) for line in lines]
    if not all(key in by_case for key in keys):
        return lines
    return [
        {**line, "rows": {**by_case[key], **line["rows"]}}
        for key, line in zip(keys, lines, strict=True)
    ]


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
    found: dict[str, float] = {}
    for column in COLUMNS:
        values = [x for mark in row for x in mark["values"][column.key]]
        if values:
            middle = np.median if column.figure is median else np.mean
            found[column.key] = float(middle(values))
    verdicts = [line["verdict"] for line in lines]
    inside, outside = (
        [mark["unknown"] for mark, verdict in zip(row, verdicts, strict=True) if verdict == which]
        for which in (UNKNOWN, "gap")
    )
    if inside and outside:
        found["auroc"] = float(ranked(inside, outside).mean())
    return found
