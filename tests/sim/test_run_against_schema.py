"""Oracle: the dataset schema, the set-point's limits, and the parameters that went in."""

import json
import math
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from pydantic import TypeAdapter, ValidationError

from hardware.description import channels
from hardware.description import dataset as schema
from hardware.description.errors import ConfigurationError
from hardware.description.setpoint import Medium, SetPoint
from sim.drive.prescribed_drive import DriveSettings
from sim.gauges.dynamometer import Dynamometer, Dynamometers
from sim.rig import SimulatedRig, horizontal_rig, vertical_rig
from sim.run import simulate

SET_POINT = SetPoint(0.9, 0.03, 0.4, carriage_speed_m_s=1.1)


def test_dataset_follows_the_schema(tmp_path: Path) -> None:
    run = simulate(vertical_rig(), SET_POINT, periods=5, seed=3, name="heave 1")
    path = tmp_path / "run.nc"
    run.to_netcdf(path, engine="h5netcdf")
    with xr.open_dataset(path, engine="h5netcdf") as kept:
        xr.testing.assert_identical(kept.load(), run)
    assert run.attrs[schema.ATTR_SCHEMA] == schema.SCHEMA
    assert run.attrs[schema.ATTR_NAME] == "heave 1"
    assert run.attrs[schema.ATTR_SAMPLE_RATE] == 200.0
    assert SetPoint.read(json.loads(run.attrs[schema.ATTR_SET_POINT])) == SET_POINT
    assert json.loads(run.attrs[schema.ATTR_FLAGS]) == []
    provenance = json.loads(run.attrs[schema.ATTR_PROVENANCE])
    assert provenance["seed"] == "3"
    assert all(isinstance(text, str) for text in provenance.values())
    assert TypeAdapter(SimulatedRig).validate_json(provenance["rig"]) == vertical_rig()
    np.testing.assert_allclose(np.diff(run["time"]), 1 / 200.0)
    assert run["time"][0] == 0.0
    for channel in (
        channels.SHAFT_ANGLE,
        channels.DISPLACEMENT_AFT,
        channels.DISPLACEMENT_FORE,
        channels.FORCE_AFT,
        channels.FORCE_FORE,
        channels.CARRIAGE_SPEED,
    ):
        assert run[channel.name].attrs[schema.UNITS] == channel.unit
        assert run[channel.name].dims == (schema.TIME,)
    assert run[channels.FORCE_AFT.name].attrs[schema.FULL_SCALE] == 500.0
    assert run[schema.EDGE_TIME].dims == (schema.EDGE,)


@pytest.mark.parametrize("initial_angle", [-math.pi, 0.0, 1.0, 6.2])
@pytest.mark.parametrize("frequency_hz", [0.9, 1.0])
def test_asked_for_periods_lie_between_pulses(initial_angle: float, frequency_hz: float) -> None:
    rig = replace(vertical_rig(), drive=DriveSettings(initial_angle))
    run = simulate(rig, replace(SET_POINT, frequency_hz=frequency_hz), periods=7, seed=0)
    edges = run[schema.EDGE_TIME].to_numpy()
    assert edges.size >= 8
    np.testing.assert_allclose(np.diff(edges), 1.0 / frequency_hz, rtol=1e-12)
    assert edges[0] >= 0.0
    assert edges[-1] <= run["time"][-1]


def test_pulses_and_samples_share_a_clock() -> None:
    """At a pulse the aft strut of an ideal yoke passes the middle, going down."""
    run = simulate(vertical_rig().ideal(), SET_POINT, periods=4, seed=0)
    edges = run[schema.EDGE_TIME].to_numpy()
    phase = 2.0 * math.pi * 0.9 * (run["time"].to_numpy() - edges[0])
    np.testing.assert_allclose(run["displacement_aft"], 0.03 * np.sin(phase), atol=1e-13)
    np.testing.assert_allclose(run["displacement_fore"], 0.03 * np.sin(phase + 0.4), atol=1e-13)


def test_coefficients_put_in_come_out_of_a_noisy_record() -> None:
    rig = vertical_rig()
    run = simulate(rig, SetPoint(0.8, 0.04), periods=40, seed=11)
    omega, time = 2.0 * math.pi * 0.8, run["time"].to_numpy()
    phase = omega * (time - float(run[schema.EDGE_TIME][0]))
    force = (run["force_aft"] + run["force_fore"]).to_numpy()
    columns = np.column_stack([np.sin(phase), np.cos(phase), np.ones_like(phase)])
    in_phase, quadrature, _ = np.linalg.lstsq(columns, force, rcond=None)[0]
    added = (rig.water.restoring[0][0] - in_phase / 0.04) / omega**2 - rig.body.mass_kg
    sigma = 0.05 * math.sqrt(2.0) * math.sqrt(2.0 / time.size) / 0.04
    assert added == pytest.approx(rig.water.added_mass[0][0], abs=5 * sigma / omega**2)
    damping = quadrature / (omega * 0.04)
    assert damping == pytest.approx(rig.water.damping[0][0], abs=5 * sigma / omega)


