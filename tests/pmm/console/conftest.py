"""One browser for all tests: each console has an origin of its own, each test a window."""

from collections.abc import Iterator

import pytest

from tests.pmm.console.chromium import Browser, browser


@pytest.fixture(scope="session")
def chromium(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    with browser(tmp_path_factory.mktemp("profile")) as one:
        yield one
