"""What happens in each state: a function on entering it, and one that says when it is over.

All of them return at once; the loop, and with it the heartbeat, never waits.
"""

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Final

from hardware.description.kinds import RunKind
from pmm.plan.run_plan import RunPlan
from pmm.recorder.live_path import HOLD_CYCLES, LivePath
from pmm.run.conduct import Conduct, check_frequency, check_speed, check_standing
from pmm.run.errors import PulseOverdueError
from pmm.run.gate import GateState
from pmm.run.states import State

_OVERDUE_TURNS: Final = 4.5  # beyond the limit of the photocells' own drivers


def _enter_homing(c: Conduct) -> None:
    for axis in c.rig.powered():
        axis.enable()


def _homing(c: Conduct) -> State | None:
    """Home the axes that are not, one after the other as the operator or the drive goes."""
    check_standing(c, c.ramp_s)
    turns = c.rig.shaft is not None and c.rig.shaft.moving
    if turns or not all(axis.enabled for axis in c.rig.powered()):
        return None
    axes = c.rig.axes()
    if not c.command_given:
        c.command_given = True
        for axis in axes:
            if not axis.homed:
                axis.home()
    ready = all(axis.homed and not axis.moving for axis in axes)
    return State.SETTING if ready else None


def _enter_setting(c: Conduct) -> None:
    oscillator, by_axis = c.rig_file.oscillator, {*c.rig.angles}
    if c.rig.path is not None:
        by_axis.add("lines")
    c.questions.ask(c.surroundings.before(c.present, oscillator, by_axis))
    for axis in c.rig.powered():
        if not axis.enabled:
            axis.enable()


def _setting(c: Conduct) -> State | None:
    """Set the axes, after the operator has done what is asked."""
    check_standing(c)
    if not c.questions.ask_on() or not all(axis.enabled for axis in c.rig.powered()):
        return None
    if not c.command_given:
        c.command_given = True
        if c.rig.path is not None and c.present.oscillates:
            c.rig.path.follow(c.present.set_point.lines)
        for axis, wanted in c.axes():
            if c.placed.get(axis.name) != wanted:
                axis.move_to(wanted)
                c.placed[axis.name] = wanted
    ready = all(axis.settled and not axis.moving for axis, _ in c.axes())
    return State.PAUSING if ready else None


def _pausing(c: Conduct) -> State | None:
    """Wait for calm water, from the moment in which the shaft came to rest."""
    check_standing(c)
    if c.rested_since is None:
        return State.STARTING
    rested_s = (c.rig.number - c.rested_since) / c.rate_hz
    return State.STARTING if rested_s >= c.present.pause_before_s else None


def _enter_starting(c: Conduct) -> None:
    c.measurement, c.path = c.begin(c.present), LivePath(c.rig)
    if _stirs(c.present):
        c.rested_since = None
    if c.rig.carriage is None:
        point = c.present.set_point
        c.questions.ask(c.surroundings.tow(point.carriage_speed_m_s, point.turn_rate_rad_s))
    if c.present.kind is RunKind.FREE_DECAY:
        c.questions.ask(c.surroundings.hold(c.present.set_point.release_rad))


def _stirs(run: RunPlan) -> bool:
    """Tell whether a run moves the water, so that the next one waits for calm anew."""
    point = run.set_point
    return run.oscillates or run.kind is RunKind.FREE_DECAY or point.carriage_speed_m_s != 0.0


def _at_speed(c: Conduct) -> bool:
    """Bring a carriage with a driver to the run's speed; tell whether it keeps it."""
    carriage, speed = c.rig.carriage, c.carriage_speed_m_s()
    if carriage is None or not speed or c.leads:  # one that is led lags: check_speed watches it
        return True
    if not c.towed:
        c.towed = True
        carriage.run_at(speed, c.present.set_point.turn_rate_rad_s)
    return carriage.at_speed


def _starting(c: Conduct) -> State | None:
    """Bring carriage and shaft to speed, once the recorder is open: nothing moves unrecorded."""
    if not c.recording.opened(wait=c.waits) or not c.questions.ask_on() or not _at_speed(c):
        return None
    shaft = c.rig.shaft
    if not c.present.oscillates or shaft is None:
        return State.SETTLING
    if not c.command_given:
        c.command_given = True
        shaft.turn(c.present.set_point.frequency_hz)
        c.leads = c.speed_path is not None
    if not shaft.at_speed:
        return None
    if c.rig.photocell is not None:
        c.rig.photocell.expect(c.present.set_point.frequency_hz)
    return State.SETTLING


def _settling(c: Conduct) -> State | None:
    """Let the transient die out."""
    run = c.present
    wait_s = run.settling_periods / run.set_point.frequency_hz if run.oscillates else 0.0
    return State.ARMED if c.elapsed_s >= wait_s else None


