"""The board's other rows: controls and peers, answered case by case."""

import json
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from importlib.util import find_spec
from multiprocessing import get_context
from pathlib import Path

from tests.sealed.controls import CONTROLS, Answerer
from tests.sealed.peers.by_bic import lmfit_bic
from tests.sealed.peers.largest import largest_residual
from tests.sealed.peers.sparse import pysindy_stlsq
from tests.sealed.peers.structural import structural

# Name of the row -> answerer, and the package that it needs.
PEERS: Mapping[str, tuple[Answerer, str]] = {
    "largest-residual": (largest_residual, ""),
    "lmfit": (lmfit_bic, "lmfit"),
    "pysindy": (pysindy_stlsq, "pysindy"),
    "faultdiagnosistoolbox": (structural, "faultdiagnosistoolbox"),
}


def answerer(row: str) -> Answerer:
    """Return who answers a row."""
    return CONTROLS[row] if row in CONTROLS else PEERS[row][0]


def answer_rows(board: Path, only: Sequence[str], workers: int) -> Iterator[str]:
    """Answer a board row by row; yield a line about each.

    Raises
    ------
    KeyError
        If a row is not known.
    """
    for row in only or (*CONTROLS, *PEERS):
        needs = PEERS[row][1] if row not in CONTROLS else ""
        if needs and find_spec(needs) is None:
            yield f"{row}: skipped, {needs} is not installed (optional dependency peers)"
            continue
        target = board / f"answers-{row}"
        target.mkdir(exist_ok=True)
        cases = sorted((board / "cases").iterdir())
        _answer_all(partial(_answer, row, target), cases, 1 if row in CONTROLS else workers)
        yield f"{row}: {len(cases)} cases answered"


def _answer_all(answer: "partial[None]", cases: Sequence[Path], workers: int) -> None:
    if workers == 1:
        for case in cases:
            answer(case)
        return
    with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
        list(pool.map(answer, cases, chunksize=4))


def _answer(row: str, target: Path, case: Path) -> None:
    found = answerer(row)(case)
    text = json.dumps(found, indent=1, allow_nan=False)
    (target / f"{case.name}.json").write_text(text + "\n")
