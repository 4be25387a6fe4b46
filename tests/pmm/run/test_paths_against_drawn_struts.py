"""Runs whose struts the program leads: recorded as told and as moved, by drawn geometry."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from analysis.readers import read_recording
from analysis.response.multisine import multisine
from analysis.response.pure_rotation import pure_rotation
from hardware.description.lines import struts_over_turn
from hardware.description.oscillator import HORIZONTAL_1963
from hardware.rig_configuration import read_rig
from pmm.plan.limits import limit_findings
from pmm.plan.sensors import resolutions
from pmm.run.states import State
from sim.devices.bench_file import DRIVERS
from tests.exact.drawn_struts import drawn
from tests.pmm.plan.plans import rig_file
from tests.pmm.run.harness import bench, oscillation
from tests.sim.devices.test_paths_against_exact_struts import BARE, PATHS

HZ, SPEED, AMPLITUDE = 1.0, 0.8, 0.05
PURE = pure_rotation(HORIZONTAL_1963, HZ, SPEED, AMPLITUDE)
# Of the bow's speed, by what drives at 0.5 Hz lag and by the encoders' micrometre.
IMPURE = 2e-3


@pytest.mark.slow
def test_an_exact_yaw_then_many_lines_without_anybody_loading_tables(tmp_path: Path) -> None:
    yaw = oscillation("yaw", HZ, periods=1, max_periods=1, speed_m_s=SPEED)
    point = replace(yaw.set_point, eccentricity_m=AMPLITUDE, strut_phase_rad=0.0, lines=PURE)
    lines = multisine((1, 3), np.array([1.0, 0.3]))
    other = replace(point, eccentricity_m=0.02, carriage_speed_m_s=0.0, lines=lines)
    runs = [replace(yaw, set_point=point), replace(yaw, name="sway", set_point=other)]
    with bench(tmp_path, runs, tables=PATHS, simulated=BARE) as one:
        one.finish(20000)
        assert one.control.state is State.DONE
        assert not one.rig.faults
    recorded = read_recording(tmp_path / "yaw" / "run.nc")
    assert recorded.set_point == point
    turn = last_turn(recorded.values("shaft_angle"))
    for kind, allowed in (("command", 1e-6), ("displacement", IMPURE)):
        struts = np.array([recorded.values(f"{kind}_{one}")[turn] for one in ("aft", "fore")])
        _, rate, across = drawn(HORIZONTAL_1963, SPEED, struts, HZ)
        bow = HORIZONTAL_1963.half_spacing_m * np.abs(rate).max()
        assert np.abs(across).max() < allowed * bow
    sway = read_recording(tmp_path / "sway" / "run.nc")
    turn = last_turn(sway.values("shaft_angle"))
    angle = sway.values("shaft_angle")[turn] % (2.0 * math.pi)
    fine = 0.02 * struts_over_turn(lines, least=100_000)[0]
    told = fine[np.round(angle / (2.0 * math.pi) * len(fine)).astype(int) % len(fine)]
    assert sway.values("command_aft")[turn] == pytest.approx(told, abs=1e-5)
    assert "follow" not in (tmp_path / "sway" / "events.jsonl").read_text(encoding="utf-8")


def last_turn(angle: np.ndarray) -> slice:
    """Return the last 100 samples, a turn, of the even part of a run's master angle."""
    even = np.flatnonzero(np.abs(np.diff(angle) - 2.0 * math.pi * HZ / 100.0) < 1e-9)
    return slice(int(even[-1]) - 99, int(even[-1]) + 1)


def test_a_plan_beyond_a_strut_s_drive_is_refused_with_strut_and_time() -> None:
    slow = {**PATHS["shaft"], "fore": {**PATHS["shaft"]["fore"], "speed": 0.3}}
    tables = {**PATHS, "shaft": slow, "bus": {"interface": "virtual", "channel": "none"}}
    rig = replace(rig_file(), oscillator=HORIZONTAL_1963, hardware=read_rig(tables, DRIVERS))
    run = oscillation("yaw", HZ, speed_m_s=SPEED)
    point = replace(run.set_point, eccentricity_m=AMPLITUDE, strut_phase_rad=0.0, lines=PURE)
    (found,) = (
        one for one in limit_findings(replace(run, set_point=point), rig) if "shaft." in one.message
    )
    turn = AMPLITUDE * np.abs(np.gradient(struts_over_turn(PURE, least=7200)[1], 1.0 / 7200)) * HZ
    at_s = turn[10:-10].argmax() / 7200 / HZ
    assert found.value == pytest.approx(turn[10:-10].max(), rel=1e-3)
    assert "strut velocity" in found.message
    told = float(found.message.split("shaft.fore: ")[1].split(" s")[0])
    assert (told - at_s) % (0.5 / HZ) == pytest.approx(0.0, abs=0.01)
    assert resolutions(rig.hardware)["displacement_aft"] == 1e-7
