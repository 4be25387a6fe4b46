"""Random commands and faults: judged by the plant's true speed, never by what is believed of it.

``python -m benchmarks.storms`` goes on from here, through as many as are asked for.
"""

import pytest

from hardware.drive_state_machine import DriveStateMachine, next_command
from hardware.motion import EncoderMotion
from tests.pmm.run.storms import Storm

EACH = 10


@pytest.mark.slow
@pytest.mark.parametrize("first", range(0, 30, EACH))
def test_nothing_moves_unwatched(first: int) -> None:
    found = [Storm(seed).run() for seed in range(first, first + EACH)]
    assert [wrong for one in found for wrong in one.wrong] == []
    assert sum(one.counts["power taken off"] for one in found) > 0


def test_a_product_that_takes_power_off_a_moving_axis_is_found(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(
        DriveStateMachine, "_command", lambda walk: next_command(walk.state, walk.goal)
    )
    assert any("lost its power" in wrong for wrong in Storm(6).run().wrong)


def test_a_product_that_believes_its_commands_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(EncoderMotion, "at_rest", property(lambda _motion: True))
    assert any("taken for one at rest" in wrong for wrong in Storm(22).run().wrong)


@pytest.mark.parametrize("seed", [380, 966])
def test_what_was_once_found_stays_mended(seed: int) -> None:
    assert Storm(seed).run().wrong == []
