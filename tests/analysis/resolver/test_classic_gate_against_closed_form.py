"""The gated integration of 1963, and the gate cut to whole samples, against closed forms."""

import numpy as np
import pytest

from analysis.recording import Recording
from analysis.resolver.classic_gate_state import GateReading
from analysis.resolver.classic_recording import gated_readings, rounded_gate
from analysis.resolver.reference import PhaseReference, from_frequency
from hardware.description.arrays import FloatArray
from hardware.description.channels import Channel
from hardware.description.errors import DataError
from tests.analysis.resolver.classic_errors import (
    gate_drift_bias,
    gate_edge_error,
    gate_leak,
    rounded_gate_error,
)

PHASES = np.linspace(0.0, 2.0 * np.pi, 72, endpoint=False)


def record(
    samples: FloatArray, rate_hz: float, frequency_hz: float, phase_rad: float = 0.0
) -> tuple[Recording, PhaseReference]:
    channels = tuple(Channel(f"c{k}", "N") for k in range(len(samples)))
    recording = Recording("run", channels, samples, rate_hz)
    return recording, from_frequency(frequency_hz, 0.0, recording.end_s, phase_rad)


def theta(
    seconds: float, rate_hz: float, frequency_hz: float, phase_rad: float = 0.0
) -> FloatArray:
    time = np.arange(round(seconds * rate_hz) + 1) / rate_hz
    return 2.0 * np.pi * frequency_hz * time + phase_rad


def first(recording: Recording, reference: PhaseReference, periods: int) -> GateReading:
    return gated_readings(recording, reference, periods=periods)[0]


@pytest.mark.parametrize("periods", [1, 2, 3, 4, 7])
def test_harmonics_come_back_to_the_error_of_the_edges(periods: int) -> None:
    angle = theta(10.0, 100.0, 1.0137, 0.3)
    signal = 10.0 + np.sin(angle + 0.5) + 0.2 * np.sin(2 * angle - 1.0)
    reading = first(*record(signal[None], 100.0, 1.0137, 0.3), periods)
    samples = 100.0 / 1.0137
    for n, (amplitude, phase) in enumerate([(1.0, 0.5), (0.2, -1.0), (0.0, 0.0)], start=1):
        bound = 10.0 * gate_edge_error(n, 0, samples, periods)
        bound += gate_edge_error(n, 1, samples, periods) + gate_edge_error(n, 2, samples, periods)
        wanted = amplitude * np.exp(1j * phase)
        got = complex(reading.in_phase[0, n - 1], reading.quadrature[0, n - 1])
        assert abs(got - wanted) < np.sqrt(2.0) * 1.05 * bound
    assert reading.closed_s - reading.opened_s == pytest.approx(periods / 1.0137, rel=1e-12)
    assert not reading.flags


@pytest.mark.sample(1)
@pytest.mark.parametrize(("order", "k"), [(1, 0), (2, 0), (1, 1), (1, 3), (3, 2)])
def test_edge_error_is_bounded_by_the_closed_form_and_reaches_it(order: int, k: int) -> None:
    # Channels are phases of the component; runs differ in where the edges fall between samples.
    worst, least_samples = 0.0, np.inf
    for step in range(120):
        samples, phase = 59.5 + 0.00841 * step, 0.37 * step
        angle = theta(4.0, samples, 1.0, phase)
        component = np.sin(k * angle + PHASES[:, None])
        reading = first(*record(component, samples, 1.0, phase), 1)
        wanted = np.exp(1j * PHASES) if k == order else 0.0
        got = reading.in_phase[:, order - 1] + 1j * reading.quadrature[:, order - 1]
        left = got - wanted
        worst = max(worst, np.abs(left.real).max(), np.abs(left.imag).max())
        least_samples = min(least_samples, samples)
    bound = gate_edge_error(order, k, least_samples, 1)
    assert 0.7 * bound < worst < 1.02 * bound


