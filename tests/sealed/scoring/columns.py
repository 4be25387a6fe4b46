"""The columns of the board: what each counts, on which cases, and the ceiling beside it.

``docs/sealed-scoring.md`` defines them in words.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Final

from tests.sealed.scoring.answers import UNKNOWN, Answer
from tests.sealed.scoring.intervals import Figure, mean, median, share
from tests.sealed.scoring.keys import Truth
from tests.sealed.scoring.right import best_name, brier, by_class, exactly, is_stated, named, stated
from tests.sealed.scoring.shrinkage import Shrunk

CLEAR: Final = 10.0  # sigma left of each member of a pair, its rivals taken out
TIE_SHARE: Final = 0.01  # of a gap, within which two answers shrink it alike


@dataclass(frozen=True)
class Entry:
    """One answer beside its key.

    Attributes
    ----------
    shrunk
        True gaps on the withheld runs; ``None`` where nothing is foretold or can shrink.
    own_share
        True shrinkage from the answer's own gap before, which its interval speaks of.
    """

    answer: Answer
    truth: Truth
    shrunk: Shrunk | None = None
    own_share: float | None = None

    @property
    def has_gap(self) -> bool:
        """Whether there is a gap, in the catalogue or outside it."""
        return self.truth.verdict in ("gap", UNKNOWN)

    @property
    def in_catalogue(self) -> bool:
        """Whether there is a gap with a name."""
        return self.truth.verdict == "gap"


Values = Callable[[Entry], Iterable[float]]


@dataclass(frozen=True)
class Column:
    """One column.

    Attributes
    ----------
    values
        What an entry adds to it: hits as 1 and 0, or values; nothing where it does not apply.
    figure
        Makes one figure of them.
    ceiling
        Key of ``truth.ceiling`` that stands beside it.
    falls
        Whether less is better.
    """

    key: str
    title: str
    values: Values
    figure: Callable[[Sequence[float]], Figure | None] = share
    ceiling: str | None = None
    falls: bool = False

    def of(self, entries: Sequence[Entry]) -> Figure | None:
        """Return the column's figure over some entries; ``None`` where none of them counts."""
        pairs = [(entry, list(self.values(entry))) for entry in entries]
        found = self.figure([value for _, values in pairs for value in values])
        if found is None or self.ceiling is None:
            return found
        there = [entry.truth.ceiling for entry, values in pairs if values]
        reached = [one.get(self.ceiling) for one in there if one is not None]
        return found.beside([value for value in reached if value is not None])


def _when(applies: Callable[[Entry], bool], hit: Callable[[Entry], float]) -> Values:
    return lambda entry: (float(hit(entry)),) if applies(entry) else ()


def _stage(entry: Entry) -> bool:
    stages = entry.answer.stages
    return bool(stages) and min(stages, key=lambda s: (-stages[s], s)) in entry.truth.stages


def _class_size(entry: Entry) -> Iterable[float]:
    if entry.in_catalogue and len(named(entry.answer.said)) == 1:
        yield float(len(stated(entry.answer)))


def _is_clear(entry: Entry) -> bool:
    return entry.truth.kind == "pair" and min(one.alone for one in entry.truth.effects) >= CLEAR


def _magnitudes(entry: Entry) -> Iterable[float]:
    """Yield for each parameter of a rightly named effect whether its interval holds the truth."""
    there = {one.name: one.equivalent for one in entry.truth.effects}
    for one in entry.answer.effects:
        for name, value in there.get(one.name, {}).items():
            if name in one.parameters:
                interval = one.parameters[name]
                yield float(interval.low <= value <= interval.high)


def _covered(entry: Entry) -> Iterable[float]:
    if entry.has_gap and entry.answer.alarm and entry.own_share is not None:
        interval = entry.answer.shrinkage
        yield float(interval.low <= entry.own_share <= interval.high)


def _gap(part: Callable[[Shrunk], float]) -> Values:
    return lambda entry: (part(entry.shrunk),) if entry.shrunk and entry.in_catalogue else ()


def _control(part: Callable[[Shrunk], float | None]) -> Values:
    """Return the shrinkage that a control reaches, where it is foretold."""

    def reached(entry: Entry) -> Iterable[float]:
        there = entry.shrunk
        left = None if there is None else part(there)
        if there is not None and left is not None and entry.in_catalogue:
            yield there.share_of(left)

    return reached


