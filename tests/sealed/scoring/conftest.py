"""The board that docs/sealed-scoring.md works out by hand, fresh for each test."""

from pathlib import Path

import pytest

from tests.sealed.scoring import handmade


@pytest.fixture
def board(tmp_path: Path) -> Path:
    """Return the board's folder."""
    return handmade.write(tmp_path / "board")
