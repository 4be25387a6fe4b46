"""Every row of the table in ``docs/safety.md``: injected, and what comes of it.

Each ends with the axes at rest, the fault latched, the data readable, and the cause named.
"""

import json
from pathlib import Path

import pytest

from analysis.readers import read_recording
from hardware.errors import NotReadyError
from pmm.plan.rig_tables import Gauge
from pmm.recorder.disk import DiskFullError
from pmm.recorder.recording import read_run
from pmm.run.states import Command, RunStateError, State
from sim.devices.faults import inject
from tests.pmm.run.harness import TABLES, Bench, bench, oscillation

# What is injected while the gate is open, the fault that is latched, and what its message names.
FAULTS = [
    ("heartbeat phase", "HeartbeatLostError", "no heartbeat of node 3"),
    ("silence eccentricity", "ProcessDataLostError", "no TPDO"),
    ("emergency eccentricity 4210", "EmergencyError", "0x4210"),
    ("drive-fault shaft 2310", "DriveFaultError|EmergencyError", "2310"),
    ("block shaft", "FollowingError", "outside its window"),
    ("push force_fore 480", "BridgeSaturatedError", "full scale 490"),
    ("broken force_aft", "SensorInvalidError", "not valid"),
    ("missed 1000", "PhotocellDeadError", "no pulse for 3.5"),
    ("error-frame 17", "ErrorFramesError", "error frames"),
]
LOST_BUS = [
    ("bus-off", "BusOffError", "bus"),
    ("deaf", "DeadReceiveThreadError", "bus"),
]


def run_into(one: Bench, words: str) -> float:
    """Inject a fault in the open gate and go on until nothing happens; return when it came."""
    one.until(State.GATE_OPEN)
    for _ in range(130):
        one.control.step()
    inject(one.world, words)
    came_s = one.world.time_s
    one.finish()
    return came_s


def names(one: Bench) -> str:
    return type(one.control.fault).__name__


def recorded_to(folder: Path) -> float:
    """Return the time of the last sample that is readable."""
    return float(read_recording(folder / "heave" / "run.nc").end_s)


@pytest.mark.sample(4)
@pytest.mark.parametrize(("words", "kinds", "said"), FAULTS)
def test_a_fault_stops_the_axes_keeps_the_data_and_names_its_cause(
    tmp_path: Path, words: str, kinds: str, said: str
) -> None:
    with bench(tmp_path, [oscillation(periods=30, max_periods=30), oscillation("next")]) as one:
        came_s = run_into(one, words)
        assert one.control.state is State.FAULT
        assert names(one) in kinds.split("|")
        assert said in str(one.control.fault)
        assert one.at_rest()
        assert [(o.run, o.outcome) for o in one.control.outcomes] == [("heave", "fault")]
        assert said in one.control.outcomes[0].reason
        assert recorded_to(tmp_path) >= came_s
    marker = json.loads((tmp_path / "heave" / "complete.json").read_text(encoding="utf-8"))
    assert marker["outcome"] == "fault"
    assert not (tmp_path / "next").exists()


@pytest.mark.parametrize(("words", "kinds", "said"), LOST_BUS)
def test_a_lost_bus_leaves_the_stop_to_the_drives(
    tmp_path: Path, words: str, kinds: str, said: str
) -> None:
    with bench(tmp_path, [oscillation(periods=30, max_periods=30)]) as one:
        came_s = run_into(one, words)
        assert one.control.state is State.FAULT
        assert names(one) in kinds.split("|")
        assert said in str(one.control.fault)
        assert any("emergency stop" in alarm for alarm in one.control.status().alarms)
        assert not one.rig.master.healthy  # no heartbeat any more
        for _ in range(60):  # the world without SYNC: 300 ms to the quick stop, then its ramp
            one.world.live()
        assert one.at_rest()
        assert recorded_to(tmp_path) >= came_s - 0.1


@pytest.mark.slow
def test_nothing_moves_in_a_fault_and_nothing_resumes_after_it(tmp_path: Path) -> None:
    with bench(tmp_path, [oscillation(periods=30, max_periods=30), oscillation("next")]) as one:
        run_into(one, "emergency eccentricity 4210")
        for command in (Command.START, Command.NEXT, Command.HOLD):
            with pytest.raises(RunStateError, match="fault"):
                one.control.request(command)
        with pytest.raises(NotReadyError, match="reset first"):
            one.rig.shaft.enable()
        one.control.request(Command.RESET)
        assert one.control.state is State.IDLE
        for _ in range(200):
            one.control.step()
        assert one.control.state is State.IDLE
        assert one.at_rest()
        one.control.request(Command.START)
        one.finish()
        assert [o.run for o in one.control.outcomes] == ["heave", "next"]
        assert one.control.outcomes[-1].outcome == "complete"


