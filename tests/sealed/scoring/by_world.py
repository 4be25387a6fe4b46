"""A board's figures by the limits of its world: SNR from 10, with 95 % intervals.

The oracle is a row of the board, ``answers-oracle/``: the same engine, told the form and the size
of what is there. Without it the paired figures are left out; docs/sealed.md says what each is.
"""

import math
import tomllib
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from tests.sealed.scoring.answers import Answer
from tests.sealed.scoring.board import DIAGNOSIS, Board
from tests.sealed.scoring.columns import COLUMNS, Entry
from tests.sealed.scoring.intervals import wilson
from tests.sealed.scoring.right import by_class, is_stated, named, stated
from tests.sealed.scoring.score import entries_of, floors_of, score

FloatArray = NDArray[np.float64]

TABLE: Final = Path(__file__).parents[1] / "worlds.toml"
ORACLE: Final = "oracle"
CLEAR_SNR: Final = 10.0
SURE: Final = 0.9
_BINS, _DRAWS, _PERFECT, _SEED = 10, 1000, 400, 20262
_OURS: Final = (DIAGNOSIS, ORACLE, "boosted-hypotheses")
_COLUMNS: Final = {column.key: column for column in COLUMNS}
_OWN: Final = {
    "false_alarms": "false_alarms",
    "class": "top_1_by_class",
    "stage": "stage",
    "shrinkage_covered": "shrinkage_covered",
}
PAIRED: Final = {
    "class_below_oracle": "top_1_by_class",
    "stage_below_oracle": "stage",
    "unknown_below_oracle": "unknown_or_like",
}


@dataclass(frozen=True)
class Held:
    """A figure with its 95 % interval, held to its world's limits.

    Attributes
    ----------
    word
        ``met``, ``missed`` (the interval's better end misses it too) or ``close``; empty where the
        board does not show it, or no limit was set.
    strict
        Whether the interval's worse end is held to the limit, so that nothing is close.
    """

    key: str
    what: str
    value: float | None
    low: float | None
    high: float | None
    count: int
    at_most: float | None
    at_least: float | None
    strict: bool = False

    @property
    def word(self) -> str:
        """How the figure stands to its limits."""
        no_limit = self.at_most is None and self.at_least is None
        if no_limit or self.value is None or self.low is None or self.high is None:
            return ""
        worst = [
            _held(self.low, self.high, self.at_most),
            _held(-self.high, -self.low, _less(self.at_least)),
        ]
        found = next(word for word in ("missed", "close", "met") if word in worst)
        return "missed" if self.strict and found == "close" else found


def _less(limit: float | None) -> float | None:
    return None if limit is None else -limit


def _held(low: float, high: float, at_most: float | None) -> str:
    if at_most is None or high <= at_most:
        return "met"
    return "missed" if low > at_most else "close"


def by_world(board: Board, world: str) -> tuple[Held, ...]:
    """Return every figure that has a limit, for a board of a world."""
    floors = floors_of(board)
    rows = {
        row.name: [marks_of(entry) for entry in entries_of(board.truths, row, floors)]
        for row in board.rows
    }
    found = figures_of(rows)
    whole = {row.name: row.mean for row in score(board).rows}
    others = [mean for name, mean in whole.items() if is_rival(name)]
    if others:
        ahead = whole[DIAGNOSIS] - max(others)
        found["ahead_of_others"] = (ahead, ahead, ahead, len(board.truths))
    return held_to(found, world)


def is_rival(row: str) -> bool:
    """Tell whether a row uses neither our features nor the key of what it is judged on."""
    return row not in _OURS and not row.startswith(f"{DIAGNOSIS}-")


def held_to(found: "Mapping[str, Figure]", world: str) -> tuple[Held, ...]:
    """Hold figures to the limits of a world; those that are not there have no value."""
    limits = tomllib.loads(TABLE.read_text(encoding="utf-8"))["limits"]
    out = []
    for key, row in limits.items():
        value, low, high, count = found.get(key, (None, None, None, 0))
        ends = (row.get(side, {}).get(world) for side in ("at_most", "at_least"))
        strict = bool(row.get("strict", False))
        out.append(Held(key, row["what"], value, low, high, count, *ends, strict))
    return tuple(out)


Figure = tuple[float | None, float | None, float | None, int]


