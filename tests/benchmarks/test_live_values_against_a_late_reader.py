"""A short day of live values: what the broker took while its reader was away comes all the same."""

from pathlib import Path

import pytest

from benchmarks.live_values import day
from tests.pmm.console.live_rig import needed


@needed
@pytest.mark.slow
def test_all_that_was_taken_reaches_a_reader_that_comes_back_late(tmp_path: Path) -> None:
    found = day(tmp_path, 1e-3, lambda _: None)
    assert found.offered == 24 * 90
    assert found.lost == 0
    assert found.counted.once + found.status.dropped - found.both == found.offered
    assert found.counted.while_read == found.reached
    assert found.status.connected
