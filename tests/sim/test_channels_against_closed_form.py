"""Oracle: transfer functions, Fourier series and statistics of what lies behind the force."""

import math
from dataclasses import replace

import numpy as np
import pytest

from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.errors import ConfigurationError
from sim.acquisition.amplifier import BridgeCarrier, FilterKind, LowPass
from sim.acquisition.channels import Acquisition, Digitiser
from sim.acquisition.photocell import PhotocellStage
from sim.chain import Chain
from sim.drive.carriage import CarriageMotion, CarriageSettings, Fluctuation
from sim.drive.prescribed_drive import ConstantSpeedDrive, DriveSettings
from sim.gauges.dynamometer import Dynamometer, Dynamometers
from sim.mechanism.linkage import Mechanism, Setting
from sim.periodic import steady_state
from sim.signals import DYNAMOMETER_FORCE_AFT, DYNAMOMETER_FORCE_FORE, FORCE_AFT, FORCE_FORE
from sim.solve.linear_system import Hold
from sim.solve.period import Period
from sim.stage import Block

RATE = 200.0


def record(how: Digitiser, signal: FloatArray) -> FloatArray:
    inputs = (DYNAMOMETER_FORCE_AFT, DYNAMOMETER_FORCE_FORE)
    chain = Chain((Acquisition(force_aft=how),), inputs)
    fed = {inputs[0].name: signal, inputs[1].name: signal}
    return chain.run(chain.start(RATE, 3), signal.size, fed)[1]["recorded_force_aft"]


def discrete_response(hold: Hold, z: ComplexArray) -> ComplexArray:
    """Return the transfer matrices from input to state at ``z``, shape ``(k, n, p)``."""
    column = z[:, np.newaxis, np.newaxis]
    driven = sum(column ** (j - hold.past) * weight for j, weight in enumerate(hold.weights))
    matrix = np.eye(len(hold.step)) - hold.step / column
    return np.asarray(np.linalg.solve(matrix, driven), np.complex128)


@pytest.mark.parametrize(
    ("low_pass", "delay_s"),
    [
        (LowPass(10.0), 0.0159),
        (LowPass(10.0, FilterKind.BUTTERWORTH, 4), 0.0416),
        (LowPass(10.0, FilterKind.BESSEL, 4), 0.0336),
    ],
)
def test_filter_has_its_delay_and_transfer_function(low_pass: LowPass, delay_s: float) -> None:
    slow = low_pass.response(np.array([0.01j]))[0]
    assert -np.angle(slow) / 0.01 == pytest.approx(delay_s, abs=6e-5)
    corner = low_pass.response(np.array([20j * math.pi]))[0]
    assert abs(corner) == pytest.approx(math.sqrt(0.5), rel=1e-9)
    frequency = np.array([1.0, 5.0])
    time = np.arange(6000) / RATE
    z = np.exp(2j * math.pi * frequency / RATE)
    step = (low_pass.system.C @ discrete_response(low_pass.hold(1.0 / RATE), z))[:, 0, 0]
    for f, discrete in zip(frequency, step, strict=True):
        found = record(Digitiser(low_pass=low_pass), np.sin(2 * math.pi * f * time))[-2000:]
        late = np.exp(-2j * math.pi * f * time[-2000:])
        wave = 2j * np.mean(found * late)
        assert abs(wave - discrete) < 1e-9  # of the discrete transfer function
        exact = low_pass.response(np.array([2j * math.pi * f]))[0]
        size = (2 * math.pi * f / RATE) ** 6
        assert abs(wave - exact) < max(0.05 * size, 1e-11)  # and of the continuous one


@pytest.mark.parametrize("delay", [0.0, 0.001, 0.0049, 0.013, 0.0375])
def test_delay_is_a_pure_delay(delay: float) -> None:
    time = np.arange(2000) / RATE
    found = record(Digitiser(delay_s=delay), np.sin(2 * math.pi * time))
    expected = np.sin(2 * math.pi * (time - delay))
    np.testing.assert_allclose(found[50:], expected[50:], atol=2e-11)


def test_carrier_demodulated_and_as_it_is() -> None:
    signal = np.linspace(1.0, 2.0, 50)
    equivalent = record(Digitiser(carrier=BridgeCarrier(phase_error_rad=0.2)), signal)
    np.testing.assert_allclose(equivalent, signal * math.cos(0.2))
    ridden = record(Digitiser(carrier=BridgeCarrier(frequency_hz=30.0, demodulated=False)), signal)
    time = np.arange(50) / RATE
    np.testing.assert_allclose(ridden, signal * np.cos(60 * math.pi * time), atol=1e-12)


def test_random_walk_grows_with_the_root_of_time() -> None:
    ends = record(Digitiser(walk_per_sqrt_s=0.5), np.zeros(200_000))
    for lag_s in (0.5, 5.0):
        lag = int(lag_s * RATE)
        steps = ends[lag::lag] - ends[:-lag:lag]
        expected = 0.5 * math.sqrt(lag_s)
        assert steps.std() == pytest.approx(expected, rel=4 / math.sqrt(2 * steps.size))


def read(dynamometers: Dynamometers, orders: dict[int, complex]) -> np.ndarray:
    chain = Chain((dynamometers,), (FORCE_AFT, FORCE_FORE))
    force = np.zeros(13, dtype=complex)
    for order, value in orders.items():
        force[order] = value
    fed = {"force_aft": force, "force_fore": 2.0 * force}
    return steady_state(chain, Period(1.0, points=512), fed).spectra["dynamometer_force_aft"]


