"""Waves on the simulated model: what they add to the gauges, and the probe, against their sums."""

import math
from dataclasses import replace

import numpy as np
import pytest

from hardware.description.errors import ConfigurationError
from hardware.description.setpoint import SetPoint
from sim.acquisition.channels import Acquisition
from sim.acquisition.digitiser import Digitiser
from sim.gauges.dynamometer import Dynamometers
from sim.model.waves import WaveLoad, Waves
from sim.rig import SimulatedRig, horizontal_rig, vertical_rig
from sim.run import simulate, steady_run

RECORDED = ("force_aft", "force_fore", "force_x", "wave_probe")
WAVES = Waves(
    ahead=WaveLoad(40.0, -0.5, -900.0),
    across=WaveLoad(250.0, 0.6, 300.0, 500.0, 0.2),
    about=WaveLoad(80.0, 1.9, 100.0),
    probe_x_m=1.7,
    depth_m=2.0,
)
POINT = SetPoint(
    0.3, 0.04, 0.0, 0.8, wave_frequency_hz=0.6, wave_amplitude_m=0.03, wave_heading_rad=math.pi
)


def rig(base: SimulatedRig) -> SimulatedRig:
    perfect = Acquisition(**{name: Digitiser() for name in RECORDED})
    return replace(base, waves=WAVES, acquisition=perfect, dynamometers=Dynamometers())


@pytest.mark.parametrize("vertical", [False, True])
def test_the_gauges_have_the_waves_on_top_of_calm_water(vertical: bool) -> None:
    own = rig(vertical_rig() if vertical else horizontal_rig())
    given = {"periods": 1, "settling_periods": 0, "sample_rate_hz": 50.0, "seed": 1}
    rough = simulate(own, POINT, **given)
    calm = simulate(own, replace(POINT, wave_amplitude_m=0.0, wave_frequency_hz=0.0), **given)
    time = rough["time"].values
    omega = 2.0 * math.pi * 0.6
    k = omega**2 / 9.80665
    for _ in range(200):  # by iteration; head waves
        k = omega**2 / 9.80665 / math.tanh(k * 2.0)
    phase = (omega + k * 0.8) * time + k * 1.7
    assert rough["wave_probe"].values == pytest.approx(0.03 * np.cos(phase), abs=1e-9)
    added = {name: rough[name].values - calm[name].values for name in RECORDED[:3]}
    half = own.oscillator.half_spacing_m * (-1.0 if vertical else 1.0)
    square = 0.03**2
    across = 7.5 * np.cos(phase + 0.6) + square * (300.0 + 500.0 * np.cos(2.0 * phase + 0.2))
    about = 2.4 * np.cos(phase + 1.9) + square * 100.0
    assert added["force_aft"] + added["force_fore"] == pytest.approx(-across, abs=1e-9)
    assert half * (added["force_fore"] - added["force_aft"]) == pytest.approx(-about, abs=1e-9)
    ahead = 1.2 * np.cos(phase - 0.5) - square * 900.0
    assert added["force_x"] == pytest.approx(-ahead, abs=1e-9)


def test_a_period_has_none_of_a_frequency_that_is_not_its_own() -> None:
    own = rig(horizontal_rig())
    found = steady_run(own, POINT).spectra
    calm = steady_run(own, replace(POINT, wave_amplitude_m=0.0)).spectra
    assert found["force_aft"] == pytest.approx(calm["force_aft"], abs=1e-12)
    assert not found["wave_probe"].any()


def test_waves_that_nobody_states_are_refused() -> None:
    with pytest.raises(ConfigurationError, match=r"waves, but \[waves\] is missing"):
        simulate(horizontal_rig(), POINT, periods=1, seed=1)
