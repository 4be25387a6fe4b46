"""Distortion levels against the line spectrum of a static power, by convolution.

The spectrum of a product is the convolution of the factors' spectra: exact, and no resolver in it.
"""

import numpy as np
import pytest

from analysis.recording import Recording
from analysis.resolver.local_polynomial import resolve_local
from analysis.resolver.reference import from_frequency
from analysis.response.distortion import Degree, Distortion, distortions
from analysis.response.frequency_response import frequency_response
from analysis.response.multisine import odd_lines_with_gaps, schroeder_phases
from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.channels import Channel

PER_PERIOD, PERIODS, HARMONICS = 400, 8, 29
LINES = odd_lines_with_gaps(1, 29, 4, seed=3)
AMPLITUDES = np.ones(len(LINES)) / len(LINES) ** 0.5
PHASES = schroeder_phases(AMPLITUDES)


def spectrum() -> ComplexArray:
    """Two-sided line spectrum of the motion, orders -29 to 29."""
    lines = np.zeros(2 * HARMONICS + 1, dtype=np.complex128)
    for n, a, phase in zip(LINES, AMPLITUDES, PHASES, strict=True):
        lines[HARMONICS + n] = a * np.exp(1j * phase) / 2j
        lines[HARMONICS - n] = np.conj(lines[HARMONICS + n])
    return lines


def motion() -> FloatArray:
    theta = 2.0 * np.pi * np.arange(PERIODS * PER_PERIOD + 1) / PER_PERIOD
    return np.asarray(AMPLITUDES @ np.sin(np.outer(LINES, theta) + PHASES[:, None]))


def level(power: int) -> dict[Degree, float]:
    """Root mean square amplitude that ``u**power`` has at the detection lines."""
    own = lines = spectrum()
    for _ in range(power - 1):
        lines = np.convolve(lines, own)
    middle = len(lines) // 2
    free = [n for n in range(1, HARMONICS + 1) if n not in LINES]
    size = {n: 2.0 * abs(lines[middle + n]) for n in free}
    return {
        degree: float(np.sqrt(np.mean([size[n] ** 2 for n in free if n % 2 == parity])))
        for degree, parity in ((Degree.ODD, 1), (Degree.EVEN, 0))
    }


def seen(motion: FloatArray, loads: FloatArray) -> list[dict[Degree, Distortion]]:
    """Return the distortions of each load."""
    channels = (Channel("motion", "m"), *(Channel(f"load{k}", "N") for k in range(len(loads))))
    recording = Recording("run", channels, np.vstack((motion, loads)), 100.0)
    reference = from_frequency(100.0 / PER_PERIOD, 0.0, recording.end_s)
    edges = np.arange(PERIODS + 1.0)
    reading = resolve_local(recording, reference, edges, HARMONICS, take_out_drift=False)
    responses = [
        frequency_response(reading, "motion", f"load{k}", LINES) for k in range(len(loads))
    ]
    return [{one.degree: one for one in distortions(reading, each)} for each in responses]


def noisy(output: FloatArray, runs: int) -> FloatArray:
    noise = np.random.default_rng(2).normal(size=(runs, len(output)))
    return np.asarray(output + 0.2 * noise)


def test_cubic_within_five_per_cent() -> None:
    u, own = motion(), 2.0 * level(3)[Degree.ODD]
    odd = [one[Degree.ODD] for one in seen(u, noisy(50.0 * u + 2.0 * u**3, 20))]
    assert all(one.is_significant for one in odd)
    off = np.array([one.level for one in odd]) - own
    assert np.abs(off).max() < 0.05 * own
    assert off.std() == pytest.approx(np.mean([one.uncertainty for one in odd]), rel=0.4)


def test_square_stands_at_even_lines() -> None:
    u = motion()
    (one,) = seen(u, noisy(50.0 * u + 2.0 * u**2, 1))
    assert one[Degree.EVEN].is_significant
    assert one[Degree.EVEN].level == pytest.approx(2.0 * level(2)[Degree.EVEN], rel=0.05)
    assert one[Degree.ODD].chance > 1e-3


@pytest.mark.slow
def test_noise_is_taken_for_a_distortion_as_seldom_as_it_says() -> None:
    u = motion()
    told = [one.is_significant for run in seen(u, noisy(50.0 * u, 100)) for one in run.values()]
    assert 0.01 < np.mean(told) < 0.10  # 5 % of 200, and three standard deviations


def test_an_impure_motion_is_no_distortion() -> None:
    """A line of the motion itself between the lines, and a response that is linear."""
    theta = 2.0 * np.pi * np.arange(PERIODS * PER_PERIOD + 1) / PER_PERIOD
    moved = motion() + 0.01 * np.sin(4 * theta)
    (one,) = seen(moved, noisy(50.0 * moved, 1))
    assert all(each.chance > 1e-3 for each in one.values())