def test_quadratic_gauge() -> None:
    """q F^2: q F^2/2 in the mean, and at twice the frequency with twice the phase."""
    force = 80.0 * np.exp(0.7j)
    found = read(Dynamometers(aft=Dynamometer(curvature_1_n=1e-4)), {1: force})
    assert found[0] == pytest.approx(1e-4 * 80.0**2 / 2.0)
    assert found[1] == pytest.approx(force)
    assert found[2] == pytest.approx(1e-4 * force**2 / 2.0)


def test_hysteresis_lags_the_force_by_a_rayleigh_loop() -> None:
    """In force phase -(4/3 pi) beta F_m^2 and -(4/15 pi) beta F_m^2 at order 3."""
    beta, peak = 1e-4, 80.0
    found = read(Dynamometers(aft=Dynamometer(hysteresis_1_n=beta)), {1: -1j * peak})
    assert found[1].real == pytest.approx(-4 / (3 * math.pi) * beta * peak**2, rel=1e-3)
    assert found[3].real == pytest.approx(-4 / (15 * math.pi) * beta * peak**2, rel=1e-2)
    assert -found[1].imag == pytest.approx(peak, rel=1e-9)


def test_cross_talk_and_a_stop() -> None:
    assert read(Dynamometers(cross_talk_aft=0.02), {1: 10.0})[1] == pytest.approx(10.4)
    clipped = read(Dynamometers(aft=Dynamometer(highest_n=9.0, lowest_n=-9.0)), {1: 10.0})
    assert abs(clipped[3]) / abs(clipped[1]) == pytest.approx(0.032, abs=2e-3)
    one_sided = read(Dynamometers(aft=Dynamometer(highest_n=9.0)), {1: 10.0})
    assert abs(one_sided[2]) > 0.1


def test_converter_limit_in_the_periodic_form() -> None:
    chain = Chain(
        (Acquisition(force_aft=Digitiser(full_scale=9.0)),),
        (DYNAMOMETER_FORCE_AFT, DYNAMOMETER_FORCE_FORE),
    )
    force = np.zeros(13, dtype=complex)
    force[1] = 10.0
    fed = {DYNAMOMETER_FORCE_AFT.name: force, DYNAMOMETER_FORCE_FORE.name: force}
    found = steady_state(chain, Period(1.0), fed).spectra["recorded_force_aft"]
    assert 0.02 < abs(found[3]) / abs(found[1]) < 0.04


def test_tilted_slot_and_offset_rod() -> None:
    """Slot: turned by gamma, 1/cos larger. Rod: e o/L in quadrature, third (e^2/8 L^2) of it."""
    angle = 2 * math.pi * np.arange(256) / 256
    shaft = {"shaft_angle": angle, "shaft_speed": angle, "shaft_acceleration": angle}
    tilted = Mechanism(0.05, aft=Setting(slot_tilt_rad=0.01))
    found = tilted.run(None, Block(0, 256, 1.0), shaft)[1]
    expected = 0.05 / math.cos(0.01) * np.sin(angle + 0.01)
    np.testing.assert_allclose(found["displacement_aft"], expected, atol=1e-15)
    e, offset, rod = 0.05, 0.02, 1.0
    spectrum = np.fft.rfft(Mechanism(e, rod_length_m=rod).displacement(angle, offset)[0]) / 128
    assert spectrum[1].real == pytest.approx(-e * offset / rod, rel=3e-3)
    assert abs(spectrum[3]) == pytest.approx(e * offset / rod * e**2 / (8 * rod**2), rel=2e-2)


def test_photocell_misses_and_doubles() -> None:
    drive = ConstantSpeedDrive(1.0, DriveSettings(initial_angle_rad=-0.5))
    chain = Chain((drive, PhotocellStage(missed_every=3, extra_every=4, extra_after_s=0.1)))
    found = chain.run(chain.start(50.0, 0), 420)[1]["photocell_edge_time"]
    turns = found - 0.5 / (2 * math.pi)
    np.testing.assert_allclose(turns, [0, 1, 3, 3.1, 4, 6, 7, 7.1], atol=1e-12)


def test_carriage_and_stop_ramp() -> None:
    chain = Chain((CarriageMotion(2.0, CarriageSettings(0.01, (Fluctuation(0.1, 0.5),))),))
    speed = chain.run(chain.start(10.0, 0), 40)[1]["carriage_speed"]
    time = np.arange(40) / 10.0
    np.testing.assert_allclose(speed, 2.02 * (1.0 + 0.1 * np.sin(math.pi * time)))
    drive = ConstantSpeedDrive(1.0, DriveSettings(0.0, 1.0, stop_at_s=3.0, stop_ramp_s=2.0))
    shaft = Chain((drive,)).run(Chain((drive,)).start(100.0, 0), 700)[1]
    assert shaft["shaft_angle"][-1] == pytest.approx(2 * math.pi * (3.0 - 0.5 + 1.0))
    assert abs(shaft["shaft_speed"][-1]) < 1e-12
    slope = np.gradient(shaft["shaft_angle"], 0.01)
    np.testing.assert_allclose(slope[1:-1], shaft["shaft_speed"][1:-1], atol=2e-3)


def test_parameters_out_of_range_are_refused() -> None:
    with pytest.raises(ConfigurationError, match="cutoff_hz = -1"):
        LowPass(-1.0)
    with pytest.raises(ConfigurationError, match="order = 2 of a rc filter"):
        LowPass(1.0, FilterKind.RC, 2)
    with pytest.raises(ConfigurationError, match=r"delay_s = -0\.1"):
        replace(Digitiser(), delay_s=-0.1)
