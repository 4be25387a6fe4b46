"""Known sums of harmonics come back: at any frequency, phase and gate, at 100 Hz and about 1 Hz."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.resolver.estimate import resolve
from analysis.resolver.reference import from_frequency
from analysis.resolver.sums import period_sums
from tests.analysis.resolver.signals import FloatArray, recording, series

# First three harmonics and constant are modelled; the rest of 0.1 are not.
MODELLED = np.array([10.0, 1.0, 0.4, -0.3, 0.2, 0.15, -0.1])
UNMODELLED = np.array([0.08, 0.06, -0.1, 0.0, 0.07, -0.07, 0.0, 0.1, 0.06, 0.08])

frequencies = st.floats(0.8, 1.25)
phases = st.floats(0.0, 1.0)


def run(frequency_hz: float, first_cycle: float, periods: int, *, higher=False, drift=0.0):  # type: ignore[no-untyped-def]
    """Resolve one gate of ``periods`` somewhere inside a record."""
    samples = int(100.0 * (periods + 3) / frequency_hz)
    cycles = first_cycle + frequency_hz * np.arange(samples) / 100.0
    content = np.concatenate((MODELLED, UNMODELLED)) if higher else MODELLED
    run = recording(series(content, cycles) + drift * cycles)
    reference = from_frequency(frequency_hz, 0.0, run.end_s, 2.0 * np.pi * first_cycle)
    edges = first_cycle + 1.3 + np.arange(periods + 1)
    sums = period_sums(run, reference, 3, edges_cycles=edges)
    return resolve(run, sums), drift * (edges[0] + edges[-1]) / 2.0


def error(frequency_hz: float, first_cycle: float, periods: int, **content: object) -> FloatArray:
    result, level = run(frequency_hz, first_cycle, periods, **content)
    difference: FloatArray = result.coefficients[0] - MODELLED
    difference[0] -= level
    return np.abs(difference)


@given(frequencies, phases, st.sampled_from([1, 2, 3, 4, 7]))
def test_modelled_harmonics_are_exact(frequency: float, phase: float, periods: int) -> None:
    assert error(frequency, phase, periods).max() < 1e-12


@given(frequencies, phases)
def test_unmodelled_harmonics_stay_out_of_one_period(frequency: float, phase: float) -> None:
    assert error(frequency, phase, 1, higher=True).max() < 1e-6


@given(frequencies, phases, st.integers(2, 6))
def test_drift_and_unmodelled_harmonics_stay_out(freq: float, phase: float, periods: int) -> None:
    assert error(freq, phase, periods, higher=True, drift=1.0).max() < 1e-6


@given(frequencies, phases, st.integers(2, 6))
def test_drift_alone_is_taken_out(frequency: float, phase: float, periods: int) -> None:
    assert error(frequency, phase, periods, drift=1.0).max() < 1e-8


@given(frequencies, phases, st.integers(1, 12))
def test_any_number_of_harmonics(frequency: float, phase: float, harmonics: int) -> None:
    content = np.random.default_rng(harmonics).normal(size=2 * harmonics + 1)
    cycles = phase + frequency * np.arange(500) / 100.0
    run = recording(series(content, cycles))
    reference = from_frequency(frequency, 0.0, run.end_s, 2.0 * np.pi * phase)
    result = resolve(run, period_sums(run, reference, harmonics))
    assert np.abs(result.coefficients[0] - content).max() < 1e-11


def test_amplitude_and_phase_are_those_of_the_sine() -> None:
    cycles = 1.1 * np.arange(1000) / 100.0
    run = recording(2.0 * np.sin(2.0 * np.pi * cycles + 0.7))
    result = resolve(run, period_sums(run, from_frequency(1.1, 0.0, run.end_s)))
    assert result.amplitude[0, 0] == pytest.approx(2.0, abs=1e-12)
    assert result.phase_rad[0, 0] == pytest.approx(0.7, abs=1e-12)
    assert result.frequency_hz == pytest.approx(1.1, abs=1e-12)
