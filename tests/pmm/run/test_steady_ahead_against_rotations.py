"""A run whose carriage the program leads: what was recorded, turned into the model point by point.

The rotations are those of ``tests/analysis/response/test_steady_ahead_against_rotations.py``.
"""

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from analysis.coefficients.strut_cycle import measured_cycle
from analysis.readers import read_recording
from analysis.resolver.analysis import analyse
from analysis.resolver.reference_choice import ReferenceChoice
from analysis.resolver.settings import ResolverSettings
from analysis.response.pure_rotation import pure_rotation
from hardware.description.carriage_path import CarriagePath
from hardware.description.channels import CARRIAGE_SPEED, DISPLACEMENTS, FORCES
from hardware.description.oscillator import HORIZONTAL_1963
from pmm.recorder.replay import replay
from pmm.run.states import State
from sim.devices.bench_file import DRIVERS
from tests.pmm.run.harness import bench, oscillation
from tests.sim.devices.modbus_tables import CARRIAGE
from tests.sim.devices.test_paths_against_exact_struts import BARE, PATHS

HZ, SPEED, AMPLITUDE, RATE_HZ = 0.4, 0.8, 0.15, 100.0
LAG_S = 0.1  # of the simulated drive 0.05 s, of cycle and request the rest
QUICK = {**CARRIAGE, "acceleration_m_s2": 2.0, "return_speed_m_s": 3.0}
LINES = pure_rotation(HORIZONTAL_1963, HZ, SPEED, AMPLITUDE, steady_ahead=True)
# Of the speed. What is told comes a cycle sooner or later by turns: 0.01 s of 0.2 m/s2 and as much
# of a ripple; without a lead it lags by 0.1 s.
LEFT, LAGS = 5e-3, 1.5e-2


def made(folder: Path, lag_s: float) -> Path:
    yaw = oscillation("yaw", HZ, periods=2, max_periods=2, speed_m_s=SPEED)
    point = replace(
        yaw.set_point,
        eccentricity_m=AMPLITUDE,
        strut_phase_rad=0.0,
        lines=LINES,
        steady_ahead=True,
    )
    tables = {**PATHS, "carriage": {**QUICK, "lag_s": lag_s}}
    run = replace(yaw, set_point=point)
    with bench(folder, [run], tables=tables, simulated=BARE, serial=("carriage",)) as one:
        one.finish(20000)
        assert one.control.state is State.DONE
        assert not one.rig.faults
    return folder / "yaw"


@pytest.mark.slow
@pytest.mark.parametrize(("lag_s", "low", "high"), [(LAG_S, 0.0, LEFT), (0.0, LAGS, 0.04)])
def test_the_model_keeps_its_speed_but_for_the_lag(
    tmp_path: Path, lag_s: float, low: float, high: float
) -> None:
    folder = made(tmp_path, lag_s)
    recorded = read_recording(folder / "run.nc")
    point = recorded.set_point
    path = CarriagePath.of(HORIZONTAL_1963, point)
    settings = ResolverSettings((*DISPLACEMENTS, *FORCES, CARRIAGE_SPEED.name), harmonics=6)
    analysis = analyse(recorded, ReferenceChoice(), settings)
    cycle = measured_cycle(analysis, HORIZONTAL_1963).model()
    sizes = {
        name: np.array([abs(cycle.phasors.values[cycle.phasors.index(f"{name} {n}")])
                        for n in range(7)])
        for name in ("ahead", "across")
    }  # fmt: skip
    assert sizes["ahead"][0] == pytest.approx(SPEED, rel=2e-3)
    assert low * SPEED <= sizes["ahead"][1:].max() < high * SPEED
    assert sizes["across"].max() < high * SPEED
    angle, speed = recorded.values("shaft_angle"), recorded.values("carriage_speed")
    even = np.flatnonzero(np.abs(np.diff(angle) - 2.0 * math.pi * HZ / RATE_HZ) < 1e-9)[:-300]
    told = np.array([path.at(one) for one in angle[even]])
    off = np.abs(speed[even] - told)[-500:].max()
    assert low * SPEED <= off < high * SPEED
    assert np.ptp(told) > 0.09 * SPEED
    events = (folder / "events.jsonl").read_text(encoding="utf-8").splitlines()
    (text,) = [one["text"] for one in map(json.loads, events) if one["kind"] == "carriage"]
    assert "m/s along the model asked" in text
    assert float(text.split()[0]) == pytest.approx(path.mean_m_s, rel=5e-3)
    assert not replay(folder, DRIVERS).differing_samples
