"""A reference found in a signal: frequency and phase of sines that are known."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.resolver.reference import PhaseReference
from analysis.resolver.signal_reference import from_signal
from hardware.description.errors import DataError
from tests.analysis.resolver.signals import FloatArray, autoregressive, recording

RATE_HZ = 50.0


def reference_of(values: FloatArray, rate_hz: float = RATE_HZ) -> PhaseReference:
    return from_signal(recording(values, rate_hz), "force_0")


def away_rad(reference: PhaseReference, time: FloatArray, cycles: FloatArray) -> FloatArray:
    """Phase of the reference less the true one, between -pi and pi."""
    turns = reference.cycles_at(time) - cycles
    return np.asarray(2.0 * np.pi * (turns - np.rint(turns.mean())))


@given(st.floats(0.05, 8.0), st.floats(0.0, 1.0), st.integers(6, 60))
def test_any_frequency_and_phase_is_found(frequency: float, phase: float, periods: int) -> None:
    time = np.arange(int(RATE_HZ * periods / frequency)) / RATE_HZ
    cycles = phase + frequency * time
    reference = reference_of(0.02 * np.sin(2.0 * np.pi * cycles) + 0.3)
    assert reference.frequency_hz == pytest.approx(frequency, rel=1e-5)
    assert np.abs(away_rad(reference, time, cycles)).max() < 1e-3


@pytest.mark.parametrize("frequency", [0.1373, 1.0, 2.417])
def test_noisy_sines(frequency: float) -> None:
    time = np.arange(int(RATE_HZ * 100.0 / frequency)) / RATE_HZ
    cycles = 0.2 + frequency * time
    noise = 0.002 * np.random.default_rng(4).normal(size=time.size)
    reference = reference_of(np.sin(2.0 * np.pi * cycles) + noise)
    assert reference.frequency_hz == pytest.approx(frequency, rel=1e-5)
    away = away_rad(reference, time, cycles)
    assert np.abs(away.mean()) < 1e-3
    assert away.std() < 1e-3


@pytest.mark.parametrize("noise", [0.1, 0.3])
def test_much_noise_still_keeps_the_mean_phase(noise: float) -> None:
    time = np.arange(10_000) / RATE_HZ
    cycles = 0.7 + 0.73 * time
    white = noise * np.random.default_rng(5).normal(size=time.size)
    reference = reference_of(np.sin(2.0 * np.pi * cycles) + white)
    assert abs(away_rad(reference, time, cycles).mean()) < 0.02 * noise


@pytest.mark.parametrize("rest_noise", [0.0, 1e-3])
def test_ramps_and_rest_are_left_out(rest_noise: float) -> None:
    """At rest for 20 s, ramp of 10 s, steady, ramp, rest: the reference covers what moves."""
    time = np.arange(8000) / RATE_HZ
    size = np.interp(time, [20.0, 30.0, 110.0, 120.0], [0.0, 1.0, 1.0, 0.0])
    cycles = 0.4 + 0.61 * time
    white = rest_noise * np.random.default_rng(6).normal(size=time.size)
    reference = reference_of(size * np.sin(2.0 * np.pi * cycles) + white)
    assert 20.0 < reference.times_s[0] < 30.0
    assert 110.0 < reference.times_s[-1] < 120.0
    steady = (time > 30.0) & (time < 110.0)
    assert np.abs(away_rad(reference, time[steady], cycles[steady])).max() < 5e-3


def test_slow_change_of_speed_is_followed() -> None:
    """3 % faster after 80 periods."""
    time = np.arange(4000) / RATE_HZ
    cycles = 1.0 * time + 0.5 * (0.03 / 80.0) * time**2
    reference = reference_of(np.sin(2.0 * np.pi * cycles))
    assert np.abs(away_rad(reference, time[50:-50], cycles[50:-50])).max() < 1e-2


@pytest.mark.parametrize("second", [0.1, 0.4, 0.8])
def test_a_second_harmonic_does_not_turn_the_phase(second: float) -> None:
    time = np.arange(3000) / RATE_HZ
    cycles = 0.3 + 0.77 * time
    values = np.sin(2.0 * np.pi * cycles) + second * np.sin(4.0 * np.pi * cycles + 1.0)
    reference = reference_of(values)
    assert reference.frequency_hz == pytest.approx(0.77, rel=1e-5)
    assert np.abs(away_rad(reference, time, cycles)).max() < 1e-3


@pytest.mark.parametrize("slope", [1e-3, 0.02, 0.1])
@pytest.mark.parametrize("phase", [0.0, 0.3, 0.7])
def test_drift_neither_hides_the_motion_nor_turns_it(slope: float, phase: float) -> None:
    """Left in, it would turn the phase by up to ``slope / 0.77 / pi``."""
    time = np.arange(3000) / RATE_HZ
    cycles = phase + 0.77 * time
    reference = reference_of(np.sin(2.0 * np.pi * cycles) + slope * time)
    assert reference.frequency_hz == pytest.approx(0.77, rel=1e-5)
    assert np.abs(away_rad(reference, time, cycles)).max() < 1e-3 * slope + 1e-5


@pytest.mark.parametrize("periods", [3, 4, 5])
def test_short_records(periods: int) -> None:
    time = np.arange(periods * 60) / RATE_HZ
    cycles = 0.1 + time / 1.2
    reference = reference_of(np.sin(2.0 * np.pi * cycles))
    assert np.abs(away_rad(reference, time, cycles)).max() < 2e-2


def test_few_periods_of_motion_in_a_long_rest() -> None:
    time = np.arange(3000) / RATE_HZ
    cycles = 0.77 * (time - 20.0)
    moving = (cycles > 0.0) & (cycles < 8.0)
    inside = (cycles > 2.0) & (cycles < 6.0)
    reference = reference_of(np.where(moving, np.sin(2.0 * np.pi * cycles), 0.0))
    assert np.abs(away_rad(reference, time[inside], cycles[inside])).max() < 1e-2


@pytest.mark.slow
def test_noise_is_no_reference() -> None:
    """Of 100 records of white noise of any length, at most a few may pass for a motion."""
    generator = np.random.default_rng(7)
    found = 0
    for _ in range(100):
        try:
            reference_of(generator.normal(size=int(generator.integers(100, 5000))))
            found += 1
        except DataError as error:
            assert "no reference found in channel 'force_0'" in str(error)  # noqa: PT017
    assert found <= 3


def test_noise_with_a_long_memory_is_rarely_a_reference() -> None:
    generator = np.random.default_rng(8)
    found = 0
    for noise in autoregressive(generator, (60, 3000), 0.95):
        try:
            reference_of(noise)
            found += 1
        except DataError:
            pass
    assert found <= 6


@pytest.mark.parametrize("value", [0.0, 0.1, 9.81, -1e6 / 3.0])
@pytest.mark.parametrize("samples", [100, 1000, 1237])
def test_a_constant_is_no_reference(value: float, samples: int) -> None:
    with pytest.raises(DataError, match=r"no reference found in channel 'force_0'.*name another"):
        reference_of(np.full(samples, value))


def test_a_ramp_is_no_reference() -> None:
    with pytest.raises(DataError, match="no reference found"):
        reference_of(np.arange(1000.0))


def test_a_record_that_is_too_short_is_called_so() -> None:
    with pytest.raises(DataError, match=r"not one whole period in 0\.58 s; the record is too sho"):
        reference_of(np.arange(30.0))
    with pytest.raises(DataError, match=r"it is constant over 19\.98 s|it is constant over 20 s"):
        reference_of(np.full(1000, 3.0))


@pytest.mark.parametrize("periods", [3, 4, 5, 8])
def test_few_periods_that_keep_time_are_a_warning(periods: int) -> None:
    time = np.arange(int(RATE_HZ * (periods + 0.5))) / RATE_HZ
    codes = {flag.code for flag in reference_of(np.sin(2.0 * np.pi * time)).flags}
    assert codes == ({"few_reference_periods"} if periods < 5 else set())
