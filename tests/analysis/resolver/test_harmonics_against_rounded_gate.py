"""The rival: a gate rounded to whole samples, off by 5e-2 where the resolver is exact."""

import numpy as np

from analysis.resolver.estimate import resolve
from analysis.resolver.reference import from_frequency
from analysis.resolver.sums import period_sums
from tests.analysis.resolver.signals import FloatArray, recording, series

CONTENT = np.array([10.0, 1.0, 0.0])  # a constant of 10 under a sine of 1


def rounded_gate(values: FloatArray, cycles: FloatArray, edges: FloatArray) -> FloatArray:
    """Multiply, sum over whole samples, divide by their number: what many programs do."""
    first, last = np.rint(edges).astype(int)
    theta = 2.0 * np.pi * cycles[first:last]
    both = np.stack((np.sin(theta), np.cos(theta)))
    return np.asarray(2.0 * (both * values[first:last]).mean(axis=1))


def errors(periods: int) -> tuple[FloatArray, FloatArray]:
    """Errors of in-phase and quadrature of the rival and of the resolver, over many signals."""
    generator = np.random.default_rng(1)
    rival, ours = [], []
    for frequency_hz, phase in zip(
        generator.uniform(0.8, 1.25, 100), generator.uniform(0.0, 1.0, 100), strict=True
    ):
        cycles = phase + frequency_hz * np.arange(int(100 * (periods + 2) / frequency_hz)) / 100.0
        run = recording(series(CONTENT, cycles))
        reference = from_frequency(frequency_hz, 0.0, run.end_s, 2.0 * np.pi * phase)
        edges = np.ceil(phase) + np.arange(periods + 1.0)
        samples = run.sample_number(reference.times_at(edges[[0, -1]]))
        rival.append(rounded_gate(run.samples[:, :][0], cycles, samples) - CONTENT[1:])
        result = resolve(run, period_sums(run, reference, 1, edges_cycles=edges))
        ours.append(result.coefficients[0, 1:] - CONTENT[1:])
    return np.array(rival), np.array(ours)


def test_rounded_gate_is_off_where_the_resolver_is_exact() -> None:
    rival, ours = errors(1)
    rms = np.sqrt((rival**2).mean())
    assert 0.04 < rms < 0.08
    assert np.abs(ours).max() < 1e-12


def test_ten_periods_help_the_rival_only_tenfold() -> None:
    rival, ours = errors(10)
    rms = np.sqrt((rival**2).mean())
    assert 0.004 < rms < 0.008
    assert np.abs(ours).max() < 1e-12
