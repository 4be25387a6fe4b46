"""The sensors in the campaign that run control leaves: those of the devices and the records."""

import math
from dataclasses import replace
from datetime import date
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hardware.description.channels import Channel
from pmm.campaign.calibration import Calibration
from pmm.campaign.campaign import Campaign
from pmm.campaign.campaign_file import read_campaign
from pmm.plan.campaign_writer import FinishedRun, write_campaign
from pmm.plan.plan import read_plan_and_rig
from pmm.plan.rig_file import RigFile
from pmm.plan.sensors import acquisition_table, resolutions
from pmm.recorder.recording import white_noise_rms
from sim.acquisition.channels import Digitiser
from tests.pmm.plan.plans import EXAMPLES, HEAVE, RIG_TEXT, write_plan

FORCE = Channel("force_aft", "N", 500.0)
NONE: tuple[dict[str, float], ...] = ()


def example() -> RigFile:
    return read_plan_and_rig(EXAMPLES / "vertical" / "plan.toml")[1]


@given(
    rms=st.floats(1e-6, 1e3),
    offset=st.floats(-1e3, 1e3),
    slope=st.floats(-0.01, 0.01),
    seed=st.integers(0, 100),
)
def test_the_noise_is_that_of_the_samples_whatever_the_zero_does(
    rms: float, offset: float, slope: float, seed: int
) -> None:
    count = 4000
    noise = rms * np.random.default_rng(seed).standard_normal(count)
    samples = np.vstack([noise + rms * (offset + slope * np.arange(count)), np.zeros(count)])
    samples[0, 7] = math.nan
    found = white_noise_rms(samples)
    # The variance of differences of white noise is known to sqrt(3 / n): five times that.
    assert found[0] == pytest.approx(rms, rel=2.5 * math.sqrt(3.0 / count) + slope**2)
    assert found[1] == 0.0


def test_a_channel_without_samples_has_no_noise() -> None:
    assert np.isnan(white_noise_rms(np.full((2, 10), math.nan))).all()
    assert np.isnan(white_noise_rms(np.zeros((1, 1)))).all()


def test_the_step_is_that_of_the_counts() -> None:
    found = resolutions(example().hardware)
    assert found == {
        "shaft_angle": 2.0 * math.pi / 65536.0,
        "force_aft": 1e-3,
        "force_fore": 1e-3,
        "displacement_aft": 1e-7,
        "displacement_fore": 1e-7,
    }


def test_a_float_object_has_no_step(tmp_path: Path) -> None:
    """Object 6130 of the amplifier's EDS is a REAL32: its scale is no step."""
    mapped = 'node = 4\ntpdos = [["6130:1", "6130:2"], ["6150:1", "6150:2"]]'
    text = RIG_TEXT.replace("node = 4", mapped)
    head, tail = text.split("node = 5")
    text = f"{head.replace('9130:', '6130:')}node = 5{tail}"
    rig = read_plan_and_rig(write_plan(tmp_path, HEAVE, text))[1]
    assert set(resolutions(rig.hardware)) == {
        "shaft_angle",
        "displacement_aft",
        "displacement_fore",
    }


def test_noise_is_the_usual_one_without_the_rounding() -> None:
    seen = tuple({"force_aft": one, "shaft_angle": 1e-6} for one in (0.05, 0.051, 4.0))
    found = acquisition_table(example(), (FORCE, Channel("shaft_angle", "rad")), seen)
    assert found["force_aft"]["noise_rms"] == pytest.approx(math.sqrt(0.051**2 - 1e-6 / 12.0))
    assert "noise_rms" not in found["shaft_angle"], "below its step"
    assert found["force_aft"]["full_scale"] == 500.0
    assert found["force_fore"] is False


def test_what_the_rig_states_goes_before_but_not_that_a_recorded_sensor_is_missing() -> None:
    stated = {"force_aft": {"noise_rms": 0.2, "delay_s": 0.001}, "force_x": {"noise_rms": 1.0}}
    rig = replace(example(), campaign={"acquisition": {**stated, "force_fore": False}})
    recorded = (FORCE, Channel("force_fore", "N", 500.0))
    found = acquisition_table(rig, recorded, ({"force_aft": 0.05},))
    assert (found["force_aft"]["noise_rms"], found["force_aft"]["delay_s"]) == (0.2, 0.001)
    assert found["force_fore"] == {"resolution": 1e-3, "full_scale": 500.0}
    assert found["force_x"] is False, "stated, and not recorded"


def test_the_noise_of_a_calibrated_gauge_is_that_of_its_force() -> None:
    day, none = date(2026, 1, 1), np.zeros((2, 2))
    matrix = np.array([[2.0, 0.0], [0.0, 1.0]])
    known = Calibration(("force_aft", "force_fore"), matrix, none, none[0], none[0], day, day)
    rig = replace(example(), calibration=known)
    recorded = (FORCE, Channel("force_fore", "N", 500.0))
    found = acquisition_table(rig, recorded, ({"force_aft": 0.1, "force_fore": 0.1},))
    assert found["force_aft"]["noise_rms"] == pytest.approx(0.05, rel=1e-4)
    assert found["force_fore"]["noise_rms"] == pytest.approx(0.1, rel=1e-4)
    assert set(found["force_aft"]) == {"noise_rms"}
    # Both make each force, so both have to be known.
    alone = acquisition_table(rig, recorded, ({"force_aft": 0.1},))
    assert alone["force_aft"] == {}


def _left(tmp_path: Path, text: str, **made: Any) -> Campaign:
    plan, rig = read_plan_and_rig(write_plan(tmp_path, HEAVE, text))
    done = [FinishedRun(one, f"{one.name}/run.nc", **made) for one in plan.runs]
    return read_campaign(write_campaign(tmp_path, plan, rig, done))


def test_the_campaign_has_what_was_recorded(tmp_path: Path) -> None:
    found = _left(tmp_path, RIG_TEXT, channels=(FORCE,), noise_rms={"force_aft": 0.05})
    assert found.acquisition.force_fore is None
    assert found.acquisition.force_aft is not None
    assert found.acquisition.force_aft.noise_rms == pytest.approx(0.05, rel=1e-3)
    assert found.dynamometers.fore.full_scale_n == 500.0
    assert found.simulation.sample_rate_hz == 100.0
    assert found.photocell is not None


def test_a_rig_without_a_photocell_says_so(tmp_path: Path) -> None:
    text = RIG_TEXT.replace('[photocell]\ndriver = "touch-probe"\n', "")
    text += "[campaign.photocell]\njitter_rms_s = 1e-4\n[campaign.dynamometers.aft]\ngain = 1.01\n"
    found = _left(tmp_path, text)
    assert found.photocell is None
    assert (found.dynamometers.aft.gain, found.dynamometers.aft.full_scale_n) == (1.01, 500.0)
    assert found.acquisition.force_fore == Digitiser(), "no record says which sensors there are"
