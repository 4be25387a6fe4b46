"""States, commands and transitions, bit by bit after CiA 402-2 (IEC 61800-7-201)."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hardware.cia402 import TRANSITIONS, DriveCommand, DriveState, state_of
from hardware.drive_state_machine import DriveStateMachine, Goal, next_command
from hardware.errors import DriveFaultError, DriveStateError, TransitionTimeoutError

# The standard's table of the status word: bits 6 5 3 2 1 0, x where a bit does not matter.
STATUS_TABLE = {
    DriveState.NOT_READY_TO_SWITCH_ON: "0x0000",
    DriveState.SWITCH_ON_DISABLED: "1x0000",
    DriveState.READY_TO_SWITCH_ON: "010001",
    DriveState.SWITCHED_ON: "010011",
    DriveState.OPERATION_ENABLED: "010111",
    DriveState.QUICK_STOP_ACTIVE: "000111",
    DriveState.FAULT_REACTION_ACTIVE: "0x1111",
    DriveState.FAULT: "0x1000",
}
# The standard's table of the control word: bits 7 3 2 1 0, and the transitions.
CONTROL_TABLE = {
    DriveCommand.SHUTDOWN: ("0x110", {2, 6, 8}),
    DriveCommand.SWITCH_ON: ("00111", {3, 5}),
    DriveCommand.ENABLE_OPERATION: ("01111", {4, 16}),
    DriveCommand.DISABLE_VOLTAGE: ("0xx0x", {7, 9, 10, 12}),
    DriveCommand.QUICK_STOP: ("0x01x", {7, 10, 11}),
    DriveCommand.FAULT_RESET: ("1xxxx", {15}),
}


def _matches(pattern: str, word: int, bits: tuple[int, ...]) -> bool:
    return all(p == "x" or int(p) == word >> bit & 1 for p, bit in zip(pattern, bits, strict=True))


@given(st.integers(0, 0xFFFF))
def test_every_status_word_shows_the_state_of_the_table(word: int) -> None:
    found = [
        s for s, pattern in STATUS_TABLE.items() if _matches(pattern, word, (6, 5, 3, 2, 1, 0))
    ]
    assert len(found) <= 1
    assert state_of(word) is (found[0] if found else DriveState.NOT_READY_TO_SWITCH_ON)


@pytest.mark.parametrize("command", list(DriveCommand))
def test_every_command_has_the_bits_and_transitions_of_the_table(command: DriveCommand) -> None:
    pattern, numbers = CONTROL_TABLE[command]
    assert _matches(pattern, command, (7, 3, 2, 1, 0))
    assert {number for (_, one), (number, _) in TRANSITIONS.items() if one is command} == numbers


def tick(walk: DriveStateMachine, word: int) -> int:
    """Tick the walk of an axis at rest."""
    return walk.tick(word, at_rest=True)


def test_the_way_up_is_06_07_0f() -> None:
    walk = DriveStateMachine("axis", 10, 100)
    walk.head_for(Goal.ENABLED)
    words = [0x0250, 0x0231, 0x0233, 0x0237, 0x0237]
    assert [tick(walk, word) for word in words] == [0x06, 0x07, 0x0F, 0x0F, 0x0F]
    assert walk.arrived


def test_the_way_down_is_00_and_a_quick_stop_02() -> None:
    walk = DriveStateMachine("axis", 10, 100)
    walk.head_for(Goal.ENABLED)
    tick(walk, 0x0237)
    walk.head_for(Goal.QUICK_STOPPED)
    assert [tick(walk, word) for word in (0x0237, 0x0217)] == [0x02, 0x02]
    assert walk.arrived
    walk.head_for(Goal.ENABLED)
    assert [tick(walk, w) for w in (0x0217, 0x0250, 0x0231)] == [0x00, 0x06, 0x07]
    walk.head_for(Goal.DISABLED)
    assert [tick(walk, word) for word in (0x0233, 0x0250)] == [0x00, 0x00]
    assert walk.arrived


def test_a_fault_is_told_once_and_reset_by_a_rising_edge_only() -> None:
    walk = DriveStateMachine("axis", 10, 100)
    walk.head_for(Goal.ENABLED)
    tick(walk, 0x0237)
    with pytest.raises(DriveFaultError, match="0x021F"):
        tick(walk, 0x021F)
    assert [tick(walk, word) for word in (0x0218, 0x0218)] == [0x00, 0x00]
    walk.reset_fault()
    assert [tick(walk, word) for word in (0x0218, 0x0218, 0x0250)] == [
        0x00,
        0x80,
        0x00,
    ]
    assert walk.state is DriveState.SWITCH_ON_DISABLED
    assert walk.goal is Goal.DISABLED
    assert tick(walk, 0x0250) == 0x00


def test_a_fault_that_is_back_at_once_after_its_reset_is_told_anew() -> None:
    walk = DriveStateMachine("axis", 10, 100)
    with pytest.raises(DriveFaultError):
        tick(walk, 0x0218)
    walk.reset_fault()
    assert [tick(walk, word) for word in (0x0218, 0x0218, 0x0250)] == [0x00, 0x80, 0x00]
    with pytest.raises(DriveFaultError, match="0x0218"):
        tick(walk, 0x0218)


def test_a_fault_that_stays_is_told_after_the_reset_has_had_its_cycles() -> None:
    walk = DriveStateMachine("axis", 5, 100)
    with pytest.raises(DriveFaultError):
        tick(walk, 0x0218)
    walk.reset_fault()
    for _ in range(6):
        tick(walk, 0x0218)
    with pytest.raises(TransitionTimeoutError, match="5 cycles after a fault reset"):
        tick(walk, 0x0218)


@pytest.mark.parametrize("limit", [1, 5, 50])
def test_a_step_has_its_cycles_and_not_one_more(limit: int) -> None:
    walk = DriveStateMachine("axis", limit, 100)
    tick(walk, 0x0250)
    walk.head_for(Goal.ENABLED)
    for _ in range(limit):
        assert tick(walk, 0x0250) == 0x06
    with pytest.raises(TransitionTimeoutError, match=f"after {limit} cycles"):
        tick(walk, 0x0250)
    assert walk.goal is Goal.DISABLED


def test_a_drive_that_leaves_by_itself_is_noticed_at_once_and_not_enabled_again() -> None:
    walk = DriveStateMachine("axis", 10, 100)
    walk.head_for(Goal.ENABLED)
    tick(walk, 0x0237)
    with pytest.raises(DriveStateError, match="SWITCH_ON_DISABLED"):
        tick(walk, 0x0250)
    assert tick(walk, 0x0250) == 0x00


@pytest.mark.parametrize("goal", list(Goal))
@pytest.mark.parametrize(
    "state", [s for s in DriveState if "FAULT" not in s.name and "NOT" not in s.name]
)
def test_every_goal_is_reached_from_every_state_by_legal_transitions(
    goal: Goal, state: DriveState
) -> None:
    walk = DriveStateMachine("axis", 10, 100)
    walk.head_for(Goal.ENABLED)  # of a drive that is to be without power a quick stop asks nothing
    walk.head_for(goal)
    for _ in range(6):
        word = next(w for w in range(0x80) if state_of(w) is state)
        command = DriveCommand(tick(walk, word))
        assert command == next_command(state, goal)
        if not walk.arrived:
            state = TRANSITIONS[state, command][1]
    assert walk.arrived
