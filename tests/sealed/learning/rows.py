"""Rows that learn, written among a board's others: ``answers-NAME/``, scored as all of them are."""

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from hardware.description.errors import DataError
from tests.sealed.learning.boosted import classifier
from tests.sealed.learning.calibration import Conformal, Isotonic, Pair, covered
from tests.sealed.peers.sheet import sheet
from tests.sealed.scoring.board import DIAGNOSIS, OWN, Board, read_board
from tests.sealed.scoring.intervals import share


def boosted(board: Path, campaigns: Path, look: str) -> tuple[int, Iterable[str]]:
    """Fit to the campaigns, and return how many cases are to be answered and a line on each.

    Raises
    ------
    DataError
        If scikit-learn is not installed or there are too few campaigns.
    """
    model, room = classifier(campaigns, look), _room(board, f"boosted-{look}")
    cases = sorted((board / "cases").iterdir())
    open_ones = [case for case in cases if not (room / f"{case.name}.json").exists()]

    def lines() -> Iterator[str]:
        for case in open_ones:
            try:
                found, said = model.answer(case), f"{case.name}: by {model.trained_on} campaigns"
            except Exception as error:  # one case must not end the board, whatever it is
                said = f"{type(error).__name__}: {error}"
                found = sheet(case.name, {}, {}) | {"failed": said}
            _write(room, found)
            yield said

    return len(open_ones), lines()


def calibrated(board: Path, fitted_on: Sequence[Path], row: str, miss: float) -> Iterator[str]:
    """Write two rows of calibrated answers, and yield lines on what they were fitted to.

    Raises
    ------
    DataError
        If a board is not whole, lacks the row, or is fitted to and judged at once.
    """
    if board.resolve() in {one.resolve() for one in fitted_on}:
        raise DataError(f"{board}: fitted to and judged at once; name another board with --on")
    pairs = [pair for one in fitted_on for pair in pairs_of(read_board(one), row)]
    isotonic, conformal = Isotonic.of(pairs), Conformal.of(pairs)
    room = board / (OWN if row == DIAGNOSIS else f"answers-{row}")
    for file in sorted(room.glob("*.json")):
        found = json.loads(file.read_text())
        for name, fit in (("isotonic", isotonic), ("conformal", conformal)):
            _write(_room(board, f"{row}-{name}"), with_shares(found, fit))
    yield f"fitted to {len(pairs)} cases; classes of their own: {', '.join(conformal.strange)}"
    judged = list(covered(conformal, pairs_of(read_board(board), row), miss))
    held = share([float(holds) for holds, _ in judged])
    if held is not None:
        sizes = sum(size for _, size in judged) / len(judged)
        reached = f"{held.value:.2f} ({held.low:.2f} to {held.high:.2f}) of {held.count}"
        yield f"sets that were to hold {1.0 - miss:.2f} hold {reached}, {sizes:.1f} answers each"


def pairs_of(board: Board, row: str) -> list[Pair]:
    """Return a row's answers beside their keys; those that failed are left out.

    Raises
    ------
    DataError
        If the board does not have the row.
    """
    found = next((one for one in board.rows if one.name == row), None)
    if found is None:
        there = ", ".join(one.name for one in board.rows)
        raise DataError(f"{board.folder}: no row {row!r}; there are {there}")
    return [(answer, truth) for answer, truth in zip(found.answers, board.truths, strict=True)
            if not answer.failed]  # fmt: skip


def with_shares(found: Mapping[str, Any], fit: Isotonic | Conformal) -> dict[str, Any]:
    """Return an answer with its probabilities calibrated; one that failed stays as it is."""
    said = found["probabilities"]
    return dict(found) if not said else {**found, "probabilities": fit.shares(said)}


def _room(board: Path, name: str) -> Path:
    room = board / f"answers-{name}"
    room.mkdir(exist_ok=True)
    return room


def _write(room: Path, found: Mapping[str, Any]) -> None:
    part = room / f"{found['case']}.part"
    part.write_text(json.dumps(found, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    part.replace(room / f"{found['case']}.json")
