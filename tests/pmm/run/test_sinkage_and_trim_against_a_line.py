"""Sinkage and trim over the rig's protocols: a tow's recording against a line turned here."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from analysis.readers import read_recording
from hardware.description.attitude import AttitudeSensors, HeaveAndPitch
from hardware.description.kinds import RunKind
from sim.acquisition.channels import Acquisition, Digitiser
from sim.model.attitude import Squat
from sim.rig import horizontal_rig
from tests.pmm.run.harness import TABLES, at_rest, bench
from tests.sim.devices.benches import amplifier

SPEED_M_S, AFT_M, FORE_M = 1.2, -0.7, 1.1
SINKS, TRIMS = 4e-3, -3.5e-3  # m and rad per (m/s)^2: down, bow down
METRES = {"unit": "m", "scale": 1e-7, "full_scale": 0.1}


@pytest.mark.slow
def test_a_towed_model_that_is_free_records_where_it_stands(tmp_path: Path) -> None:
    gauge = amplifier(6, "position_aft", "position_fore")
    gauge["channels"] = [one | METRES for one in gauge["channels"]]
    made = replace(
        horizontal_rig(),
        acquisition=Acquisition(position_aft=Digitiser(), position_fore=Digitiser()),
        attitude=AttitudeSensors(AFT_M, FORE_M, HeaveAndPitch.FREE),
        squat=Squat(z_uu=SINKS, theta_uu=TRIMS),
    )
    run = at_rest("tow", RunKind.STRAIGHT_TOW, speed_m_s=SPEED_M_S)
    tables = {**TABLES, "forces": [*TABLES["forces"], gauge]}
    with bench(tmp_path, [run], tables=tables, simulated=made) as one:
        one.finish(40000)
    recording = read_recording(tmp_path / "tow" / "run.nc")
    bow_up = np.exp(-1j * TRIMS * SPEED_M_S**2)  # x + i z, z down
    for name, x in (("position_aft", AFT_M), ("position_fore", FORE_M)):
        told = recording.values(name)[-20:].mean()
        line = SINKS * SPEED_M_S**2 + (x * bow_up).imag
        assert told == pytest.approx(line, abs=2e-5), name  # 6 and 11 mm
