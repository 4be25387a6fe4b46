"""Sums over whole periods: all that the resolver keeps of a recording.

For each period and with the weights of :mod:`analysis.resolver.weights`, over the basis
``b = [1, sin theta, cos theta, sin 2 theta, ...]``:

* ``gram``  the sum of ``w b b^T``, because samples do not fall evenly on a period;
* ``moment`` the sum of ``w b y`` for each channel;
* ``ramp``  the sum of ``w b t``, which a drift needs.

Everything else follows from these: a gate of m periods is the sum of its periods, the scatter
between them gives the uncertainty, and a drift shows in their means. Live and batch analysis call
the same :func:`sum_period` on the same samples, so their final values are the same.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from analysis.recording import Recording, Samples
from analysis.resolver.gram import straight_gram
from analysis.resolver.reference import PhaseReference
from analysis.resolver.template import straight_template, template
from analysis.resolver.weights import REACH, gate_weights
from hardware.description.errors import DataError

FloatArray = NDArray[np.float64]

_READ_SAMPLES = 200_000  # read at a time from a file: large enough to be quick, small in memory


@dataclass(frozen=True)
class PeriodSums:
    """Sums of some whole periods.

    Attributes
    ----------
    channel_names
        The channels, in the order of ``moment``.
    orders
        Orders of the basis, shape ``(orders,)``: 1, 2, 3 for the first three harmonics. The basis
        has ``K = 2 * orders + 1`` functions.
    opened_s, closed_s, opened_cycle
        Where each period lies, shape ``(periods,)``.
    gram, moment, ramp
        Shapes ``(periods, K, K)``, ``(periods, channels, K)``, ``(periods, K)``; the sum of the
        weights of a period is its length in samples. The ramp's time runs from the record's first
        sample. A period with a missing sample has NaN in ``moment``.
    """

    channel_names: tuple[str, ...]
    orders: FloatArray
    opened_s: FloatArray
    closed_s: FloatArray
    opened_cycle: FloatArray
    gram: FloatArray
    moment: FloatArray
    ramp: FloatArray

    @property
    def period_count(self) -> int:
        """Number of periods."""
        return len(self.gram)

    def __getitem__(self, periods: slice | NDArray[np.bool_]) -> "PeriodSums":
        """Return the sums of some of the periods."""
        per_period = ("opened_s", "closed_s", "opened_cycle", "gram", "moment", "ramp")
        return replace(self, **{name: getattr(self, name)[periods] for name in per_period})


@dataclass(frozen=True)
class Gate:
    """One period to sum: from where to where, and the phase in between.

    Attributes
    ----------
    opening, closing
        Fractional sample numbers.
    opening_cycle, closing_cycle
        Revolutions there.
    phase
        Revolutions at some sample numbers; ``None`` where they run straight from edge to edge.
    """

    opening: float
    closing: float
    opening_cycle: float
    closing_cycle: float
    phase: Callable[[FloatArray], FloatArray] | None = None

    @property
    def step(self) -> float:
        """Revolutions from one sample to the next where they run straight."""
        return (self.closing_cycle - self.opening_cycle) / (self.closing - self.opening)

    def cycles(self, numbers: FloatArray) -> FloatArray:
        """Return the revolutions at some sample numbers."""
        if self.phase is not None:
            return self.phase(numbers)
        return self.opening_cycle + (numbers - self.opening) * self.step


Taper = Callable[[FloatArray], FloatArray]
"""Extra weight of samples as a function of their number."""

Sums = tuple[FloatArray, FloatArray, FloatArray]


def sum_period(
    samples: Samples,
    gate: Gate,
    orders: FloatArray,
    sample_rate_hz: float,
    taper: Taper | None = None,
) -> Sums:
    """Return ``gram``, ``moment`` and ``ramp`` of one period; see :class:`PeriodSums`."""
    first, weights = gate_weights(gate.opening, gate.closing, samples.shape[1])
    values = samples[:, first : first + len(weights)]
    if gate.phase is None and taper is None and _follow_each_other(orders):
        gram, moment, ramp = _sum_straight(values, gate, first, weights, len(orders))
    else:
        numbers = np.arange(first, first + len(weights), dtype=np.float64)
        basis = template(gate.cycles(numbers), orders)
        weighted = basis * (weights if taper is None else weights * taper(numbers))
        gram, moment, ramp = weighted @ basis.T, values @ weighted.T, weighted @ numbers
    return gram, moment, ramp / sample_rate_hz


def _follow_each_other(orders: FloatArray) -> bool:
    return bool(np.array_equal(orders, np.arange(1.0, len(orders) + 1.0)))


def _sum_straight(
    values: FloatArray, gate: Gate, first: int, weights: FloatArray, harmonics: int
) -> Sums:
    """Sum a period of even phase, the usual case, without a sine for each sample."""
    numbers = np.arange(first, first + len(weights), dtype=np.float64)
    first_cycle = float(gate.cycles(numbers[:1])[0])
    weighted = straight_template(first_cycle, gate.step, len(weights), harmonics)
    for end in (slice(0, 2 * REACH), slice(max(2 * REACH, len(weights) - 2 * REACH), None)):
        weighted[:, end] *= weights[end]
    gram = straight_gram(first_cycle, gate.step, weights, harmonics)
    return gram, values @ weighted.T, weighted @ numbers


def whole_periods(
    recording: Recording, reference: PhaseReference, first_cycle: float | None = None
) -> FloatArray:
    """Return the cycles at which a recording's whole periods meet, shape ``(periods + 1,)``.

    Parameters
    ----------
    first_cycle
        Where the first period opens; by default at the reference's first knot (the first photocell
        pulse), and so in step with the pulses.

    Raises
    ------
    DataError
        If not one whole period lies within the recording and the reference.
    """
    start, end = recording.start_s, recording.end_s
    low, high = reference.cycles_at(np.array([start, end]))
    low, high = max(low, reference.cycles[0]), min(high, reference.cycles[-1])
    slack = 1e-9 * max(1.0, abs(high))  # a record that ends on the very edge holds that period
    opening = reference.cycles[0] if first_cycle is None else first_cycle
    opening += np.ceil(low - opening - slack)
    count = int(np.floor(high - opening + slack))
    if count < 1:
        raise DataError(
            f"{recording.name}: the reference covers {max(high - low, 0.0):.2f} periods between "
            f"{start:.3f} s and {end:.3f} s; at least one whole period is needed"
        )
    return np.asarray(opening + np.arange(count + 1))


def period_sums(
    recording: Recording,
    reference: PhaseReference,
    orders: FloatArray | int = 3,
    *,
    edges_cycles: FloatArray | None = None,
    taper: Taper | None = None,
) -> PeriodSums:
    """Sum a recording over its whole periods.

    Parameters
    ----------
    orders
        Number of harmonics, or the orders themselves (any, not only whole ones).
    edges_cycles
        Where the periods meet; by default all whole periods that the recording holds.

    Raises
    ------
    DataError
        If a period has too few samples for the highest order, or there is no whole period.
    """
    orders = np.arange(1.0, orders + 1.0) if isinstance(orders, int) else orders
    cycles = whole_periods(recording, reference) if edges_cycles is None else edges_cycles
    edges_s = reference.times_at(cycles)
    gates = _gates(recording, reference, cycles, edges_s)
    _check_sampling(recording, gates, orders)
    samples = _ReadAhead(recording.samples)
    parts = [sum_period(samples, gate, orders, recording.sample_rate_hz, taper) for gate in gates]
    gram, moment, ramp = (np.array(part) for part in zip(*parts, strict=True))
    return PeriodSums(
        recording.channel_names, orders, edges_s[:-1], edges_s[1:], cycles[:-1], gram, moment, ramp
    )


def _gates(
    recording: Recording, reference: PhaseReference, cycles: FloatArray, edges_s: FloatArray
) -> list[Gate]:
    numbers = np.clip(recording.sample_number(edges_s), 0.0, recording.sample_count - 1.0)
    # A period is straight where no knot of the reference lies strictly inside it.
    inside = 1e-9 * np.diff(cycles)
    first = np.searchsorted(reference.cycles, cycles[:-1] + inside, side="right")
    bent = np.searchsorted(reference.cycles, cycles[1:] - inside, side="left") > first

    def phase(numbers: FloatArray) -> FloatArray:
        return reference.cycles_at(recording.start_s + numbers / recording.sample_rate_hz)

    return [
        Gate(numbers[k], numbers[k + 1], cycles[k], cycles[k + 1], phase if bent[k] else None)
        for k in range(len(cycles) - 1)
    ]


def _check_sampling(recording: Recording, gates: list[Gate], orders: FloatArray) -> None:
    fewest = min(gate.closing - gate.opening for gate in gates)
    if fewest <= 2.0 * orders.max():
        raise DataError(
            f"{recording.name}: {fewest:.1f} samples a period cannot carry harmonic "
            f"{orders.max():g}; take fewer harmonics or sample faster than "
            f"{2.0 * orders.max():g} times the frequency"
        )


class _ReadAhead:
    """Samples of a file, read in large stretches; an array in memory is handed through."""

    def __init__(self, source: Samples) -> None:
        self._source = source
        self._start = 0
        self._held: FloatArray = np.empty((source.shape[0], 0))

    @property
    def shape(self) -> tuple[int, ...]:
        return self._source.shape

    def __getitem__(self, key: tuple[slice | Sequence[int], slice], /) -> FloatArray:
        rows, when = key
        if isinstance(self._source, np.ndarray):
            return np.asarray(self._source[key])
        start, stop, _ = when.indices(self.shape[1])
        if start < self._start or stop > self._start + self._held.shape[1]:
            end = min(self.shape[1], max(stop, start + _READ_SAMPLES))
            self._start, self._held = start, self._source[:, start:end]
        return self._held[rows, start - self._start : stop - self._start]
