"""Response, variance and coherence against a linear system that SciPy filters, from rest.

The system is a resonance in samples; its response is SciPy's ``freqz``. It starts from rest with
the gate, so that its transient, lightly damped, lies in it. Noise is coloured by another filter.
"""

import numpy as np
import pytest
from scipy.signal import freqz, lfilter

from analysis.recording import Recording
from analysis.resolver.estimate import resolve
from analysis.resolver.harmonics import Harmonics
from analysis.resolver.local_polynomial import cost, resolve_local
from analysis.resolver.reference import from_frequency
from analysis.resolver.sums import period_sums
from analysis.response.frequency_response import excited_lines, frequency_response
from hardware.description.arrays import FloatArray
from hardware.description.channels import Channel

RATE_HZ, PER_PERIOD, PERIODS = 100.0, 200, 8
LINES = (3, 5, 7, 11, 13)
HARMONICS = 14
POLES = (1.0, -2.0 * 0.995 * np.cos(0.3), 0.995**2)  # rings for a period


def motion(periods: int = PERIODS) -> FloatArray:
    theta = 2.0 * np.pi * np.arange(periods * PER_PERIOD + 1) / PER_PERIOD
    return np.asarray(sum(np.sin(n * theta + 0.7 * n**2) for n in LINES))


def truth() -> np.ndarray:
    omega = 2.0 * np.pi * np.array(LINES) / PER_PERIOD
    return np.asarray(freqz([1.0], POLES, worN=omega)[1])


def coloured(generator: np.random.Generator, channels: int, samples: int) -> FloatArray:
    white = generator.normal(size=(channels, samples + 2000))
    return np.asarray(lfilter([1.0], [1.0, -0.9], white)[:, 2000:])


def run(outputs: FloatArray) -> Recording:
    channels = (Channel("motion", "m"), *(Channel(f"load{k}", "N") for k in range(len(outputs))))
    return Recording("run", channels, np.vstack((motion(), outputs)), RATE_HZ)


def local(outputs: FloatArray) -> Harmonics:
    recording = run(outputs)
    reference = from_frequency(RATE_HZ / PER_PERIOD, 0.0, recording.end_s)
    edges = np.arange(PERIODS + 1.0)
    return resolve_local(recording, reference, edges, HARMONICS, take_out_drift=False)


def plain(outputs: FloatArray) -> Harmonics:
    recording = run(outputs)
    reference = from_frequency(RATE_HZ / PER_PERIOD, 0.0, recording.end_s)
    sums = period_sums(recording, reference, HARMONICS, edges_cycles=np.arange(PERIODS + 1.0))
    return resolve(recording, sums, take_out_drift=False)


def test_a_transient_is_taken_off() -> None:
    struck = motion()
    struck[0] += 200.0
    response = lfilter([1.0], POLES, struck)[None]
    off = [
        np.abs(frequency_response(one(response), "motion", "load0").values / truth() - 1.0)
        for one in (plain, local)
    ]
    assert off[0].max() > 0.05  # it matters
    assert off[1].max() < off[0].max() / 30.0


def test_lines_are_found_where_the_motion_has_them() -> None:
    assert excited_lines(local(motion()[None]), "motion") == LINES


@pytest.mark.slow
def test_variance_is_that_of_theory_in_coloured_noise() -> None:
    """Whole periods have the noise's spectrum over the samples; local polynomials ``cost`` of it.

    A harmonic's complex phasor has the variance 4 S / N, S the noise's spectrum per sample.
    """
    generator = np.random.default_rng(4)
    scattered, told = np.zeros(HARMONICS), np.zeros(HARMONICS)
    for _ in range(8):
        reading = local(coloured(generator, 50, PERIODS * PER_PERIOD + 1))
        phasors = reading.in_phase[1:] + 1j * reading.quadrature[1:]
        scattered += (np.abs(phasors) ** 2).sum(axis=0) / 400.0
        own = reading.standard_uncertainty[1:, 1:].reshape(50, HARMONICS, 2)
        told += (own**2).sum(axis=(0, 2)) / 400.0
    omega = 2.0 * np.pi * np.arange(1, HARMONICS + 1) / PER_PERIOD
    spectrum = np.abs(freqz([1.0], [1.0, -0.9], worN=omega)[1]) ** 2
    theory = cost(PERIODS) * 4.0 * spectrum / (PERIODS * PER_PERIOD)
    later = slice(2, None)  # below, the noise's spectrum bends between the bins
    ratio = (scattered / theory)[later]
    assert ratio == pytest.approx(np.ones(len(ratio)), abs=0.25)
    assert ratio.mean() == pytest.approx(1.0, abs=0.06)
    assert (told / scattered)[later].mean() == pytest.approx(1.0, abs=0.06)


def test_noise_in_the_motion_counts_once() -> None:
    """Noise that both channels share moves the response as its own part alone."""
    reading = local(3.0 * motion()[None])
    assert frequency_response(reading, "motion", "load0").variance.max() < 1e-18


def test_coherence_against_power() -> None:
    """Of a period: the power that goes with the motion over all of it."""
    generator = np.random.default_rng(5)
    samples = PERIODS * PER_PERIOD + 1
    steady = lfilter([1.0], POLES, motion(PERIODS + 20))[-samples:]
    noise = 8.0 * coloured(generator, 60, samples)
    reading = local(steady + noise)
    found = [frequency_response(reading, "motion", f"load{k}", LINES) for k in range(60)]
    omega = 2.0 * np.pi * np.array(LINES) / PER_PERIOD
    spectrum = 64.0 * np.abs(freqz([1.0], [1.0, -0.9], worN=omega)[1]) ** 2
    per_period = cost(PERIODS) * 4.0 * spectrum / PER_PERIOD
    power = np.abs(truth()) ** 2
    expected = power / (power + per_period)
    mean = np.mean([one.coherence for one in found], axis=0)
    assert mean == pytest.approx(expected, abs=0.05)
    assert expected.min() < 0.9  # the noise matters


@pytest.mark.slow
def test_intervals_hold_the_truth_as_often_as_they_say() -> None:
    """The transient is in it; 2 x 5 x 150 parts, so 95 % have a standard deviation of 0.6 %."""
    generator = np.random.default_rng(6)
    samples = PERIODS * PER_PERIOD + 1
    response = lfilter([1.0], POLES, motion()) + 2.0 * coloured(generator, 150, samples)
    reading = local(response)
    found = [frequency_response(reading, "motion", f"load{k}", LINES) for k in range(150)]
    factor = reading.coverage_factor()[1]
    off = np.array([one.values - truth() for one in found])
    half = factor * np.sqrt(np.array([one.variance for one in found]) / 2.0)
    held = np.concatenate((np.abs(off.real) < half, np.abs(off.imag) < half))
    assert held.mean() == pytest.approx(0.95, abs=0.02)
