"""A device that talks by itself, and a rig whose photocell it is."""

from collections.abc import Iterator

import pytest

from hardware.rig import Rig
from tests.hardware.rigs import Talker, open_rig


@pytest.fixture
def talker() -> Iterator[Talker]:
    with Talker() as one:
        yield one


@pytest.fixture
def cell(talker: Talker) -> Iterator[Rig]:
    table = {"driver": "timestamper", "port": {"url": talker.url}, "silent_s": 1.0}
    with open_rig({"photocell": table}) as rig:
        yield rig
