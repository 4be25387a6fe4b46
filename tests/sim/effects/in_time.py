"""Runs in the time domain, analysed for what does not repeat with the shaft."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.setpoint import SetPoint
from sim.rig import SimulatedRig
from sim.signals import Signals


@dataclass(frozen=True, eq=False)
class InTime:
    """The signals of a run with a whole number of samples a period."""

    signals: Signals
    sample_rate_hz: float

    @property
    def time_s(self) -> FloatArray:
        """Times from the first sample of the run."""
        return np.arange(self.signals["shaft_angle"].size) / self.sample_rate_hz

    @property
    def edges(self) -> FloatArray:
        """Times of the photocell's pulses."""
        return self.signals["photocell_edge_time"]

    def less(self, other: "InTime") -> "InTime":
        """Return this run less another one of the same samples."""
        pairs = {name: values - other.signals[name] for name, values in self.signals.items()}
        return InTime(pairs, self.sample_rate_hz)


def in_time(rig: SimulatedRig, set_point: SetPoint, periods: int, per_period: int) -> InTime:
    """Run from rest; the pulses fall on samples, the first after half a period."""
    rate = per_period * set_point.frequency_hz
    chain = rig.chain(set_point)
    count = (periods + 1) * per_period + 1
    return InTime(chain.run(chain.start(rate, seed=1), count)[1], rate)


def between(run: InTime, name: str, first_s: float, last_s: float, cycles: float) -> FloatArray:
    """Project a signal between two times onto orders 0 to 4 of ``cycles`` cycles; trapezoid rule.

    The first time has to fall on a sample; the last sample is weighted for the part beyond it.
    """
    first, last = round(first_s * run.sample_rate_hz), round(last_s * run.sample_rate_hz)
    values = run.signals[name][first : last + 1]
    weights = np.ones(values.size)
    weights[[0, -1]] = 0.5
    weights /= weights.sum()
    phase = 2.0 * np.pi * cycles * np.arange(values.size) / (values.size - 1)
    found = [np.sum(weights * values)]
    found += [
        2.0 * np.sum(weights * values * (np.sin(n * phase) + 1j * np.cos(n * phase)))
        for n in range(1, 5)
    ]
    return np.array(found)


def by_cycles(run: InTime, name: str, cycles: int = 1) -> FloatArray:
    """Return ``S + i C`` of orders 0 to 4, averaged over windows of so many pulses each.

    Each window is stretched to that many cycles, whatever time it took.
    """
    edges = run.edges[::cycles]
    return np.mean([between(run, name, *pair, cycles) for pair in pairwise(edges)], axis=0)


def lines(
    run: InTime,
    name: str,
    frequencies_hz: list[float],
    decay_s: float = np.inf,
    first_s: float = 0.0,
) -> dict[float, complex]:
    """Fit sines and cosines of these frequencies by least squares, with a mean."""
    late = run.time_s >= first_s
    time = run.time_s[late]
    fade = np.exp(-time / decay_s)
    columns = [np.ones_like(time)]
    for frequency in frequencies_hz:
        turned = 2.0 * np.pi * frequency * time
        columns += [fade * np.sin(turned), fade * np.cos(turned)]
    found = np.linalg.lstsq(np.column_stack(columns), run.signals[name][late], rcond=None)[0]
    pairs = found[1:].reshape(-1, 2)
    return {one: complex(*pair) for one, pair in zip(frequencies_hz, pairs.tolist(), strict=True)}
