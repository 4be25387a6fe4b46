"""Runs towed by a carriage's controller: what it really did stands beside what is recorded."""

import json
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from hardware.description.kinds import RunKind
from pmm.evaluation.rig_tests import towed_speeds
from pmm.evaluation.run_results import read_results
from pmm.recorder.replay import replay
from pmm.run.states import Command, State
from sim.devices.bench_file import DRIVERS
from sim.devices.faults import inject
from sim.drive.carriage import CarriageSettings, Fluctuation
from sim.rig import vertical_rig
from tests.pmm.run.harness import TABLES, at_rest, bench, oscillation
from tests.sim.devices.modbus_tables import CARRIAGE, DRIFT

RIPPLE = Fluctuation(relative=0.01, frequency_hz=1.3)
SPEED_M_S = 0.8
QUICK = {**CARRIAGE, "acceleration_m_s2": 2.0, "return_speed_m_s": 3.0, "tolerance_m_s": 0.02}
TOW = at_rest("tow", RunKind.STRAIGHT_TOW, speed_m_s=SPEED_M_S)


def towed(tmp_path, runs, *, ripple: tuple[Fluctuation, ...] = (), **more: Any):
    tables = {**TABLES, "carriage": QUICK, **more.pop("tables", {})}
    simulated = replace(vertical_rig(), carriage=CarriageSettings(fluctuations=ripple))
    serial = ("carriage", *more.pop("serial", ()))
    return bench(tmp_path, runs, tables=tables, simulated=simulated, serial=serial, **more)


def told(folder, kind: str) -> list[str]:
    lines = (folder / "events.jsonl").read_text().splitlines()
    return [one["text"] for one in map(json.loads, lines) if one["kind"] == kind]


@pytest.mark.slow
def test_a_run_waits_for_the_speed_and_the_carriage_comes_back(tmp_path) -> None:
    runs = [oscillation(speed_m_s=SPEED_M_S, periods=2, max_periods=2)]
    with towed(tmp_path, runs, ripple=(RIPPLE,)) as one:
        one.until(State.SETTLING)
        assert one.rig.carriage.measured_speed_m_s == pytest.approx(SPEED_M_S, abs=0.02)
        one.finish()
        assert one.control.outcomes[0].outcome == "complete", one.control.status().alarms
        assert abs(one.world.talkers["carriage"].position_m) < 0.02
        assert not told(tmp_path / "heave", "operator")
    (text,) = told(tmp_path / "heave", "carriage")
    mean, deviation = float(text.split()[0]), float(text.split()[3])
    # A sine of 1 % over 2.6 of its periods, read every few cycles.
    assert mean == pytest.approx(SPEED_M_S, rel=3e-3)
    assert deviation == pytest.approx(0.01 * SPEED_M_S / np.sqrt(2.0), rel=0.15)
    again = replay(tmp_path / "heave", DRIVERS)
    assert again.samples.shape[0] == again.recorded.shape[0]
    assert not again.differing_samples


@pytest.mark.slow
@pytest.mark.parametrize(
    ("words", "latched", "remedy"),
    [
        ("local carriage", "DriveStateError", "turn its switch to remote"),
        ("alarm carriage", "DriveFaultError", "clear its cause at its panel"),
        ("unplug carriage", "UnpluggedError", "plug in and reset"),
        ("silence carriage", "SilentPortError", "check its power, the cable and unit_id"),
        ("stale carriage", "SilentPortError", "look whether its program runs"),
    ],
)
def test_what_goes_wrong_in_a_tow_ends_at_rest(tmp_path, words, latched, remedy) -> None:
    with towed(tmp_path, [TOW]) as one:
        one.until(State.GATE_OPEN)
        inject(one.world, words)
        one.until(State.FAULT)
        assert type(one.control.fault).__name__ == latched
        assert remedy in str(one.control.fault)
        one.finish()
        assert one.world.plant.conditions.carriage_speed_m_s == 0.0
        assert not one.rig.carriage.enabled