@dataclass(frozen=True)
class Marks:
    """What one answer adds to the figures.

    Attributes
    ----------
    is_clear
        Whether it counts: nothing is wrong there, or the SNR is 10 or more.
    values
        What it adds to each column; nothing to those that do not apply to its case.
    stated
        Probability of the class that it says, and 1 where what is there is in it or the key calls
        what it names right; ``None`` where it failed.
    """

    is_clear: bool
    values: Mapping[str, Sequence[float]]
    stated: Sequence[float] | None


def marks_of(entry: Entry) -> Marks:
    """Return the marks of an answer beside its key."""
    columns = sorted({*_OWN.values(), *PAIRED.values()})
    answer = entry.answer
    # What is stated is the probability of a class: it is right if what is there is in it.
    right = float(answer.said in by_class(entry.truth) or is_stated(answer, entry.truth))
    return Marks(
        not entry.has_gap or entry.truth.snr >= CLEAR_SNR,
        {name: tuple(float(one) for one in _COLUMNS[name].values(entry)) for name in columns},
        None if answer.failed else (class_probability(answer), right),
    )


def figures_of(rows: Mapping[str, Sequence[Marks]]) -> dict[str, Figure]:
    """Return the figures of the diagnosis, and those beside the oracle where it answered too."""
    ours = rows[DIAGNOSIS]
    out = {key: mean_figure(_values(ours, column)) for key, column in _OWN.items()}
    if ORACLE in rows:
        for key, column in PAIRED.items():
            theirs, own = (_values(row, column) for row in (rows[ORACLE], ours))
            out[key] = _boot(theirs - own, _mean)
    said = _stated(one for one in ours if one.is_clear)
    out["sure_and_wrong"] = mean_figure(1.0 - said[said[:, 0] >= SURE, 1])
    out["calibration_excess"] = _boot(said, _excess)
    gaps = _stated(one for one in ours if one.is_clear and not one.values["false_alarms"])
    out["sure_and_wrong_gaps"] = mean_figure(1.0 - gaps[gaps[:, 0] >= SURE, 1])
    return out


def _stated(marks: Iterable[Marks]) -> FloatArray:
    """Return what is stated and whether it is right; a failure counts as sure and wrong."""
    return np.array([one.stated or (1.0, 0.0) for one in marks]).reshape(-1, 2)


def _values(marks: Sequence[Marks], column: str) -> FloatArray:
    """Return a column's values; a case that it does not apply to is left out in every row alike."""
    return np.array([value for one in marks if one.is_clear for value in one.values[column]])


def class_probability(answer: Answer) -> float:
    """Return the probability of what an answer says and of what it calls the same."""
    names = {answer.said, *(stated(answer) if len(named(answer.said)) == 1 else ())}
    return min(math.fsum(answer.probabilities.get(name, 0.0) for name in names), 1.0)


def calibration_error(said: FloatArray, right: FloatArray) -> float:
    """Return the mean distance of said from right over ten even bins, by their counts."""
    bins = np.minimum((said * _BINS).astype(int), _BINS - 1)
    off = [abs(float((said - right)[bins == i].sum())) for i in range(_BINS)]
    return sum(off) / len(said)


def _excess(rows: FloatArray) -> float:
    """Return the error less that of answers as sure that are right as often as they say."""
    said, rng = rows[:, 0], np.random.default_rng(_SEED)
    draws = rng.random((_PERFECT, len(said))) < said
    perfect = np.mean([calibration_error(said, draw.astype(np.float64)) for draw in draws])
    return calibration_error(said, rows[:, 1]) - float(perfect)


def mean_figure(values: FloatArray) -> Figure:
    """Return a mean with its 95 % interval, and n: Wilson's of a share, else the bootstrap's.

    Of none, or all, of n the bootstrap would say nothing.
    """
    if len(values) and np.isin(values, (0.0, 1.0)).all():
        return float(values.mean()), *wilson(float(values.sum()), len(values)), len(values)
    return _boot(values, _mean)


def _mean(values: FloatArray) -> float:
    return float(values.mean())


def _boot(values: FloatArray, figure: Callable[[FloatArray], float]) -> Figure:
    count = len(values)
    if count == 0:
        return None, None, None, 0
    rng, draws = np.random.default_rng(_SEED), _DRAWS if values.ndim == 1 else _DRAWS // 4
    found = [figure(values[rng.integers(0, count, count)]) for _ in range(draws)]
    low, high = np.quantile(found, (0.025, 0.975))
    return figure(values), float(low), float(high), count
