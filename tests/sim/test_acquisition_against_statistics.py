"""Oracle: the statistics of white noise, and a converter worked out by hand."""

import math

import numpy as np
import pytest
from scipy.signal import welch

from hardware.description.arrays import FloatArray
from sim.acquisition.channels import Acquisition, Digitiser
from sim.acquisition.noise import draw_normal, start_stream
from sim.chain import Chain
from sim.gauges.dynamometer import Dynamometer, Dynamometers
from sim.signals import DYNAMOMETER_FORCE_AFT, DYNAMOMETER_FORCE_FORE, FORCE_AFT, FORCE_FORE

COUNT = 200_000
READINGS = (DYNAMOMETER_FORCE_AFT, DYNAMOMETER_FORCE_FORE)


def record(aft: Digitiser, force: FloatArray, rate: float = 100.0, seed: int = 0) -> FloatArray:
    chain = Chain((Acquisition(force_aft=aft),), inputs=READINGS)
    fed = {READINGS[0].name: force, READINGS[1].name: np.zeros_like(force)}
    return chain.run(chain.start(rate, seed), force.size, fed)[1]["recorded_force_aft"]


def test_noise_is_white_normal_and_of_the_stated_size() -> None:
    noise = record(Digitiser(noise_rms=0.2), np.zeros(COUNT)) / 0.2
    margin = 4.0 / math.sqrt(COUNT)
    assert abs(noise.mean()) < margin
    assert abs(noise.var() - 1.0) < margin * math.sqrt(2.0)
    assert abs(np.mean(noise**4) - 3.0) < margin * math.sqrt(96.0)
    for lag in (1, 2, 7, 100):
        assert abs(np.mean(noise[lag:] * noise[:-lag])) < margin


def test_channels_and_seeds_have_independent_noise() -> None:
    how = Digitiser(noise_rms=1.0)
    chain = Chain((Acquisition(force_aft=how, force_fore=how),), inputs=READINGS)
    zero = {signal.name: np.zeros(COUNT) for signal in READINGS}
    _, first = chain.run(chain.start(100.0, seed=1), COUNT, zero)
    _, second = chain.run(chain.start(100.0, seed=2), COUNT, zero)
    series = [
        run[name]
        for run in (first, second)
        for name in ("recorded_force_aft", "recorded_force_fore")
    ]
    correlation = np.corrcoef(series) - np.eye(4)
    assert np.abs(correlation).max() < 4.5 / math.sqrt(COUNT)


def test_noise_of_successive_blocks_is_independent() -> None:
    stream, blocks = start_stream(1, "here"), []
    for _ in range(2000):
        stream, values = draw_normal(stream, 100)
        blocks.append(values)
    stacked = np.array(blocks)
    assert abs(np.mean(stacked[1:] * stacked[:-1])) < 4.0 / math.sqrt(stacked.size)


def test_a_channel_keeps_its_noise_whatever_else_is_recorded() -> None:
    how = Digitiser(noise_rms=1.0)
    few = Chain((Acquisition(force_aft=how, force_fore=None),), inputs=READINGS[:1])
    zero = np.zeros(50)
    _, alone = few.run(few.start(100.0, seed=9), 50, {READINGS[0].name: zero})
    np.testing.assert_array_equal(alone["recorded_force_aft"], record(how, zero, seed=9))


def test_drift_grows_with_time() -> None:
    found = record(Digitiser(drift_per_s=0.5), np.full(300, 2.0), rate=100.0)
    np.testing.assert_allclose(found, 2.0 + 0.5 * np.arange(300) / 100.0, rtol=1e-15)


def test_converter_rounds_and_limits() -> None:
    force = np.array([-30.0, -9.9, -0.26, 0.1, 0.24, 0.26, 9.9, 30.0])
    found = record(Digitiser(resolution=0.5, full_scale=10.0), force)
    np.testing.assert_array_equal(found, [-10.0, -10.0, -0.5, 0.0, 0.0, 0.5, 10.0, 10.0])


def test_gauge_has_gain_and_offset() -> None:
    chain = Chain(
        (Dynamometers(aft=Dynamometer(1.01, 2.0), fore=Dynamometer(0.99, -1.0)),),
        (FORCE_AFT, FORCE_FORE),
    )
    force = np.array([0.0, 100.0])
    fed = {FORCE_AFT.name: force, FORCE_FORE.name: force}
    _, out = chain.run(chain.start(1.0, 0), 2, fed)
    assert out["dynamometer_force_aft"] == pytest.approx([2.0, 103.0])
    assert out["dynamometer_force_fore"] == pytest.approx([-1.0, 98.0])


def test_a_walk_that_forgets_has_the_spectrum_of_one_pole() -> None:
    """Welch's estimate from a long record against w² / ((2 pi f)² + (2 pi c)²), two-sided."""
    rate_hz, walk, corner_hz = 100.0, 0.3, 1.5
    how = Digitiser(walk_per_sqrt_s=walk, walk_corner_hz=corner_hz)
    found = record(how, np.zeros(400_000), rate=rate_hz)
    at_hz, power = welch(found, rate_hz, nperseg=2000, return_onesided=False)
    for low, high in ((0.1, 0.4), (1.2, 1.8), (4.0, 6.0)):
        inside = (at_hz > low) & (at_hz < high)
        told = walk**2 / (2.0 * np.pi) ** 2 / (at_hz[inside] ** 2 + corner_hz**2)
        assert power[inside].mean() == pytest.approx(told.mean(), rel=0.06)