@pytest.mark.slow
def test_after_a_lost_port_a_reset_connects_again_and_the_runs_go_on(tmp_path) -> None:
    with towed(tmp_path, [TOW, replace(TOW, name="next")]) as one:
        one.until(State.GATE_OPEN)
        inject(one.world, "unplug carriage")
        one.until(State.FAULT)
        one.finish()
        inject(one.world, "plug carriage")
        one.control.request(Command.RESET)
        assert one.control.state is State.IDLE
        one.control.request(Command.START)
        one.finish()
        assert one.control.outcomes[-1].outcome == "complete", one.control.status().alarms


def test_nobody_starts_a_carriage_that_is_in_a_persons_hand(tmp_path) -> None:
    with towed(tmp_path, [TOW], start=False) as one:
        inject(one.world, "local carriage")
        one.control.request(Command.START)
        one.until(State.FAULT)
        assert "is in a person's hand (local)" in str(one.control.fault)
        assert not one.rig.carriage.enabled


@pytest.mark.slow
def test_a_carriage_that_another_hand_slows_ends_the_run(tmp_path) -> None:
    with towed(tmp_path, [TOW]) as one:
        one.until(State.GATE_OPEN)
        one.world.plant.surround(carriage_speed_m_s=0.9 * SPEED_M_S)
        one.until(State.FAULT)
        assert type(one.control.fault).__name__ == "CarriageOffSpeedError"
        assert "0.72 m/s where the run wants 0.8 m/s" in str(one.control.fault)


@pytest.mark.slow
def test_a_track_that_ends_stops_the_carriage_before_its_end(tmp_path) -> None:
    table = {**QUICK, "track_m": [0.0, 2.0], "settle_s": 0.1}
    long = replace(TOW, duration_s=20.0)
    with towed(tmp_path, [long], tables={"carriage": table}) as one:
        one.until(State.FAULT)
        assert type(one.control.fault).__name__ == "TrackEndError"
        one.finish()
        assert 1.5 < one.world.talkers["carriage"].position_m < 2.0


@pytest.mark.slow
def test_a_carriage_that_cannot_go_back_is_brought_back(tmp_path) -> None:
    table = {key: one for key, one in QUICK.items() if key != "track_m"}
    table["registers"] = {k: v for k, v in QUICK["registers"].items() if k != "position"}
    with towed(tmp_path, [TOW], tables={"carriage": table}) as one:
        one.finish()
        assert one.control.outcomes[0].outcome == "complete", one.control.status().alarms
    (asked,) = told(tmp_path / "tow", "operator")
    assert asked.startswith("carriage: bring it back to its start")


@pytest.mark.slow
def test_a_drift_table_is_set_and_nobody_is_asked(tmp_path) -> None:
    zero = at_rest("zero", RunKind.ZERO, drift_rad=0.1)
    runs = [zero, at_rest("drift", RunKind.STATIC_DRIFT, drift_rad=0.1)]
    with towed(tmp_path, runs, tables={"drift": DRIFT}, serial=("drift",)) as one:
        one.finish()
        assert [each.outcome for each in one.control.outcomes] == ["complete", "complete"]
        assert one.world.plant.conditions.drift_rad == pytest.approx(0.1, abs=2e-4)
        assert one.rig.angles["drift"].reading.value == pytest.approx(0.1, abs=2e-4)
        assert not told(tmp_path / "drift", "operator")


@pytest.mark.slow
def test_the_report_tells_how_the_carriage_ran(tmp_path) -> None:
    with towed(tmp_path, [TOW], ripple=(RIPPLE,)) as one:
        one.finish()
    (row,) = towed_speeds(read_results(tmp_path))
    assert (row.run, row.speed_m_s) == ("tow", SPEED_M_S)
    assert row.mean_m_s == pytest.approx(SPEED_M_S, rel=3e-3)
    assert row.deviation_m_s == pytest.approx(0.01 * SPEED_M_S / np.sqrt(2.0), rel=0.15)
    assert abs(row.off_percent) < 0.3
