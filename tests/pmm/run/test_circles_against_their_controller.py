"""Circles by a carriage's controller, and by hand: what really turned beside what is recorded."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from analysis.readers import read_recording
from hardware.description.kinds import Motion, RunKind
from hardware.description.setpoint import SetPoint
from pmm.run.states import State
from pmm.run.surroundings import Surroundings
from sim.rig import horizontal_rig
from tests.pmm.run.harness import TABLES, RunPlan, bench
from tests.sim.devices.modbus_tables import CARRIAGE

SPEED_M_S, RATE_RAD_S = 0.8, -0.16
TURNING = {
    **{key: one for key, one in CARRIAGE.items() if key != "track_m"},
    "acceleration_m_s2": 2.0,
    "tolerance_m_s": 0.02,
    "highest_turn_rate_rad_s": 0.5,
    "registers": {
        **{key: one for key, one in CARRIAGE["registers"].items() if key != "position"},
        "set_turn_rate": {"address": 104, "unit": "deg/s", "type": "int32", "scale": 1e-3},
        "turn_rate": {"address": 20, "unit": "rad/s", "type": "float32", "table": "input"},
    },
}
POINT = SetPoint(0.0, 0.0, 0.0, SPEED_M_S, turn_rate_rad_s=RATE_RAD_S)
CIRCLE = RunPlan("round", RunKind.CIRCLE, Motion.NONE, POINT, duration_s=1.0)


def circling(tmp_path: Path, run: RunPlan = CIRCLE):
    tables = {**TABLES, "carriage": TURNING}
    return bench(tmp_path, [run], tables=tables, simulated=horizontal_rig(), serial=("carriage",))


@pytest.mark.slow
def test_the_circle_is_kept_on_the_ramps_and_recorded(tmp_path) -> None:
    with circling(tmp_path) as one:
        plant, radii = one.world.plant, []
        while not one.control.finished:
            one.control.step()
            around = plant.conditions
            if around.carriage_speed_m_s:
                radii.append(around.carriage_speed_m_s / around.turn_rate_rad_s)
        assert one.control.outcomes[0].outcome == "complete", one.control.status().alarms
        assert plant.conditions.turn_rate_rad_s == 0.0
    # The register counts thousandths of a degree a second.
    assert np.array(radii) == pytest.approx(SPEED_M_S / RATE_RAD_S, rel=2e-4)
    recording = read_recording(tmp_path / "round" / "run.nc")
    assert np.median(recording.values("turn_rate")) == pytest.approx(RATE_RAD_S, rel=2e-4)


@pytest.mark.slow
def test_a_carriage_that_leaves_the_circle_ends_the_run(tmp_path) -> None:
    with circling(tmp_path, replace(CIRCLE, duration_s=5.0)) as one:
        one.until(State.GATE_OPEN)
        one.world.plant.surround(turn_rate_rad_s=0.8 * RATE_RAD_S)
        one.until(State.FAULT)
        assert type(one.control.fault).__name__ == "CarriageOffSpeedError"
        assert "turns at -0.128 rad/s where the run wants -0.16 rad/s" in str(one.control.fault)


def test_an_operator_is_told_radius_side_and_rate() -> None:
    around = Surroundings()
    (ask,) = around.tow(SPEED_M_S, RATE_RAD_S)
    assert "on a circle of 5 m to port, 0.16 rad/s (9.17 deg/s)" in ask
    assert ask.turn_rate_rad_s == RATE_RAD_S
    (stop,) = around.tow(0.0)
    assert stop.turn_rate_rad_s == 0.0
    assert not list(around.tow(0.0))