def _ahead(part: Callable[[Shrunk], float | None]) -> Values:
    """Return whether more of the gap goes away than with a control; a tie is half."""

    def ahead(entry: Entry) -> Iterable[float]:
        for other in _control(part)(entry):
            more = entry.shrunk.share - other if entry.shrunk else 0.0
            yield 0.5 if abs(more) < TIE_SHARE else float(more > 0.0)

    return ahead


def _seconds(entry: Entry) -> Iterable[float]:
    if entry.answer.seconds is not None:
        yield entry.answer.seconds


def _separates(entry: Entry) -> bool:
    run = entry.answer.next_run
    if run is None:
        return False
    return entry.truth.separated_by in (run.get("kind", "oscillation"), run.get("medium"))


COLUMNS: Final = (
    Column("detection", "gap seen", _when(lambda e: e.has_gap, lambda e: e.answer.alarm),
           ceiling="detection"),
    Column("false_alarms", "false alarms",
           _when(lambda e: e.truth.verdict == "none",
                 lambda e: e.answer.alarm or bool(e.answer.failed)), falls=True),
    Column("failed", "failed", lambda e: (float(bool(e.answer.failed)),), falls=True),
    Column("coefficients", "coefficients said",
           _when(lambda e: e.truth.verdict == "coefficients",
                 lambda e: e.answer.said in exactly(e.truth))),
    Column("stage", "stage", _when(lambda e: e.has_gap, _stage), ceiling="stage"),
    Column("top_1", "top-1",
           _when(lambda e: e.in_catalogue, lambda e: e.answer.said in exactly(e.truth)),
           ceiling="top_1"),
    Column("top_1_by_class", "top-1 by class",
           _when(lambda e: e.in_catalogue, lambda e: e.answer.said in by_class(e.truth)),
           ceiling="top_1_by_class"),
    Column("ranked_by_class", "best name by class",
           _when(lambda e: e.in_catalogue, lambda e: best_name(e.answer) in by_class(e.truth)),
           ceiling="top_1_by_class"),
    Column("top_1_stated", "top-1 by stated class",
           _when(lambda e: e.in_catalogue, lambda e: is_stated(e.answer, e.truth))),
    Column("class_size", "stated class size", _class_size, mean, "class_size", falls=True),
    Column("unknown", "unknown said",
           _when(lambda e: e.truth.verdict == UNKNOWN, lambda e: e.answer.said == UNKNOWN),
           ceiling="unknown"),
    Column("unknown_or_like", "unknown, or what says the same",
           _when(lambda e: e.truth.verdict == UNKNOWN,
                 lambda e: e.answer.said in by_class(e.truth))),
    Column("pairs", "pairs",
           _when(lambda e: e.truth.kind == "pair", lambda e: e.answer.said in by_class(e.truth)),
           ceiling="top_1_by_class"),
    Column("pairs_clear", "clear pairs",
           _when(_is_clear, lambda e: e.answer.said in by_class(e.truth)),
           ceiling="top_1_by_class"),
    Column("gap_before", "gap before (u)", _gap(lambda s: s.before), median),
    Column("gap_after", "gap after (u)", _gap(lambda s: s.after), median, falls=True),
    Column("shrinkage", "true shrinkage", _gap(lambda s: s.share), median),
    Column("shrinkage_rival", "true shrinkage, second best", _control(lambda s: s.rival), median),
    Column("shrinkage_polynomial", "true shrinkage, free polynomial",
           _control(lambda s: s.polynomial), median),
    Column("ahead_of_rival", "shrinks more than the second best", _ahead(lambda s: s.rival)),
    Column("ahead_of_polynomial", "shrinks more than a free polynomial",
           _ahead(lambda s: s.polynomial)),
    Column("brier", "Brier", lambda e: (brier(e.answer, e.truth),), mean, falls=True),
    Column("magnitudes", "magnitudes covered", _magnitudes),
    Column("shrinkage_covered", "shrinkage covered", _covered),
    Column("separates_twins", "next run tells twins apart",
           _when(lambda e: e.truth.kind == "twin", _separates)),
    Column("seconds", "processor time (s)", _seconds, median, falls=True),
)  # fmt: skip
