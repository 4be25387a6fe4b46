"""Shaft encoders: wrapped or not, either way round, with an offset, at rest, with ripple."""

import numpy as np
import pytest

from analysis.resolver.estimate import resolve
from analysis.resolver.photocell import from_photocell
from analysis.resolver.reference import from_encoder
from analysis.resolver.sums import period_sums
from hardware.description.errors import DataError
from hardware.description.flags import Severity
from tests.analysis.resolver.signals import FloatArray, recording

RATE_HZ = 200.0
TIME = np.arange(4000) / RATE_HZ
ANGLE = 2.0 * np.pi * 1.03 * TIME + 0.6


def first(angle: FloatArray, force: FloatArray, offset_rad: float = 0.0) -> complex:
    """Phasor of the first harmonic, in phase + i quadrature."""
    run = recording(force, RATE_HZ)
    reference = from_encoder(TIME, angle, offset_rad)
    result = resolve(run, period_sums(run, reference))
    return complex(result.in_phase[0, 0], result.quadrature[0, 0])


@pytest.mark.parametrize("wrapped", [False, True])
@pytest.mark.parametrize("offset_rad", [0.0, 0.5, -2.0])
def test_shaft_angle_is_what_the_encoder_reads_and_its_offset(
    wrapped: bool, offset_rad: float
) -> None:
    reading = ANGLE % (2.0 * np.pi) if wrapped else ANGLE
    force = 2.0 * np.sin(ANGLE + offset_rad + 0.3)
    assert first(reading, force, offset_rad) == pytest.approx(2.0 * np.exp(0.3j), abs=1e-9)


@pytest.mark.parametrize("offset_rad", [0.0, 0.5])
def test_reverse_rotation_is_counted_positive_and_flagged(offset_rad: float) -> None:
    """The shaft's own angle still grows; the encoder, seen from its other end, counts down."""
    reading = -ANGLE % (2.0 * np.pi)
    force = np.sin(ANGLE + offset_rad + 0.3)
    assert first(reading, force, offset_rad) == pytest.approx(np.exp(0.3j), abs=1e-9)
    flags = from_encoder(TIME, reading).flags
    assert [flag.code for flag in flags] == ["reverse_rotation"]
    assert not from_encoder(TIME, ANGLE).flags


def test_encoder_sees_the_ripple_that_one_pulse_per_revolution_cannot() -> None:
    """Speed ripple of 1 % once per revolution: 0.5 % of A1 in n = 2 by photocell, none here."""
    turned = 2.0 * np.pi * 1.03 * TIME
    angle = turned + 0.01 * np.sin(turned)  # speed 1 + 0.01 cos(theta), to first order
    run = recording(np.sin(angle), RATE_HZ)
    edges = np.interp(2.0 * np.pi * np.arange(20.0), angle, TIME)
    by_pulse = resolve(run, period_sums(run, from_photocell(edges)))
    by_angle = resolve(run, period_sums(run, from_encoder(TIME, angle)))
    assert by_pulse.amplitude[0, 1] == pytest.approx(0.005, rel=0.02)
    assert by_angle.amplitude[0, 1] < 1e-5
    assert by_angle.amplitude[0, 0] == pytest.approx(1.0, abs=1e-5)


def test_standstill_at_the_start_and_the_end_is_left_out() -> None:
    """The reference begins to turn when the shaft does, and ends when it stops."""
    moving = np.clip(TIME - 5.0, 0.0, 10.0)
    angle = 2.0 * np.pi * 1.03 * moving
    run = recording(np.sin(angle + 0.3), RATE_HZ)
    reference = from_encoder(TIME, angle % (2.0 * np.pi))
    assert np.all(np.diff(reference.cycles) > 0.0)
    assert reference.cycles[-1] == pytest.approx(10.3, abs=1e-9)
    assert reference.times_at(np.array([0.01]))[0] == pytest.approx(5.0, abs=0.02)
    sums = period_sums(run, reference)
    result = resolve(run, sums[1:])
    assert result.periods == 9
    assert result.phase_rad[0, 0] == pytest.approx(0.3, abs=1e-6)


