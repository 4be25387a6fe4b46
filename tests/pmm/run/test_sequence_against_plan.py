"""What is planned is what is run: periods, targets, pauses, and the operator's commands."""

from collections.abc import Callable
from concurrent.futures import Executor, Future
from pathlib import Path
from typing import Any

import pytest

from analysis.readers import read_recording
from hardware.description.kinds import RunKind
from pmm.run.gate import GateState
from pmm.run.states import Command, RunStateError, State
from tests.pmm.run.harness import at_rest, bench, oscillation


@pytest.mark.slow
def test_a_target_that_is_met_ends_the_gate_and_one_that_is_not_ends_at_the_limit(
    tmp_path: Path,
) -> None:
    runs = [
        oscillation("easy", periods=3, max_periods=12, target_relative=0.05),
        oscillation("hard", periods=3, max_periods=6, target_relative=1e-9),
    ]
    with bench(tmp_path, runs) as one:
        one.finish()
        easy, hard = one.control.outcomes
    assert (easy.outcome, easy.periods) == ("complete", 3)
    assert (hard.outcome, hard.periods) == ("complete", 6)
    for row in easy.harmonics:
        if row.unit == "N":
            assert row.final
            assert row.half_width < 0.05 * row.amplitude


@pytest.mark.slow
def test_a_middling_target_is_met_in_between(tmp_path: Path) -> None:
    with bench(tmp_path, [oscillation(periods=3, max_periods=40)]) as one:
        one.finish()
        widths = [r.half_width / r.amplitude for r in one.control.outcomes[0].harmonics[1:]]
    # The half-width falls with the square root of the periods, and Student's t with it.
    target = 0.8 * max(widths) * (40 / 12) ** 0.5
    run = oscillation("again", periods=3, max_periods=40, target_relative=target)
    with bench(tmp_path, [run]) as one:
        one.finish()
        assert 3 < one.control.outcomes[0].periods < 40


@pytest.mark.slow
def test_hold_closes_the_gate_at_the_next_pulse_and_reset_measures_anew(tmp_path: Path) -> None:
    with bench(tmp_path, [oscillation(periods=30, max_periods=30)]) as one:
        one.until(State.GATE_OPEN)
        for _ in range(250):
            one.control.step()
        one.control.request(Command.RESET)
        assert one.control.state is State.ARMED
        assert one.control.measurement.gate.state is GateState.ARMED
        one.until(State.GATE_OPEN)
        for _ in range(350):
            one.control.step()
        one.control.request(Command.HOLD)
        one.finish()
        assert (one.control.outcomes[0].outcome, one.control.outcomes[0].periods) == ("complete", 4)


@pytest.mark.slow
def test_next_leaves_a_run_and_goes_on(tmp_path: Path) -> None:
    with bench(tmp_path, [oscillation(periods=30, max_periods=30), oscillation("next")]) as one:
        one.until(State.GATE_OPEN)
        one.control.request(Command.NEXT)
        one.finish()
        assert [o.outcome for o in one.control.outcomes] == ["stopped", "complete"]
        assert one.control.state is State.DONE
        assert not any(axis.enabled for axis in one.rig.powered())
        with pytest.raises(RunStateError, match="start is refused in state done"):
            one.control.request(Command.START)


@pytest.mark.slow
def test_the_pause_is_counted_from_the_moment_the_shaft_rests(tmp_path: Path) -> None:
    runs = [oscillation("one"), oscillation("two", pause_before_s=3.0)]
    with bench(tmp_path, runs) as one:
        one.until(State.DONE)
        rested_s = one.world.time_s
        one.until(State.STARTING)
        assert one.world.time_s - rested_s == pytest.approx(3.0, abs=0.1)


@pytest.mark.slow
def test_each_tow_waits_for_the_water_that_the_one_before_has_stirred(tmp_path: Path) -> None:
    tow = {"speed_m_s": 1.0, "pause_before_s": 3.0}
    runs = [at_rest(name, RunKind.STRAIGHT_TOW, **tow) for name in ("one", "two", "three")]
    with bench(tmp_path, runs) as one:
        for _ in range(2):
            one.until(State.DONE)
            rested_s = one.world.time_s
            one.until(State.STARTING)
            assert one.world.time_s - rested_s == pytest.approx(3.0, abs=0.1)


@pytest.mark.slow
def test_a_record_at_rest_is_as_long_as_planned_and_has_no_gap(tmp_path: Path) -> None:
    with bench(tmp_path, [at_rest("zero", RunKind.ZERO, 2.0)]) as one:
        one.finish()
    recording = read_recording(tmp_path / "zero" / "run.nc")
    assert recording.sample_count / recording.sample_rate_hz > 2.0
    assert not any(flag.code == "gap" for flag in recording.flags)


class Slow(Executor):
    """Does nothing until it is told to."""

    def __init__(self) -> None:
        self.waiting: list[Callable[[], None]] = []

    def submit(self, fn: Callable[..., Any], /, *given: Any, **named: Any) -> "Future[Any]":
        future: Future[Any] = Future()
        self.waiting.append(lambda: future.set_result(fn(*given, **named)))
        return future


def test_a_run_is_not_started_anew_while_its_recording_is_being_completed(tmp_path: Path) -> None:
    with bench(tmp_path, [oscillation("a"), oscillation("b")]) as one:
        slow = one.control._closer.executor = Slow()
        one.until(State.GATE_OPEN)
        one.control.request(Command.STOP)
        one.until(State.STOPPED)
        with pytest.raises(RunStateError, match="recording is still being completed"):
            one.control.request(Command.START)
        slow.waiting.pop()()
        one.control.step()
        one.control.request(Command.START)
        assert one.control.status().run == "b"
        one.control.request(Command.STOP)
        one.until(State.STOPPED)
