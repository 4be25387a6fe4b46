"""Spoiled campaign folders: done, or refused with a sentence; never a traceback, never a warning.

Ten thousand of them are counted by ``python -m benchmarks.boards mutations``; a sample stands here.
"""

import pytest

from benchmarks.boards.mutated import through_commands, through_the_door
from benchmarks.boards.mutations import MUTATIONS

DOOR = range(10)
COMMANDS = range(2)


@pytest.mark.sample(1)
@pytest.mark.parametrize("seed", DOOR)
def test_through_the_door_and_the_quality_checks(seed: int) -> None:
    row = through_the_door(seed)
    assert row["tracebacks"] == {}, row["mutations"]
    assert {*row["mutations"]} <= MUTATIONS.keys()


@pytest.mark.slow
@pytest.mark.parametrize("seed", COMMANDS)
def test_through_whole_commands(seed: int) -> None:
    row = through_commands(seed)
    assert row["tracebacks"] == {}, row["mutations"]
