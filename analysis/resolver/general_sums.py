"""Sums of any period: non-linear phase, any orders, a taper, the ends of the record.

Slower than :mod:`analysis.resolver.straight_sums`, which takes the usual periods.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from analysis.recording import Recording
from analysis.resolver.basis import harmonic_basis
from analysis.resolver.reference import PhaseReference
from analysis.resolver.straight_sums import Gates, Sums
from analysis.resolver.weights import REACH, gate_weights
from hardware.description.arrays import BoolArray, FloatArray

Taper = Callable[[FloatArray], FloatArray]
"""Extra weight of samples as a function of their cycles."""


@dataclass(frozen=True)
class GeneralSums:
    """Sums of any period: bent phase, any orders, a taper, the ends of the record."""

    recording: Recording
    reference: PhaseReference
    orders: FloatArray
    taper: Taper | None

    @property
    def uneven(self) -> bool:
        """Whether the samples have stamps of their own."""
        return self.recording.stamps_s is not None

    def needed(self, gates: Gates) -> BoolArray:
        """Tell which periods the quick sums cannot take."""
        if (
            self.taper is not None
            or self.uneven
            or not np.array_equal(self.orders, np.arange(1.0, len(self.orders) + 1.0))
        ):
            return np.ones(len(gates.opening), dtype=np.bool_)
        starts_early = gates.opening < REACH - 1
        ends_late = gates.closing >= self.recording.sample_count - REACH
        return np.asarray(self._is_bent(gates) | starts_early | ends_late)

    def _is_bent(self, gates: Gates) -> BoolArray:
        """Tell in which periods the phase does not run straight."""
        inside = 1e-9 * (gates.closing_cycle - gates.opening_cycle)
        knots = self.reference.cycles
        after = np.searchsorted(knots, gates.opening_cycle + inside, side="right")
        return np.asarray(np.searchsorted(knots, gates.closing_cycle - inside, side="left") > after)

    def empty_sums(self, periods: int) -> Sums:
        """Room for the sums of some periods."""
        size = 2 * len(self.orders) + 1
        channels = len(self.recording.channels)
        return (
            np.empty((periods, size, size)),
            np.empty((periods, channels, size)),
            np.empty((periods, size)),
        )

    def sum(self, block: FloatArray, first: int, gate: Gates) -> Sums:
        """Sum one period, given in sample numbers of a block that starts at ``first``."""
        if self.uneven:
            return self._sum_uneven(block, first, gate)

        def cycles(numbers: FloatArray) -> FloatArray:
            since_start_s = (first + numbers) / self.recording.sample_rate_hz
            return self.reference.cycles_at(self.recording.start_s + since_start_s)

        # The few samples beyond either edge take part in the same line, as in the quick sums.
        straight = self.taper is None and not self._is_bent(gate)[0]
        turned = gate.cycles_of_first if straight else cycles
        return sum_any(block, gate, turned, self.orders, self.taper)

    def _sum_uneven(self, block: FloatArray, first: int, gate: Gates) -> Sums:
        """Sum the samples inside a period, each with the weight 1, wherever they lie.

        Weights of edges are those of an even grid. The normal equations need none: what the basis
        spans comes out exactly.
        """
        start, stop = (int(np.ceil(edge[0])) for edge in (gate.opening, gate.closing))
        times_s = self.recording.time_s(first + start, first + stop)
        turned = self.reference.cycles_at(times_s)
        basis = harmonic_basis(turned, self.orders)
        weighted = basis if self.taper is None else basis * self.taper(turned)
        intervals = (times_s - self.recording.start_s) * self.recording.sample_rate_hz - first
        return weighted @ basis.T, block[:, start:stop] @ weighted.T, weighted @ intervals


def sum_any(
    samples: FloatArray,
    gate: Gates,
    cycles: Callable[[FloatArray], FloatArray],
    orders: FloatArray,
    taper: Taper | None = None,
) -> Sums:
    """Sum one period of any phase, at the ends of the record too; the ramp counts samples.

    Parameters
    ----------
    cycles
        Revolutions at some sample numbers.
    """
    start, weights = gate_weights(gate.opening[0], gate.closing[0], samples.shape[1])
    numbers = np.arange(start, start + len(weights), dtype=np.float64)
    turned = cycles(numbers)
    if taper is not None:
        weights = weights * taper(turned)
    basis = harmonic_basis(turned, orders)
    weighted = basis * weights
    values = samples[:, start : start + len(weights)]
    return weighted @ basis.T, values @ weighted.T, weighted @ numbers