def test_noise_at_rest_does_not_turn_the_phase_back() -> None:
    noise = 1e-3 * np.random.default_rng(3).normal(size=TIME.size)
    angle = 2.0 * np.pi * 1.03 * np.maximum(TIME - 5.0, 0.0) + noise
    reference = from_encoder(TIME, angle)
    assert np.all(np.diff(reference.cycles) > 0.0)
    assert np.all(np.diff(reference.times_s) > 0.0)
    inside = reference.cycles_at(TIME[1200:]) - angle[1200:] / (2.0 * np.pi)
    assert np.abs(inside).max() < 2e-3


@pytest.mark.parametrize("wrapped", [False, True])
@pytest.mark.parametrize("noise_deg", [0.1, 1.0, 3.0])
@pytest.mark.parametrize("rate_hz", [200.0, 1000.0])
def test_noise_does_not_carry_the_phase_ahead(
    noise_deg: float, wrapped: bool, rate_hz: float
) -> None:
    """The highest readings of 3 degrees' noise are 2 degrees ahead on average."""
    time = np.arange(20.0 * rate_hz) / rate_hz
    angle = 2.0 * np.pi * 1.03 * time + 0.6
    noise = np.radians(noise_deg) * np.random.default_rng(12).normal(size=time.size)
    reading = (angle + noise) % (2.0 * np.pi) if wrapped else angle + noise
    reference = from_encoder(time, reading)
    ahead = 2.0 * np.pi * reference.cycles_at(time) - angle
    ahead -= 2.0 * np.pi * np.rint(ahead.mean() / 2.0 / np.pi)
    assert abs(np.degrees(ahead).mean()) < 4.0 * noise_deg / np.sqrt(time.size)
    assert not reference.flags


@pytest.mark.parametrize("reads_deg", [90.0, 180.0, 270.0])
def test_a_sample_read_while_the_encoder_wraps_is_left_out(reads_deg: float) -> None:
    reading = ANGLE % (2.0 * np.pi)
    wraps = np.flatnonzero(np.diff(reading) < 0.0)[3:9:2]
    reading[wraps] = np.radians(reads_deg)
    reference = from_encoder(TIME, reading)
    assert reference.cycles_at(TIME) == pytest.approx(ANGLE / 2.0 / np.pi, abs=1e-9)
    (flag,) = reference.flags
    assert flag.code == "angle_stray"
    assert "3 samples" in flag.message
    assert f"{TIME[wraps[0]]:.3f} s" in flag.message


def test_an_angle_that_falls_back_is_flagged() -> None:
    """A coupling that slips by 40 degrees after 10 s is caught up with 40 / 360 turns later."""
    reading = ANGLE - np.radians(40.0) * (TIME >= 10.0)
    reference = from_encoder(TIME, reading)
    (flag,) = reference.flags
    assert (flag.code, flag.severity) == ("angle_falls_back", Severity.VOID)
    assert "falls back by 38.1 degrees from 10.000 s" in flag.message  # 40 less one step
    assert reference.cycles_at(TIME[:2000]) == pytest.approx(ANGLE[:2000] / 2.0 / np.pi, abs=1e-9)


@pytest.mark.slow
def test_many_samples_are_thinned_without_losing_the_ripple() -> None:
    time = np.arange(200_000) / 10_000.0
    turned = 2.0 * np.pi * 1.03 * time
    reference = from_encoder(time, turned + 0.01 * np.sin(turned))
    assert len(reference.cycles) < 300 * 21
    exact = (turned + 0.01 * np.sin(turned)) / (2.0 * np.pi)
    assert reference.cycles_at(time) == pytest.approx(exact, abs=1e-6)


def test_less_than_one_turn_is_no_reference() -> None:
    with pytest.raises(DataError, match=r"makes 0\.80 turns; at least one"):
        from_encoder(TIME, np.linspace(0.0, 1.6 * np.pi, TIME.size))


def test_missing_angle_is_refused() -> None:
    angle = ANGLE.copy()
    angle[77] = np.nan
    with pytest.raises(DataError, match="missing samples"):
        from_encoder(TIME, angle)
