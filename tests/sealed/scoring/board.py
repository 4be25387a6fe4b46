"""A board's folder, read and checked as a whole."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from hardware.description.errors import DataError
from pmm.configuration import read_toml
from tests.sealed.scoring.answers import Answer, read_answer
from tests.sealed.scoring.keys import Truth, read_truth
from tests.sealed.scoring.leaks import leaks

SCHEMA = "sealed-board-1"
OWN = "answers"
DIAGNOSIS = "diagnosis"
LEFT_OUT = "answers-leave-one-out"
_PREFIX = "answers-"
_SHOWN = 20


@dataclass(frozen=True, eq=False)
class Row:
    """One answerer's answers to all cases, in their order."""

    name: str
    answers: tuple[Answer, ...]


@dataclass(frozen=True, eq=False)
class Board:
    """Keys and answers of a board.

    Attributes
    ----------
    seed
        Seed, or the commit's hash, in hexadecimal.
    rows
        That of ``answers/`` first, by the name ``DIAGNOSIS``; then those of ``answers-NAME/``.
    left_out
        Answers with a case's right effects taken out of the catalogue, by case; may be empty.
    """

    folder: Path
    seed: str
    truths: tuple[Truth, ...]
    rows: tuple[Row, ...]
    left_out: dict[str, Answer]


def read_board(folder: Path, progress: Callable[[str], None] = lambda _: None) -> Board:
    """Read a board, and refuse one that is not whole.

    Raises
    ------
    ConfigurationError
        If ``board.toml`` cannot be read.
    DataError
        With every error: a key that lies open, a case without key or answer, an answer without
        case, and whatever is wrong in an answer.
    """
    table = read_toml(folder / "board.toml")
    if table.get("schema") != SCHEMA:
        raise DataError(
            f"{folder / 'board.toml'}: schema is {table.get('schema')!r}, should be {SCHEMA!r}"
        )
    faults: list[str] = []
    names = tuple(str(name) for name in table.get("cases", ()))
    truths = tuple(_truths(folder, names, faults, progress))
    rows, left_out = [], {}
    if not faults:
        for place, name in _rows(folder):
            progress(name)
            rows.append(Row(name, tuple(_answers(place, truths, faults, whole=True))))
        there = tuple(_answers(folder / LEFT_OUT, truths, faults, whole=False))
        left_out = {one.case: one for one in there}
        faults += _not_left_out(truths, left_out)
    if not faults and not rows:
        faults.append(f"{folder}: no answers yet; they belong in {folder / OWN}")
    if faults:
        raise _refused(folder, faults)
    return Board(folder, str(table.get("seed", "")), truths, tuple(rows), left_out)


def _not_left_out(truths: tuple[Truth, ...], left_out: dict[str, Answer]) -> Iterator[str]:
    for truth in truths:
        right = {name for one in truth.right for name in one}
        said = left_out[truth.case].probabilities if truth.case in left_out else {}
        for name in sorted(right & {part for answer in said for part in answer.split("+")}):
            yield f"{LEFT_OUT}/{truth.case}.json: {name!r} is right here and was to be left out"


def _refused(folder: Path, faults: list[str]) -> DataError:
    more = f"\n  and {len(faults) - _SHOWN} more" if len(faults) > _SHOWN else ""
    return DataError(
        f"{folder}: {len(faults)} error{'s' * (len(faults) > 1)}; nothing is scored\n  "
        + "\n  ".join(faults[:_SHOWN])
        + more
    )


def _rows(folder: Path) -> Iterator[tuple[Path, str]]:
    if (folder / OWN).is_dir():
        yield folder / OWN, DIAGNOSIS
    for place in sorted(folder.glob(f"{_PREFIX}*")):
        if place.is_dir() and place.name != LEFT_OUT:
            yield place, place.name.removeprefix(_PREFIX)


def _truths(
    folder: Path, names: tuple[str, ...], faults: list[str], progress: Callable[[str], None]
) -> Iterator[Truth]:
    if not names or len(set(names)) < len(names):
        faults.append(f"{folder / 'board.toml'}: cases must be names, each once")
    for name in names:
        progress(name)
        case, key = folder / "cases" / name, folder / "keys" / name
        if not case.is_dir():
            faults.append(f"{case}: no such case, though board.toml lists it")
            continue
        try:
            yield read_truth(key / "truth.json")
        except ValueError as error:
            faults += str(error).splitlines()
        faults += leaks(case, key)


def _answers(
    place: Path, truths: tuple[Truth, ...], faults: list[str], *, whole: bool
) -> Iterator[Answer]:
    from sim.effects.catalogue import catalogue

    known = frozenset(catalogue())
    there = {path.stem: path for path in place.glob("*.json")}
    strange = sorted(set(there) - {truth.case for truth in truths})
    faults += [f"{there[name]}: answers no case of the board" for name in strange]
    for truth in truths:
        if truth.case not in there:
            if whole:
                faults.append(f"{place}: no answer to {truth.case}")
            continue
        try:
            yield read_answer(there[truth.case], known, truth)
        except ValueError as error:
            faults += str(error).splitlines()
