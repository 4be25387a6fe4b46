"""Fails the test that leaves something behind: a bus, a port, a thread or a process."""

from collections.abc import Iterator

import pytest

from tests.hardware.leaks import Leaks


@pytest.fixture(autouse=True)
def _nothing_left_behind(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    leaks = Leaks(monkeypatch)
    yield
    left = leaks.found()
    assert not left, f"left behind: {', '.join(left)}"
