"""Sinkage and trim of the simulated model against a rigid line that the test turns itself."""

import math
from dataclasses import replace

import numpy as np
import pytest

from hardware.description.attitude import AttitudeSensors, HeaveAndPitch
from hardware.description.errors import ConfigurationError
from hardware.description.setpoint import Medium, SetPoint
from sim.acquisition.channels import Digitiser
from sim.model.attitude import Squat
from sim.rest import state_at_rest
from sim.rig import SimulatedRig, horizontal_rig, vertical_rig
from sim.run import simulate, steady_run

AFT_M, FORE_M = -0.7, 1.1
SQUAT = Squat(z_uu=4e-3, z_vv=2e-2, theta_uu=-3.5e-3, theta_vv=1e-2)


def watched(rig: SimulatedRig, free: HeaveAndPitch, squat: Squat | None) -> SimulatedRig:
    seen = replace(rig.ideal().acquisition, position_aft=Digitiser(), position_fore=Digitiser())
    sensors = AttitudeSensors(AFT_M, FORE_M, free)
    return replace(rig.ideal(), acquisition=seen, attitude=sensors, squat=squat)


FREE = watched(horizontal_rig(), HeaveAndPitch.FREE, SQUAT)


def line(sunk_m: np.ndarray, trim_rad: np.ndarray) -> np.ndarray:
    """Both points, bow up lifting the bow, z down: a turn in the complex plane of x + i z."""
    turned = np.exp(-1j * trim_rad)
    return np.array([sunk_m + (x * turned).imag for x in (AFT_M, FORE_M)])


def test_a_free_model_sinks_and_trims_by_its_velocities() -> None:
    """Sway at speed: the model keeps its heading, so u is the carriage's and v the struts'."""
    speed, size_m, frequency_hz = 1.2, 0.2, 0.25
    point = SetPoint(frequency_hz, size_m, 0.0, speed)
    record = simulate(FREE, point, periods=3, sample_rate_hz=100.0, seed=1)
    sway = record["displacement_aft"].values
    omega = 2.0 * math.pi * frequency_hz
    square = omega**2 * (size_m**2 - sway**2)  # of the velocity of a sine, whatever its phase
    expected = line(
        SQUAT.z_uu * speed**2 + SQUAT.z_vv * square,
        SQUAT.theta_uu * speed**2 + SQUAT.theta_vv * square,
    )
    found = np.array([record["position_aft"].values, record["position_fore"].values])
    np.testing.assert_allclose(found, expected, atol=1e-9)
    steady = steady_run(FREE, point).spectra
    mean = steady["position_aft"][0].real
    assert mean == pytest.approx(float(np.mean(expected[0])), rel=0.02)
    assert abs(steady["position_aft"][1]) < 1e-12  # the square of a sine has no first harmonic
    assert abs(steady["position_aft"][2]) > 1e-5


def test_under_drift_the_flow_comes_across() -> None:
    drift, speed = math.radians(8.0), 1.2
    point = SetPoint(0.5, 0.0, carriage_speed_m_s=speed, drift_rad=drift)
    found = state_at_rest(FREE, point).spectra
    along, across = speed * math.cos(drift), speed * math.sin(drift)
    expected = line(
        np.array(SQUAT.z_uu * along**2 + SQUAT.z_vv * across**2),
        np.array(SQUAT.theta_uu * along**2 + SQUAT.theta_vv * across**2),
    )
    means = [found[name][0].real for name in ("position_aft", "position_fore")]
    assert means == pytest.approx(expected, rel=1e-9)
    dry = state_at_rest(FREE, replace(point, medium=Medium.AIR)).spectra
    assert dry["position_aft"][0] == 0.0


def test_a_forced_model_stands_where_the_struts_hold_it() -> None:
    """Pitch about the midpoint: the points stand on the line through both struts' ends."""
    rig = watched(vertical_rig(), HeaveAndPitch.FIXED, None)
    point = SetPoint(0.8, 0.02, math.pi, 1.0)
    record = simulate(rig, point, periods=2, sample_rate_hz=100.0, seed=1)
    aft, fore = record["displacement_aft"].values, record["displacement_fore"].values
    apart = record["position_aft"].values - record["position_fore"].values
    sine = apart / (FORE_M - AFT_M)
    slope = (aft - fore) / (2.0 * rig.oscillator.half_spacing_m)
    np.testing.assert_allclose(np.tan(np.arcsin(sine)), slope, atol=1e-12)
    still = watched(horizontal_rig(), HeaveAndPitch.FIXED, None)
    sway = simulate(still, SetPoint(0.3, 0.05, 0.0, 1.0), periods=1, sample_rate_hz=50.0, seed=1)
    assert not sway["position_fore"].values.any()


def test_what_cannot_be_is_said() -> None:
    point = SetPoint(0.3, 0.05, 0.0, 1.0)
    with pytest.raises(ConfigurationError, match=r"position_fore, but no \[attitude\] says where"):
        replace(FREE, attitude=None, squat=None).chain(point)
    with pytest.raises(ConfigurationError, match=r'\[squat\], but no .* heave_and_pitch = "free"'):
        watched(horizontal_rig(), HeaveAndPitch.FIXED, SQUAT).chain(point)
