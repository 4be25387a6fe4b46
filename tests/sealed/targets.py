"""What a scored board says about the targets in ``benchmarks/thresholds.toml``, table ``gap``."""

from collections.abc import Iterable, Iterator

from benchmarks.outcome import Verdict, judge
from tests.sealed.scoring.board import DIAGNOSIS
from tests.sealed.scoring.intervals import Figure
from tests.sealed.scoring.rows import RowScore
from tests.sealed.scoring.score import Score

_BINS = ("low", "middle", "high")


def verdicts(score: Score) -> list[Verdict]:
    """Return each target beside what the diagnosis reached; none where it did not answer."""
    if score.rows[0].name != DIAGNOSIS:
        return []
    return judge("gap", dict(_measured(score)))


def ceilings(score: Score) -> dict[str, float]:
    """Return by key what a linear matcher reaches where a target has such a ceiling."""
    row = score.rows[0]
    figures = {
        "class_size": row.figure("all", "class_size"),
        "pairs_clear": row.figure("all", "pairs_clear"),
        "stage": _worst_stage(row),
    }
    return {
        key: figure.ceiling
        for key, figure in figures.items()
        if figure is not None and figure.ceiling is not None
    }


def _worst_stage(row: RowScore) -> Figure | None:
    there = _figures(row, "stage", _BINS[1:])
    return min(there, key=lambda figure: figure.value) if there else None


def _measured(score: Score) -> Iterator[tuple[str, float]]:
    row = score.rows[0]
    whole = {
        "class_size": "class_size",
        "false_alarms": "false_alarms",
        "pairs_clear": "pairs_clear",
        "shrinkage_covered": "shrinkage_covered",
        "shrinkage_covered_not_too_often": "shrinkage_covered",
        "case_s": "seconds",
    }
    for key, column in whole.items():
        yield from _value(key, row.figure("all", column))
    yield from _value("gap_after", row.figure("middle", "gap_after"))
    yield from _value("shrinkage", row.figure("high", "shrinkage"))
    for key, column in (("class_below_ceiling", "top_1_by_class"),
                        ("unknown_below_ceiling", "unknown")):  # fmt: skip
        below = [f.ceiling - f.value for f in _figures(row, column) if f.ceiling is not None]
        if below:
            yield key, max(below)
    yield from _value("stage", _worst_stage(row))
    if len(score.rows) > 1:
        yield "ahead_of_others", row.mean - max(other.mean for other in score.rows[1:])
    if score.left_out is not None:
        yield "left_out_sure_and_wrong", score.left_out.sure_and_wrong.value


def _figures(row: RowScore, column: str, bins: Iterable[str] = _BINS) -> list[Figure]:
    found = [row.figure(key, column) for key in bins]
    return [figure for figure in found if figure is not None]


def _value(key: str, figure: Figure | None) -> Iterator[tuple[str, float]]:
    if figure is not None:
        yield key, figure.value