def _enter_armed(c: Conduct) -> None:
    if _by_pulses(c):
        c.recording.arm()
    else:
        c.recording.open_by_time()


def _armed(c: Conduct) -> State | None:
    """Wait for the pulse that opens the gate."""
    check_frequency(c)
    check_speed(c)
    _check_overdue(c, "open")
    return State.GATE_OPEN if c.recording.gate.state is not GateState.ARMED else None


def _enter_gate_open(c: Conduct) -> None:
    if c.present.kind is RunKind.FREE_DECAY:
        c.questions.ask(c.surroundings.let_go(c.present.set_point.release_rad))


def _gate_open(c: Conduct) -> State | None:
    """Measure until the gate closes by itself, is closed, or is void."""
    check_frequency(c)
    check_speed(c)
    gate = c.recording.gate
    if not _by_pulses(c):
        _push(c)
        c.questions.ask_on()
        if c.elapsed_s >= _gate_s(c.present) and not c.questions.present:
            c.recording.close_by_time()
    else:
        _check_overdue(c, "close")
    if gate.state is GateState.ARMED:
        return State.ARMED
    return State.HOLD if gate.state is GateState.HELD else None


def _gate_s(run: RunPlan) -> float:
    """Return how long a gate without pulses is open: one period more, wherever the first begins."""
    return run.measured_s + (1.0 / run.set_point.frequency_hz if run.oscillates else 0.0)


def _hold(c: Conduct) -> State | None:
    """Wait for the last samples, then make the final reading."""
    if c.rig.number - c.since < HOLD_CYCLES:
        return None
    c.recording.finish()
    if c.present.kind is RunKind.PUSH and c.present.load is not None:
        c.recording.judge_push(c.present.load)
    return State.STOPPING


def _enter_stopping(c: Conduct) -> None:
    """Stop along the profile, and tell the photocell that no pulses are due."""
    c.rig.stop()
    c.questions.withdraw()
    if c.rig.photocell is not None:
        c.rig.photocell.expect(None)
    if c.rig.carriage is None:
        c.questions.ask(c.surroundings.tow(0.0))


def _push(c: Conduct) -> None:
    """Have a gauge pushed in the middle third of a push test."""
    run = c.present
    if run.kind is not RunKind.PUSH or run.load is None:
        return
    third_s = run.measured_s / 3.0
    if c.pushed == 0 and c.elapsed_s >= third_s:
        c.pushed = 1
        c.recording.pushing()
        c.questions.ask(c.surroundings.push(run.load.channel, run.load.force_n))
    elif c.pushed == 1 and c.elapsed_s >= 2.0 * third_s and not c.questions.present:
        c.pushed = 2
        c.recording.let_go()
        c.questions.ask(c.surroundings.push(run.load.channel, 0.0))


def _by_pulses(c: Conduct) -> bool:
    return c.present.oscillates and c.rig.photocell is not None


def _check_overdue(c: Conduct, action: str) -> None:
    """End a run whose pulses have stopped; the resolver would keep all samples for ever."""
    if not _by_pulses(c) or c.recording.gate.state is GateState.HELD:
        return
    gate, frequency_hz = c.recording.gate, c.present.set_point.frequency_hz
    last_s = gate.last_s if gate.state is GateState.OPEN else c.since / c.rate_hz
    waited_s = c.rig.number / c.rate_hz - last_s
    if waited_s * frequency_hz > _OVERDUE_TURNS:
        raise PulseOverdueError(
            "photocell",
            f"no pulse to {action} the gate for {waited_s * frequency_hz:.2f} periods "
            f"(limit {_OVERDUE_TURNS}); check lamp, slot and cable",
        )


_ENTER: Final[Mapping[State, Callable[[Conduct], None]]] = MappingProxyType(
    {
        State.HOMING: _enter_homing,
        State.SETTING: _enter_setting,
        State.STARTING: _enter_starting,
        State.ARMED: _enter_armed,
        State.GATE_OPEN: _enter_gate_open,
        State.STOPPING: _enter_stopping,
    }
)
PHASES: Final[Mapping[State, Callable[[Conduct], State | None]]] = MappingProxyType(
    {
        State.HOMING: _homing,
        State.SETTING: _setting,
        State.PAUSING: _pausing,
        State.STARTING: _starting,
        State.SETTLING: _settling,
        State.ARMED: _armed,
        State.GATE_OPEN: _gate_open,
        State.HOLD: _hold,
    }
)


def enter(c: Conduct, state: State) -> None:
    """Enter a state: note it in the recording, then do what it begins with.

    Raises
    ------
    RunStateError
        If the table of states has no such step.
    """
    c.go(state)
    if c.measurement is not None:
        c.measurement.event("state", str(state))
    if state in _ENTER:
        _ENTER[state](c)
