"""A recording process that is killed loses a second of wall time at most, and nothing else."""

from pathlib import Path

import numpy as np
import pytest

from benchmarks.kill import kill_once

MOMENTS = np.random.default_rng(7).uniform(0.6, 2.0, 2).round(3)


@pytest.mark.slow
@pytest.mark.parametrize("after_s", [0.02, *MOMENTS])
def test_killed_while_it_records(tmp_path: Path, after_s: float) -> None:
    found = kill_once(tmp_path / "run", after_s, "60")
    assert found.valid
    assert not found.closed
    assert found.lost <= 100  # a second, at 100 Hz


def test_killed_about_when_it_closes(tmp_path: Path) -> None:
    found = kill_once(tmp_path / "run", 1.13, "1")
    assert found.valid
    assert found.lost <= 100  # a second, at 100 Hz
