"""Phase-sensitive detection against the signal that was put on the carrier."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import freqz

from analysis.recording import Recording
from analysis.resolver.carrier import DecimationFilter, demodulate, design_low_pass
from hardware.description.arrays import FloatArray
from hardware.description.channels import SHAFT_ANGLE, Channel
from hardware.description.errors import ConfigurationError, DataError
from hardware.description.flags import Severity

RATE_HZ = 10_000.0
CARRIER_HZ = 1000.0
START_S = 12.3456


def force(time_s: FloatArray) -> FloatArray:
    """Mean and harmonics of 1.7 Hz."""
    theta = 2.0 * np.pi * 1.7 * time_s
    return 20.0 + 5.0 * np.sin(theta + 0.3) + 0.5 * np.cos(3.0 * theta)


def bridge(
    seconds: float = 2.0,
    phase_rad: float = 0.4,
    amplitude: float = 1.0,
    offset: float = 0.0,
    carrier_hz: float = CARRIER_HZ,
) -> Recording:
    time_s = START_S + np.arange(round(seconds * RATE_HZ)) / RATE_HZ
    carrier = amplitude * np.sin(2.0 * np.pi * carrier_hz * time_s + phase_rad)
    samples = np.stack((force(time_s) * carrier + offset, force(time_s)))
    channels = (Channel("raw", "N", full_scale=100.0), Channel("plain", "N"))
    return Recording("run", channels, samples, RATE_HZ, START_S)


def worst(recording: Recording, name: str = "raw") -> float:
    return float(np.abs(recording.values(name) - force(recording.time_s())).max())


@pytest.mark.parametrize("output_rate_hz", [None, 200.0, 1000.0])
@pytest.mark.parametrize("offset", [0.0, 3.0])
def test_the_signal_comes_back_at_its_own_time(output_rate_hz: float | None, offset: float) -> None:
    raw = bridge(amplitude=2.5, offset=offset)
    out = demodulate(
        raw,
        ["raw"],
        CARRIER_HZ,
        carrier_phase_rad=0.4,
        carrier_amplitude=2.5,
        output_rate_hz=output_rate_hz,
    )
    assert worst(out) < 1e-5  # 5e-7 of the signal
    assert worst(out, "plain") < 1e-5
    assert out.sample_rate_hz == (output_rate_hz or 200.0)
    assert out.channels[0].full_scale == pytest.approx(40.0)


def test_half_the_filter_is_dropped_at_either_end() -> None:
    raw = bridge()
    low_pass = design_low_pass(RATE_HZ, CARRIER_HZ, 50.0)
    out = demodulate(raw, ["raw"], CARRIER_HZ, carrier_phase_rad=0.4)
    lost_s = low_pass.half / RATE_HZ
    assert out.start_s == pytest.approx(raw.start_s + lost_s, abs=1e-12)
    assert raw.end_s - lost_s - 1.0 / out.sample_rate_hz < out.end_s <= raw.end_s - lost_s + 1e-9
    assert (
        f"{lost_s:.6g} s" in next(f for f in out.flags if f.code == "carrier_ends_dropped").message
    )


@pytest.mark.parametrize("phase_rad", [0.4, -1.5, 1.5, 0.0])
def test_the_phase_is_found_where_the_quadrature_vanishes(phase_rad: float) -> None:
    out = demodulate(bridge(phase_rad=phase_rad), ["raw"], CARRIER_HZ)
    assert worst(out) < 1e-5
    (flag,) = [flag for flag in out.flags if flag.code == "carrier_phase_estimated"]
    assert f"{phase_rad:.6f} rad" in flag.message.replace("-0.000000", "0.000000")
    assert "sign of the signal is not known" in flag.message


def test_turning_the_column_s_sign_turns_the_signal_as_is_advised() -> None:
    raw = bridge()
    turned = replace(raw, samples=-np.asarray(raw.samples[:, 0 : raw.sample_count]))
    out = demodulate(turned, ["raw"], CARRIER_HZ)
    assert out.values("raw") == pytest.approx(-force(out.time_s()), abs=1e-5)
    (flag,) = [flag for flag in out.flags if flag.code == "carrier_phase_estimated"]
    assert "put a '-' before its column" in flag.message


def test_a_phase_beyond_a_quarter_turn_comes_out_reversed() -> None:
    out = demodulate(bridge(phase_rad=0.4 + np.pi), ["raw"], CARRIER_HZ)
    assert out.values("raw") == pytest.approx(-force(out.time_s()), abs=1e-5)


def test_a_wrong_phase_is_flagged_with_the_part_in_quadrature() -> None:
    out = demodulate(bridge(), ["raw"], CARRIER_HZ, carrier_phase_rad=0.5)
    (flag,) = [flag for flag in out.flags if flag.code == "carrier_quadrature"]
    assert flag.severity is Severity.WARNING
    assert f"{np.sin(0.1):.3g} of the signal" in flag.message


def test_a_wrong_carrier_frequency_is_flagged() -> None:
    out = demodulate(bridge(carrier_hz=1000.2), ["raw"], CARRIER_HZ)
    assert "carrier_quadrature" in [flag.code for flag in out.flags]


def gain(low_pass: DecimationFilter, frequency: FloatArray) -> FloatArray:
    """Return a filter's gain (real, no phase) at frequencies over the input's sample rate."""
    at = 2.0 * np.pi * frequency
    return np.asarray((freqz(low_pass.taps, worN=at)[1] * np.exp(1j * at * low_pass.half)).real)


@pytest.mark.parametrize(
    ("rate_hz", "carrier_hz", "bandwidth_hz", "output_rate_hz"),
    [
        (10_000.0, 1000.0, 50.0, None),
        (10_000.0, 1000.0, 300.0, 1000.0),
        (10_000.0, 1000.0, 10.0, 10_000.0),
        (2500.0, 1000.0, 50.0, None),
        (4800.0, 600.0, 100.0, 400.0),
    ],
)
def test_pass_band_is_flat_and_stop_band_is_shut(
    rate_hz: float, carrier_hz: float, bandwidth_hz: float, output_rate_hz: float | None
) -> None:
    low_pass = design_low_pass(rate_hz, carrier_hz, bandwidth_hz, output_rate_hz)
    passed = gain(low_pass, np.linspace(0.0, bandwidth_hz, 2001) / rate_hz)
    assert np.abs(passed - 1.0).max() < 1e-6
    image_hz = abs(2.0 * carrier_hz - rate_hz * round(2.0 * carrier_hz / rate_hz))
    for centre in (carrier_hz, image_hz):
        around = np.linspace(centre - bandwidth_hz, centre + bandwidth_hz, 2001) / rate_hz
        assert -20.0 * np.log10(np.abs(gain(low_pass, around)).max()) > 100.0
    if low_pass.decimation > 1:
        folding = np.linspace(rate_hz / low_pass.decimation - bandwidth_hz, rate_hz / 2.0, 20_001)
        assert -20.0 * np.log10(np.abs(gain(low_pass, folding / rate_hz)).max()) > 100.0


def test_outputs_do_not_depend_on_where_the_record_is_cut() -> None:
    low_pass = DecimationFilter(np.array([0.25, 0.5, 0.25]), 1, 1)
    values = np.array([[0.0, 1.0, 0.0, 0.0, 4.0]])
    assert low_pass.valid(values) == pytest.approx(np.array([[0.5, 0.25, 1.0]]))
    long = demodulate(bridge(60.0), ["raw"], CARRIER_HZ, carrier_phase_rad=0.4)
    short = demodulate(bridge(2.0), ["raw"], CARRIER_HZ, carrier_phase_rad=0.4)
    count = short.sample_count
    assert long.values("raw")[:count] == pytest.approx(short.values("raw"), abs=1e-9)
    assert worst(long) < 1e-5


def test_the_shaft_angle_keeps_its_jumps() -> None:
    raw = bridge()
    wrapped = (2.0 * np.pi * 1.7 * raw.time_s()) % (2.0 * np.pi)
    samples = np.stack((raw.values("raw"), wrapped))
    recording = Recording("run", (raw.channels[0], SHAFT_ANGLE), samples, RATE_HZ, START_S)
    out = demodulate(recording, ["raw"], CARRIER_HZ)
    expected = (2.0 * np.pi * 1.7 * out.time_s()) % (2.0 * np.pi)
    assert out.values("shaft_angle") == pytest.approx(expected, abs=1e-9)


def test_a_missing_sample_stays_missing_and_is_flagged() -> None:
    raw = bridge()
    np.asarray(raw.samples)[0, 10_000] = np.nan
    out = demodulate(raw, ["raw"], CARRIER_HZ)
    lost = np.isnan(out.values("raw"))
    assert 0 < lost.sum() < 25
    assert np.abs(out.values("raw") - force(out.time_s()))[~lost].max() < 1e-5
    (flag,) = [flag for flag in out.flags if flag.code == "carrier_gap"]
    assert flag.message.startswith(f"{lost.sum()} of ")


@pytest.mark.parametrize(
    ("carrier_hz", "bandwidth_hz", "output_rate_hz", "message"),
    [
        (6000.0, 50.0, None, r"carrier_hz = 6000 .* half the sample rate, 5000 Hz"),
        (1000.0, 400.0, 5000.0, r"too near the carrier at 1000 Hz; at most 333"),
        (4900.0, 80.0, None, r"too near twice the carrier as sampled at 200 Hz"),
        (1000.0, 50.0, 100.0, r"too near the output rate at 100 Hz"),
        (1000.0, 50.0, 300.0, r"no whole fraction of .* nearest is 303\.03 Hz"),
        (1000.0, 50.0, 20_000.0, r"output_rate_hz = 20000"),
        (0.0, 50.0, None, r"carrier_hz = 0: must be above 0"),
        (1000.0, -1.0, None, r"bandwidth_hz = -1: must be above 0"),
    ],
)
def test_settings_that_cannot_work_are_refused_with_numbers(
    carrier_hz: float, bandwidth_hz: float, output_rate_hz: float | None, message: str
) -> None:
    with pytest.raises(ConfigurationError, match=message):
        design_low_pass(RATE_HZ, carrier_hz, bandwidth_hz, output_rate_hz)


def test_records_that_cannot_be_detected_are_refused() -> None:
    with pytest.raises(DataError, match=r"1000 samples are too few .* at least \d+"):
        demodulate(bridge(0.1), ["raw"], CARRIER_HZ)
    with pytest.raises(DataError, match="no channel 'row'; did you mean raw"):
        demodulate(bridge(), ["row"], CARRIER_HZ)
    silent = Recording("run", (Channel("raw", "V"),), np.zeros((1, 20_000)), RATE_HZ)
    with pytest.raises(DataError, match="raw: no signal at the carrier"):
        demodulate(silent, ["raw"], CARRIER_HZ)
    with pytest.raises(ConfigurationError, match="carrier_amplitude = 0"):
        demodulate(bridge(), ["raw"], CARRIER_HZ, carrier_amplitude=0.0)
