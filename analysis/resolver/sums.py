"""Sums over whole periods: all that the resolver keeps of a recording.

For each period and with the weights of :mod:`analysis.resolver.weights`, over the basis
``b = [1, sin theta, cos theta, sin 2 theta, ...]``:

* ``gram``  the sum of ``w b b^T``, because samples do not fall evenly on a period;
* ``moment`` the sum of ``w b y`` for each channel;
* ``ramp``  the sum of ``w b t``, which a drift needs.

Everything else follows from these: a gate of m periods is the sum of its periods, the scatter
between them gives the uncertainty, and a drift shows in their means. Live and batch analysis call
the same functions on the same samples, so their final values are the same. Stretches of the record
are summed in threads, each by itself, so the sums do not depend on how many threads there are.
"""

from dataclasses import dataclass, replace

import numpy as np

from analysis.recording import Recording
from analysis.resolver.general_sums import GeneralSums, Taper
from analysis.resolver.reference import PhaseReference
from analysis.resolver.straight_sums import Gates, Sums, sum_straight
from analysis.resolver.weights import REACH
from analysis.threads import spread
from hardware.description.arrays import BoolArray, FloatArray
from hardware.description.errors import ConfigurationError, DataError

_STRETCH_SAMPLES = 300_000
"""Summed at a time by a thread, of each channel. Measured from 100,000 to 1,000,000: below, threads
wait for each other more often; above, little is won for the memory, 19 MB for eight channels."""


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
    uneven
        Whether the samples lie at stamps of their own, so that they may tell one period's
        harmonics badly.
    """

    channel_names: tuple[str, ...]
    orders: FloatArray
    opened_s: FloatArray
    closed_s: FloatArray
    opened_cycle: FloatArray
    gram: FloatArray
    moment: FloatArray
    ramp: FloatArray
    uneven: bool = False

    @property
    def period_count(self) -> int:
        """Number of periods."""
        return len(self.gram)

    @property
    def edges_cycles(self) -> FloatArray:
        """Where periods that follow each other meet, shape ``(periods + 1,)``."""
        return np.append(self.opened_cycle, self.opened_cycle[-1] + 1.0)

    def __getitem__(self, periods: slice | BoolArray) -> "PeriodSums":
        """Return the sums of some of the periods."""
        per_period = ("opened_s", "closed_s", "opened_cycle", "gram", "moment", "ramp")
        return replace(self, **{name: getattr(self, name)[periods] for name in per_period})


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
    slack = _slack(high)
    opening = reference.cycles[0] if first_cycle is None else first_cycle
    opening += np.ceil(low - opening - slack)
    count = int(np.floor(high - opening + slack))
    if count < 1:
        raise DataError(
            f"{recording.name}: the reference covers {max(high - low, 0.0):.2f} periods between "
            f"{start:.3f} s and {end:.3f} s; at least one whole period is needed"
        )
    if 2 * count > recording.sample_count:
        raise DataError(
            f"{recording.name}: {recording.sample_count / count:.1g} samples a period carry no "
            f"harmonic: {count:.6g} periods in {recording.sample_count} samples, by the "
            f"{reference.source}; a period needs at least 2: sample faster, or correct the "
            "reference"
        )
    return np.asarray(opening + np.arange(count + 1))


def _slack(cycles: float) -> float:
    """Rounding of a reference, in cycles: a record that ends on the very edge holds that period."""
    return 1e-9 * max(1.0, abs(cycles))


def period_sums(
    recording: Recording,
    reference: PhaseReference,
    orders: FloatArray | int = 3,
    *,
    edges_cycles: FloatArray | None = None,
    taper: Taper | None = None,
    threads: int | None = None,
) -> PeriodSums:
    """Sum a recording over its whole periods.

    Parameters
    ----------
    orders
        Number of harmonics, or the orders themselves (any, not only whole ones).
    edges_cycles
        Where the periods meet; by default all whole periods that the recording holds.
    threads
        How many share the work; by default as :func:`analysis.threads.thread_count` says. The sums
        are the same to the last bit.

    Raises
    ------
    DataError
        If a period has too few samples for any order, lies outside the record, or there is no whole
        period.
    ConfigurationError
        If a period has too few samples for the highest order.
    """
    cycles = whole_periods(recording, reference) if edges_cycles is None else edges_cycles
    edges_s = reference.times_at(cycles)
    numbers = _sample_numbers(recording, cycles, edges_s)
    gates = Gates(numbers[:-1], numbers[1:], cycles[:-1], cycles[1:])
    _check_sampling(recording, gates, float(np.max(orders)))  # before any array of their size
    orders = np.arange(1.0, orders + 1.0) if isinstance(orders, int) else orders
    general = GeneralSums(recording, reference, orders, taper)
    bent = general.needed(gates)

    def sum_stretch(stretch: slice) -> Sums:
        return _sum_stretch(general, gates[stretch], bent[stretch])

    parts = spread(sum_stretch, _stretches(gates), threads)
    gram, moment, ramp = (np.concatenate(part) for part in zip(*parts, strict=True))
    return PeriodSums(
        recording.channel_names,
        orders,
        edges_s[:-1],
        edges_s[1:],
        cycles[:-1],
        gram,
        moment,
        ramp / recording.sample_rate_hz,
        recording.stamps_s is not None,
    )


def _stretches(gates: Gates) -> list[slice]:
    """Return which periods to sum together: as many as fit, at least one."""
    stretches, start = [], 0
    while start < len(gates.opening):
        first = max(0.0, np.floor(gates.opening[start]) + 1 - REACH)
        stop = int(np.searchsorted(gates.closing, first + _STRETCH_SAMPLES, side="right"))
        stretches.append(slice(start, max(stop, start + 1)))
        start = stretches[-1].stop
    return stretches


def _sum_stretch(general: GeneralSums, gates: Gates, bent: BoolArray) -> Sums:
    """Read the samples of some periods that follow each other, and sum them."""
    first = max(0, int(gates.opening[0]) + 1 - REACH)
    block = general.recording.samples[:, first : int(gates.closing[-1]) + REACH + 1]
    block_gates = gates.counted_from(first)
    sums = general.empty_sums(len(bent))
    if not bent.all():
        _store(sums, ~bent, sum_straight(block, block_gates[~bent], len(general.orders)))
    for k in np.flatnonzero(bent):
        _store(sums, k, general.sum(block, first, block_gates[slice(k, k + 1)]))
    gram, moment, ramp = sums
    return gram, moment, ramp + gram[:, 0] * first


def _store(into: Sums, where: BoolArray | np.intp, sums: Sums) -> None:
    for target, part in zip(into, sums, strict=True):
        target[where] = part


def _sample_numbers(recording: Recording, cycles: FloatArray, edges_s: FloatArray) -> FloatArray:
    """Turn the edges' times into sample numbers.

    Raises
    ------
    DataError
        If an edge lies outside the record, or the record is shorter than an edge's weights reach.
    """
    if recording.sample_count < 2 * REACH:
        raise DataError(
            f"{recording.name}: {recording.sample_count} samples are too few; "
            f"at least {2 * REACH} are needed"
        )
    numbers, last = recording.sample_number(edges_s), recording.sample_count - 1.0
    slack = 2.0 * _slack(cycles[-1]) * np.diff(numbers).max() + 1e-6
    if numbers[0] < -slack or numbers[-1] > last + slack:
        raise DataError(
            f"{recording.name}: the gate from {edges_s[0]:.3f} s to {edges_s[-1]:.3f} s is not "
            f"within the record, {recording.start_s:.3f} s to {recording.end_s:.3f} s"
        )
    return np.asarray(np.clip(numbers, 0.0, last))


def _check_sampling(recording: Recording, gates: Gates, highest: float) -> None:
    samples = gates.closing - gates.opening
    # Of uneven stamps single periods may have too few: they are solved with those beside them.
    fewest = float(samples.min() if recording.stamps_s is None else np.median(samples))
    if fewest <= 2.0 * highest:
        # Where not even the fundamental is carried, fewer harmonics would not help.
        kind = DataError if fewest <= 2.0 else ConfigurationError
        raise kind(
            f"{recording.name}: {fewest:.1f} samples a period cannot carry harmonic "
            f"{highest:g}; take fewer harmonics or sample faster than "
            f"{2.0 * highest:g} times the frequency"
        )
