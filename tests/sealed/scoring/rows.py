"""One answerer's figures, by what there is to see."""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from tests.sealed.scoring.answers import UNKNOWN
from tests.sealed.scoring.columns import COLUMNS, Entry
from tests.sealed.scoring.intervals import Figure, auroc, share
from tests.sealed.scoring.keys import Truth
from tests.sealed.scoring.right import Reliability, reliability

DETERMINABLE: Final = 3.0
ANGLES_DEG: Final = ((0.0, 8.0), (8.0, 25.0), (25.0, 50.0), (50.0, 90.1))


@dataclass(frozen=True)
class Bin:
    """Cases that are scored together."""

    key: str
    title: str
    holds: Callable[[Truth], bool]


def _between(low: float, high: float) -> Callable[[Truth], bool]:
    return lambda truth: truth.verdict in ("gap", UNKNOWN) and low <= truth.snr < high


BINS: Final = (
    Bin("no_gap", "no gap", lambda truth: truth.verdict == "none"),
    Bin("coefficients", "coefficients only", lambda truth: truth.verdict == "coefficients"),
    Bin("hidden", "SNR below 3: not determinable", _between(0.0, DETERMINABLE)),
    Bin("low", "SNR 3 to 10", _between(DETERMINABLE, 10.0)),
    Bin("middle", "SNR 10 to 30", _between(10.0, 30.0)),
    Bin("high", "SNR above 30", _between(30.0, float("inf"))),
    Bin("all", "all but the hidden",
        lambda t: t.verdict in ("none", "coefficients") or t.snr >= DETERMINABLE),
)  # fmt: skip

# What the mean of the columns is made of; a falling one counts as what it lacks to its limit.
_MEAN: Final[Mapping[str, Callable[[float], float]]] = {
    "detection": lambda value: value,
    "false_alarms": lambda value: 1.0 - value,
    "coefficients": lambda value: value,
    "stage": lambda value: value,
    "top_1": lambda value: value,
    "top_1_by_class": lambda value: value,
    "unknown": lambda value: value,
    "auroc": lambda value: value,
    "pairs": lambda value: value,
    "shrinkage": lambda value: min(max(value, 0.0), 1.0),
    "brier": lambda value: 1.0 - value / 2.0,
}


@dataclass(frozen=True)
class Scored:
    """Figures of one bin by the columns' keys; what no case of it shows is left out."""

    key: str
    title: str
    cases: int
    figures: Mapping[str, Figure]


@dataclass(frozen=True)
class Angle:
    """Cases from outside the catalogue by how nearly something inside it imitates them."""

    low_deg: float
    high_deg: float
    unknown: Figure
    auroc: Figure | None


@dataclass(frozen=True)
class RowScore:
    """What one answerer reached.

    Attributes
    ----------
    mean
        Of the columns named in ``docs/sealed-scoring.md``, over the bin ``"all"``.
    """

    name: str
    bins: tuple[Scored, ...]
    angles: tuple[Angle, ...]
    reliability: tuple[Reliability, ...]
    mean: float

    def figure(self, bin_key: str, column: str) -> Figure | None:
        """Return one figure; ``None`` where no case shows it."""
        return next(one.figures.get(column) for one in self.bins if one.key == bin_key)


def binned(entries: Sequence[Entry]) -> tuple[Scored, ...]:
    """Return the figures of some entries, bin by bin."""
    return tuple(_bin(one, [e for e in entries if one.holds(e.truth)]) for one in BINS)


def _bin(one: Bin, entries: Sequence[Entry]) -> Scored:
    figures = {column.key: column.of(entries) for column in COLUMNS}
    figures["auroc"] = auroc(*_told_apart(entries))
    there = {key: figure for key, figure in figures.items() if figure is not None}
    return Scored(one.key, one.title, len(entries), there)


def _told_apart(entries: Sequence[Entry]) -> tuple[list[float], list[float]]:
    """Return the probability of "unknown" for cases outside the catalogue, and inside it."""
    inside, outside = (
        [e.answer.probabilities.get(UNKNOWN, 0.0) for e in entries if e.truth.verdict == verdict]
        for verdict in (UNKNOWN, "gap")
    )
    return inside, outside


def row_score(
    name: str, entries: Sequence[Entry], bins: tuple[Scored, ...], shown: set[str]
) -> RowScore:
    """Return everything about one row.

    Parameters
    ----------
    shown
        Columns that some row of the board has a figure for.
    """
    seen = [e for e in entries if BINS[-1].holds(e.truth)]
    mean = mean_of({key: figure.value for key, figure in bins[-1].figures.items()}, shown)
    sure = reliability([(e.answer, e.truth) for e in seen])
    return RowScore(name, bins, tuple(_angles(seen)), sure, mean)


def mean_of(figures: Mapping[str, float], shown: Collection[str]) -> float:
    """Return the mean of a row's columns, of those that some row of the board shows.

    What a row leaves out counts as nothing reached; what no case shows counts for nobody.
    """
    parts = [_MEAN[key](figures[key]) if key in figures else 0.0 for key in _MEAN if key in shown]
    return sum(parts) / max(len(parts), 1)


def _angles(entries: Sequence[Entry]) -> list[Angle]:
    inside = [e for e in entries if e.truth.verdict == "gap"]
    found = []
    for low, high in ANGLES_DEG:
        there = [
            e for e in entries if e.truth.verdict == UNKNOWN and low <= _degrees(e.truth) < high
        ]
        rate = share([float(e.answer.said == UNKNOWN) for e in there])
        if rate is not None:
            reached = [(e.truth.ceiling or {}).get("unknown") for e in there]
            rate = rate.beside([value for value in reached if value is not None])
            found.append(Angle(low, min(high, 90.0), rate, auroc(*_told_apart([*there, *inside]))))
    return found


def _degrees(truth: Truth) -> float:
    return 90.0 if truth.angle_deg is None else truth.angle_deg