@pytest.mark.parametrize(("words", "void"), [("missed 1", "pulse"), ("extra", "pulses within")])
def test_a_missed_or_extra_pulse_voids_the_gate_which_is_measured_anew(
    tmp_path: Path, words: str, void: str
) -> None:
    with bench(tmp_path, [oscillation()]) as one:
        run_into(one, words)
        assert one.control.fault is None
        outcome = one.control.outcomes[0]
        assert (outcome.outcome, outcome.periods) == ("complete", 4)
        flag = next(flag for flag in outcome.flags if flag.code == "gate_void")
        assert void in flag.message
        assert flag.severity == "void"


@pytest.mark.slow
def test_the_third_void_gate_ends_the_run(tmp_path: Path) -> None:
    with bench(tmp_path, [oscillation(periods=6, max_periods=6)]) as one:
        for _ in range(3):
            one.until(State.GATE_OPEN)
            for _ in range(130):
                one.control.step()
            inject(one.world, "extra")
            one.control.step()
        one.finish()
        assert names(one) == "GateVoidError"
        assert "3 times" in str(one.control.fault)
        assert one.at_rest()


def test_a_gauge_beyond_its_safe_load_quick_stops(tmp_path: Path) -> None:
    gauges = (Gauge("force_fore", 100.0, safe_load_n=200.0),)
    with bench(tmp_path, [oscillation(periods=30, max_periods=30)], gauges=gauges) as one:
        came_s = run_into(one, "push force_fore 300")
        assert names(one) == "OverloadError"
        assert "safe load, 200 N" in str(one.control.fault)
        assert one.at_rest()
        assert recorded_to(tmp_path) - came_s < 1.0


def test_a_load_beyond_the_safe_one_makes_a_profile_stop_a_quick_one(tmp_path: Path) -> None:
    gauges = (Gauge("force_fore", 400.0, safe_load_n=485.0),)
    with bench(tmp_path, [oscillation(periods=30, max_periods=30)], gauges=gauges) as one:
        came_s = run_into(one, "push force_fore 600")  # shown as 490 N: saturated
        assert names(one) == "OverloadError"
        assert "BridgeSaturatedError" in [type(fault).__name__ for fault in one.rig.faults]
        assert one.at_rest()
        # 1 Hz at 5 Hz/s takes 0.2 s; along the profile it would take 0.5 s.
        assert recorded_to(tmp_path) - came_s < 0.35


def test_an_unplugged_photocell_stops_along_the_profile(tmp_path: Path) -> None:
    tables = {**TABLES, "photocell": {"driver": "timestamper"}}
    runs = [oscillation(periods=30, max_periods=30)]
    with bench(tmp_path, runs, tables=tables, serial=("photocell",)) as one:
        came_s = run_into(one, "unplug photocell")
        assert names(one) == "UnpluggedError"
        assert "photocell" in str(one.control.fault)
        assert one.at_rest()
        assert recorded_to(tmp_path) >= came_s


def test_a_full_disk_stops_the_run_and_keeps_what_was_flushed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with bench(tmp_path, [oscillation(periods=30, max_periods=30)]) as one:
        one.until(State.GATE_OPEN)
        for _ in range(130):
            one.control.step()

        def full(_now_s: float) -> None:
            raise DiskFullError("0 bytes are free")

        recorder = one.control.measurement.journal
        monkeypatch.setattr(recorder, "tick", full)
        came_s = one.world.time_s
        one.finish()
        assert names(one) == "DiskFullError"
        assert "0 bytes are free" in str(one.control.fault)
        assert one.at_rest()
        assert recorded_to(tmp_path) >= came_s


def test_no_room_for_a_run_is_refused_before_it_moves(tmp_path: Path) -> None:
    with bench(tmp_path, [oscillation()], reserve_mb=1e12) as one:
        one.finish()
        assert names(one) == "DiskFullError"
        assert one.at_rest()
        assert not (tmp_path / "heave").exists()


QUICKLY = (State.SETTING, State.GATE_OPEN, State.STOPPING)
PHASES = [state for state in State if state not in (State.IDLE, State.FAULT, State.STOPPED)]


@pytest.mark.sample(4)
@pytest.mark.parametrize(
    ("state", "command"),
    [
        *((state, Command.STOP) for state in PHASES),
        *((state, Command.QUICK_STOP) for state in QUICKLY),
    ],
)
def test_a_stop_in_any_phase_ends_at_rest_with_the_recording_closed(
    tmp_path: Path, state: State, command: Command
) -> None:
    with bench(tmp_path, [oscillation(pause_before_s=0.2), oscillation("next")]) as one:
        one.until(state)
        for _ in range(3):
            if one.control.state is state and state not in (State.DONE, State.HOLD):
                one.control.step()
        one.control.request(command)
        one.finish()
        assert one.control.state is State.STOPPED
        assert one.control.fault is None
        assert one.at_rest()
        assert not any(axis.enabled for axis in one.rig.powered())
        folder = tmp_path / "heave"
        if folder.exists():
            assert read_run(folder).marker["outcome"] in ("stopped", "complete")
            assert read_recording(folder / "run.nc").sample_count > 0
        assert not (tmp_path / "next").exists()