@pytest.mark.parametrize("periods", [1, 2, 4])
@pytest.mark.parametrize("order", [1, 2, 3])
def test_drift_bias_is_the_closed_form_whatever_m_is(periods: int, order: int) -> None:
    angle = theta(6.0, 200.0, 0.97)
    drift = 1.3 * angle / (2.0 * np.pi)
    reading = first(*record(drift[None], 200.0, 0.97), periods)
    in_phase, quadrature = gate_drift_bias(order, 1.3)
    assert in_phase == pytest.approx(-1.3 / (order * np.pi))
    assert reading.in_phase[0, order - 1] == pytest.approx(in_phase, abs=1e-3)
    assert reading.quadrature[0, order - 1] == pytest.approx(quadrature, abs=1e-3)


def test_drift_bias_turns_with_the_angle_at_which_the_gate_opens() -> None:
    angle = theta(6.0, 400.0, 0.97)
    recording, reference = record(angle[None] / (2.0 * np.pi), 400.0, 0.97)
    pulses = reference.times_at(np.array([0.2, 1.2]))
    reading = gated_readings(recording, reference, pulses_s=pulses)[0]
    bias = gate_drift_bias(2, 1.0, 0.4 * np.pi)
    assert (reading.in_phase[0, 1], reading.quadrature[0, 1]) == pytest.approx(bias, abs=1e-3)


@pytest.mark.sample(3)
@pytest.mark.parametrize("periods", [1, 3])
@pytest.mark.parametrize("x", [0.37, 1.37, 5.37, 2.5])
def test_interference_leaks_as_the_boxcar(periods: int, x: float) -> None:
    angle = theta(5.0, 500.0, 1.0)
    component = np.sin(x * angle + np.linspace(0, 2 * np.pi, 360, endpoint=False)[:, None])
    reading = first(*record(component, 500.0, 1.0), periods)
    in_phase, quadrature = gate_leak(1, x, periods)
    assert np.abs(reading.in_phase[:, 0]).max() == pytest.approx(in_phase, abs=2e-4)
    assert np.abs(reading.quadrature[:, 0]).max() == pytest.approx(quadrature, abs=2e-4)


@pytest.mark.parametrize(
    ("periods", "x", "table"),
    [(1, 0.37, 0.68), (1, 1.37, 0.91), (1, 5.37, 0.11), (3, 0.37, 0.083), (10, 1.37, 0.080)],
)
def test_leak_is_that_of_the_reference_table(periods: int, x: float, table: float) -> None:
    assert max(gate_leak(1, x, periods)) == pytest.approx(table, rel=0.03)


def test_leak_vanishes_where_m_x_is_whole_and_is_one_at_the_harmonic() -> None:
    assert max(gate_leak(1, 2.5, 4)) < 1e-15
    assert gate_leak(2, 2.0, 3) == pytest.approx((1.0, 1.0))


def test_variance_is_that_of_least_squares() -> None:
    noise = np.random.default_rng(8).standard_normal((4000, 301))
    reading = first(*record(noise, 100.0, 1.0), 2)
    assert np.mean(reading.in_phase**2) == pytest.approx(2.0 / 200.0, rel=0.05)


def test_the_gate_rounded_to_samples_is_off_by_five_hundredths() -> None:
    left, edges = [], []
    for frequency_hz in 1.0 + 0.2 * np.random.default_rng(5).random(200) - 0.1:
        angle = theta(2.2, 100.0, frequency_hz, -0.4)
        recording, reference = record((10.0 + np.sin(angle))[None], 100.0, frequency_hz, -0.4)
        pulses = reference.times_at(np.array([0.0, 1.0]))
        rounded = rounded_gate(recording, reference, *pulses)
        apparatus = gated_readings(recording, reference, pulses_s=pulses)[0]
        bound = 11.0 * rounded_gate_error(100.0 / frequency_hz, 1)
        error = np.array([rounded.in_phase[0, 0] - 1.0, rounded.quadrature[0, 0]])
        assert np.abs(error).max() < bound
        left.append(error)
        edges.append([apparatus.in_phase[0, 0] - 1.0, apparatus.quadrature[0, 0]])
    assert 3e-2 < np.sqrt(np.mean(np.square(left))) < 8e-2
    assert np.sqrt(np.mean(np.square(edges))) < 4e-5


def test_a_rounded_gate_outside_the_record_is_refused() -> None:
    recording, reference = record(np.ones((1, 301)), 100.0, 1.0)
    with pytest.raises(DataError, match=r"samples 250 to 350 of 301"):
        rounded_gate(recording, reference, 2.5, 3.5)
