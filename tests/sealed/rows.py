"""The board's other rows: controls and peers, and which of them are installed."""

from collections.abc import Mapping
from importlib.util import find_spec
from pathlib import Path

from tests.sealed.controls import CONTROLS, Answerer
from tests.sealed.peers.by_bic import lmfit_bic
from tests.sealed.peers.largest import largest_residual
from tests.sealed.peers.scene import scene
from tests.sealed.peers.sparse import pysindy_stlsq
from tests.sealed.peers.structural import structural

# Name of the row -> answerer, and the package that it needs.
PEERS: Mapping[str, tuple[Answerer, str]] = {
    "largest-residual": (largest_residual, ""),
    "lmfit": (lmfit_bic, "lmfit"),
    "pysindy": (pysindy_stlsq, "pysindy"),
    "faultdiagnosistoolbox": (structural, "faultdiagnosistoolbox"),
}
SHARING = frozenset(PEERS)
"""Rows that start from the same prepared case."""


def answered_by(row: str) -> Answerer:
    """Return who answers a row.

    Raises
    ------
    KeyError
        If the row is not known.
    """
    return CONTROLS[row] if row in CONTROLS else PEERS[row][0]


def prepared(case: Path) -> None:
    """Prepare what the peers share of a case; the next of them finds it done."""
    scene(case)


def missing(row: str) -> str:
    """Return the package that a row needs and that is not installed; empty if there is none."""
    needs = PEERS[row][1] if row in PEERS else ""
    return needs if needs and find_spec(needs) is None else ""


def known_rows() -> tuple[str, ...]:
    """Return all controls and peers."""
    return (*CONTROLS, *PEERS)