def test_same_seed_same_record_and_settling_only_shifts_it() -> None:
    one = simulate(horizontal_rig(1.5), SET_POINT, periods=3, seed=5)
    xr.testing.assert_identical(one, simulate(horizontal_rig(1.5), SET_POINT, periods=3, seed=5))
    rig = horizontal_rig(1.5).ideal()
    early = simulate(rig, SetPoint(1.0, 0.03), periods=3, settling_periods=0, seed=0)
    late = simulate(rig, SetPoint(1.0, 0.03), periods=3, settling_periods=6, seed=0)
    np.testing.assert_allclose(late["force_aft"], early["force_aft"], atol=1e-10)


def test_fewer_sensors_and_air() -> None:
    rig = vertical_rig().ideal()
    bare = replace(
        rig,
        photocell=None,
        acquisition=replace(rig.acquisition, shaft_angle=None, displacement_fore=None),
    )
    run = simulate(bare, replace(SET_POINT, medium=Medium.AIR), periods=2, seed=0)
    assert set(run.data_vars) == {"displacement_aft", "force_aft", "force_fore", "carriage_speed"}
    assert SetPoint(**json.loads(run.attrs[schema.ATTR_SET_POINT])).medium == Medium.AIR


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"frequency_hz": 2.5}, r"frequency_hz = 2\.5 is outside 0\.1 to 2"),
        ({"eccentricity_m": 0.07}, r"eccentricity_m = 0\.07"),
        ({"strut_phase_rad": math.nan}, "strut_phase_rad = nan of the set-point"),
        ({"carriage_speed_m_s": math.inf}, "carriage_speed_m_s = inf"),
        ({"frequency_hz": 2.0, "eccentricity_m": 0.06}, r"would reach .* N, beyond the 490\.3 N"),
    ],
)
def test_set_points_beyond_the_rig_are_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(ConfigurationError, match=message):
        simulate(vertical_rig(), replace(SET_POINT, **changes), periods=2, seed=0)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"periods": 0}, "periods = 0 must be at least 1"),
        ({"settling_periods": -1}, "settling_periods = -1"),
        ({"sample_rate_hz": 1.5}, "must exceed twice the frequency of 0.9 Hz"),
        ({"sample_rate_hz": math.nan}, "sample_rate_hz = nan"),
        ({"seed": -4}, "seed = -4"),
    ],
)
def test_arguments_out_of_range_are_refused(arguments: dict[str, Any], message: str) -> None:
    with pytest.raises(ConfigurationError, match=message):
        simulate(vertical_rig(), SET_POINT, **{"periods": 2, "seed": 0, **arguments})


def test_overloaded_dynamometer_is_flagged() -> None:
    weak = Dynamometers(aft=Dynamometer(full_scale_n=5.0), fore=Dynamometer(full_scale_n=1e4))
    run = simulate(replace(vertical_rig(), dynamometers=weak), SET_POINT, periods=2, seed=0)
    (flag,) = json.loads(run.attrs[schema.ATTR_FLAGS])
    assert (flag["code"], flag["channel"]) == ("dynamometer-overload", "force_aft")
    assert "5 N" in flag["message"]
    assert run["force_aft"].attrs[schema.FULL_SCALE] == 5.0
    assert run["force_fore"].attrs[schema.FULL_SCALE] == 500.0


def test_ramp_that_outlasts_the_settling_is_flagged() -> None:
    rig = replace(vertical_rig(), drive=DriveSettings(start_ramp_s=4.0))
    (flag,) = json.loads(simulate(rig, SET_POINT, periods=2, seed=0).attrs[schema.ATTR_FLAGS])
    assert flag["code"] == "start-ramp-in-record"
    calm = simulate(rig, SET_POINT, periods=2, settling_periods=4, seed=0)
    assert json.loads(calm.attrs[schema.ATTR_FLAGS]) == []


def test_parameters_come_from_a_table_and_unknown_keys_are_refused() -> None:
    adapter = TypeAdapter(SimulatedRig)
    table = asdict(horizontal_rig(1.5))
    assert adapter.validate_python(table) == horizontal_rig(1.5)
    for path in ((), ("water",), ("drive",), ("dynamometers", "aft"), ("photocell",)):
        spoilt = asdict(horizontal_rig())
        inner = spoilt
        for key in path:
            inner = inner[key]
        inner["no_such_key"] = 1.0
        with pytest.raises(ValidationError, match="no_such_key"):
            adapter.validate_python(spoilt)
