"""The state machine does what its table says, and nothing else."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pmm.run.gate import Gate, GateState
from pmm.run.states import ALLOWED, TRANSITIONS, Command, Machine, RunStateError, State


def test_every_state_has_its_row_and_every_command_its_states() -> None:
    assert set(TRANSITIONS) == set(State)
    assert set(ALLOWED) == set(Command)


def test_a_fault_is_left_by_a_reset_only_and_never_to_a_moving_state() -> None:
    assert TRANSITIONS[State.FAULT] == {State.IDLE}
    assert State.FAULT in ALLOWED[Command.RESET]
    assert State.FAULT not in ALLOWED[Command.START]


@pytest.mark.parametrize("state", sorted(set(State) - {State.FAULT}))
def test_every_state_can_fail(state: State) -> None:
    assert State.FAULT in TRANSITIONS[state]


@given(st.lists(st.sampled_from(list(State)), max_size=30))
def test_no_walk_leaves_the_table(wanted: list[State]) -> None:
    machine = Machine()
    for number, state in enumerate(wanted):
        before = machine.state
        if state in TRANSITIONS[before]:
            machine.go(state, number)
            assert (machine.state, machine.since) == (state, number)
        else:
            with pytest.raises(RunStateError, match=str(before)):
                machine.go(state, number)
            assert machine.state is before


def test_a_refused_command_names_the_states_that_allow_it() -> None:
    machine = Machine()
    machine.go(State.HOMING, 1)
    with pytest.raises(RunStateError, match=r"start is refused in state homing; .*idle, stopped"):
        machine.check(Command.START)


@given(st.integers(1, 20), st.integers(0, 40))
def test_the_gate_counts_whole_periods_between_pulses(wanted: int, pulses: int) -> None:
    gate = Gate(wanted)
    gate.arm()
    for k in range(pulses):
        gate.pulse(float(k))
    assert gate.periods == min(max(pulses - 1, 0), wanted)
    if pulses > wanted:
        assert (gate.state, gate.opened_s, gate.closed_s) == (GateState.HELD, 0.0, float(wanted))


def test_hold_closes_at_the_next_pulse_and_reset_forgets() -> None:
    gate = Gate(10)
    gate.arm()
    for time_s in (1.0, 2.0, 3.0):
        gate.pulse(time_s)
    gate.hold()
    gate.pulse(4.0)
    assert (gate.state, gate.periods, gate.closed_s) == (GateState.HELD, 3, 4.0)
    gate.pulse(5.0)
    assert gate.periods == 3
    gate.arm()
    assert (gate.state, gate.periods) == (GateState.ARMED, 0)
