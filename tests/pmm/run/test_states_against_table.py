"""The state machine does what its table says, and nothing else."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hardware.errors import Reaction
from pmm.run.gate import Gate, GateState
from pmm.run.states import (
    FAULTS,
    STATES,
    Command,
    RunStateError,
    RunStateMachine,
    State,
    is_allowed,
)


def test_every_state_and_reaction_has_its_row_and_every_command_its_states() -> None:
    assert list(STATES) == list(State)
    assert list(FAULTS) == list(Reaction)
    assert all(any(is_allowed(command, state) for state in State) for command in Command)


def test_a_fault_is_left_by_a_reset_only_and_never_to_a_moving_state() -> None:
    assert STATES[State.FAULT].follows == (State.IDLE,)
    assert STATES[State.FAULT].commands == (Command.RESET,)


@pytest.mark.parametrize("state", sorted(set(State) - {State.FAULT}))
def test_every_state_can_fail(state: State) -> None:
    machine = RunStateMachine()
    machine.state = state
    machine.go(State.FAULT)
    with pytest.raises(RunStateError, match="no step from fault to fault; there are idle"):
        machine.go(State.FAULT)


@pytest.mark.parametrize("state", State)
def test_a_quick_stop_is_taken_in_every_state(state: State) -> None:
    assert is_allowed(Command.QUICK_STOP, state)


def test_what_stops_the_rig_is_a_fault_in_every_state() -> None:
    for reaction, row in FAULTS.items():
        if reaction >= Reaction.PROFILE_STOP:
            assert (row.leads_to, row.within) == (State.FAULT, frozenset(State))
            assert row.takes_power == (reaction >= Reaction.QUICK_STOP)


@given(st.lists(st.sampled_from(list(State)), max_size=30))
def test_no_walk_leaves_the_table(wanted: list[State]) -> None:
    machine = RunStateMachine()
    for state in wanted:
        before = machine.state
        fails = state is State.FAULT and before is not State.FAULT
        if state in STATES[before].follows or fails:
            machine.go(state)
            assert machine.state is state
        else:
            with pytest.raises(RunStateError, match=str(before)):
                machine.go(state)
            assert machine.state is before


def test_a_refused_command_names_the_states_that_allow_it() -> None:
    machine = RunStateMachine()
    machine.go(State.HOMING)
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
