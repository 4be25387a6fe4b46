"""The resolver at the carriage: blocks of samples and photocell pulses in, readings out.

Between pulses a reading is provisional, from the phase that the last period predicts. When the
pulse has come, and with it the few samples that the gate's edge and the search for spikes need, the
period is summed as a batch would sum it, by the same function from the same samples; only such
readings are final. Spikes are taken out as a recording's reader does, judged by the run so far.
"""

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from analysis.recording import Recording
from analysis.resolver.basis import harmonic_basis
from analysis.resolver.estimate import resolve
from analysis.resolver.general_sums import sum_any
from analysis.resolver.harmonics import Harmonics
from analysis.resolver.photocell import EARLY, LATE
from analysis.resolver.spike_watch import LiveSpike, SpikeWatch
from analysis.resolver.straight_sums import Gates, Sums, sum_straight
from analysis.resolver.sums import PeriodSums
from analysis.resolver.weights import REACH
from analysis.spikes import AROUND
from hardware.description.arrays import FloatArray
from hardware.description.channels import Channel
from hardware.description.errors import DataError

_NEIGHBOURS = 7  # periods whose median is the present one
_AHEAD = REACH + AROUND  # samples after a period's edge that show whether one of its is a spike
_SLACK = 1e-6  # samples: a pulse on the very first or last one is stamped so near it


@dataclass(frozen=True)
class Provisional:
    """Needles between pulses: ``[A0, S1, C1, ...]`` of each channel, shape ``(channels, K)``."""

    coefficients: FloatArray


@dataclass(frozen=True)
class _Period:
    """A finished period: where it lies, and its sums."""

    opened_s: float
    closed_s: float
    opened_cycle: float
    sums: Sums


class LiveResolver:
    """Resolve a run while it is recorded.

    Parameters
    ----------
    channels
        The sampled channels, in the order of the blocks' rows.
    harmonics
        Harmonics 1 to N.
    periods
        Periods of the gate; readings are final after each period, over the last so many.
    start_s
        Time of the first sample.
    latency_s, angle_offset_rad
        Calibration of the photocell, as in :func:`analysis.resolver.photocell.from_photocell`.
    """

    def __init__(
        self,
        channels: Sequence[Channel],
        sample_rate_hz: float,
        *,
        harmonics: int = 3,
        periods: int = 1,
        start_s: float = 0.0,
        latency_s: float = 0.0,
        angle_offset_rad: float = 0.0,
    ) -> None:
        self._run = Recording("live", tuple(channels), np.empty((len(channels), 0)), sample_rate_hz)
        self._orders = np.arange(1.0, harmonics + 1.0)
        self._periods = periods
        self._start_s = start_s
        self._latency_s = latency_s
        self._cycle = angle_offset_rad / (2.0 * np.pi)
        self._buffer = np.empty((len(channels), 1024))
        self._first = 0  # number of the buffer's first sample
        self._count = 0  # samples received
        self._pulses: deque[float] = deque()  # not yet closed: the opening, then those to come
        self._last_pulse_s = -np.inf
        self._intervals: deque[float] = deque(maxlen=_NEIGHBOURS)  # between any two pulses
        self._done: deque[_Period] = deque(maxlen=periods)
        self._partial: Sums | None = None
        self._partial_to = 0
        self._watch = SpikeWatch(len(channels))
        self._spikes: list[LiveSpike] = []

    def push(self, samples: FloatArray) -> list[Harmonics]:
        """Take a block, shape ``(channels, samples)``; return the readings it made final.

        Pulses may come late, but the first one no later than samples of one second after it and the
        block in which these lie. A gate in which every period has missing samples gives no reading.

        Raises
        ------
        DataError
            If the block has another number of channels.
        """
        if samples.ndim != 2 or samples.shape[0] != len(self._run.channels):
            raise DataError(
                f"a block of shape {samples.shape} does not fit {len(self._run.channels)} channels"
            )
        if not self._pulses and self._count - self._first > 2.0 * self._run.sample_rate_hz:
            self._keep_from(self._count - int(self._run.sample_rate_hz))
        self._append(samples)
        return self._close_periods()

    def pulse(self, time_s: float) -> list[Harmonics]:
        """Take a photocell pulse; return the readings it made final.

        A pulse too soon after the last is dropped, among them any that leaves too few samples for
        the highest harmonic; one so late that pulses were missed closes as many periods as have
        passed. Whether a pulse is stray shows only by those after it: what the batch drops later
        may have closed a period here, and the first periods of a run that speeds up may be counted
        wrongly until seven pulses have come.

        Raises
        ------
        DataError
            If it does not come after the last pulse.
        """
        time_s -= self._latency_s
        since_last = time_s - self._last_pulse_s
        if not since_last > 0.0:
            raise DataError(
                f"pulse at {time_s:.6f} s does not come after the last at {self._last_pulse_s:.6f} "
                "s; pulses must be given in order of time, each once"
            )
        self._last_pulse_s = time_s
        if not self._pulses:
            self._pulses.append(time_s)
        elif since_last * self._run.sample_rate_hz > 2.0 * self._orders[-1]:
            self._pulses.extend(self._split(time_s - self._pulses[-1]))
            self._intervals.append(since_last)
        return self._close_periods()

    def finish(self) -> list[Harmonics]:
        """Return the readings that still waited for samples beyond their edge, at a run's end."""
        return self._close_periods(reach=0)

    @property
    def finished_periods(self) -> int:
        """How many periods of the gate are final."""
        return len(self._done)

    def so_far(self) -> Harmonics | None:
        """Return the reading over the finished periods of a gate that may not be full yet.

        For a gate that ends when its uncertainty is small enough; ``None`` before the first whole
        period and while every one has missing samples.
        """
        return self._read() if self._any_sound() else None

    def provisional(self) -> Provisional | None:
        """Return the needles as they stand: the last gate and what has come of the next period.

        ``None`` before the first whole period.
        """
        if not self._done:
            return None
        self._sum_partial()
        parts = [period.sums for period in self._done]
        if self._partial is not None:
            parts.append(self._partial)
        gram = sum(part[0] for part in parts)
        moment = sum(part[1] for part in parts)
        return Provisional(np.linalg.solve(gram, np.asarray(moment).T).T)

    def _append(self, samples: FloatArray) -> None:
        held = self._count - self._first
        needed = held + samples.shape[1]
        if needed > self._buffer.shape[1]:
            grown = np.empty((self._buffer.shape[0], 2 * needed))
            grown[:, :held] = self._buffer[:, :held]
            self._buffer = grown
        self._buffer[:, held:needed] = samples
        self._count += samples.shape[1]

    def _split(self, interval: float) -> list[float]:
        """Pulses that an interval stands for: none, one, or as many as were missed and this one."""
        last = self._pulses[-1]
        usual = float(np.median(self._intervals)) if self._intervals else interval
        if interval < EARLY * usual:
            return []
        turns = 1 if interval < LATE * usual else round(interval / usual)
        return [last + interval * k / turns for k in range(1, turns + 1)]

    def spikes(self) -> list[LiveSpike]:
        """Return the spikes that were taken out since this was last asked, in their order."""
        taken, self._spikes = self._spikes, []
        return taken

    def _close_periods(self, reach: int = _AHEAD) -> list[Harmonics]:
        readings = []
        while (
            len(self._pulses) > 1
            and self._number(self._pulses[1]) + reach <= self._count - 1 + _SLACK
        ):
            opened_s = self._pulses.popleft()
            if self._number(opened_s) > self._first - _SLACK:
                self._done.append(self._sum(opened_s, self._pulses[0]))
                if len(self._done) == self._periods and self._any_sound():
                    readings.append(self._read())
            self._cycle += 1.0
            self._forget()
        return readings

    def _any_sound(self) -> bool:
        """Tell whether a period of the gate has all its samples."""
        return any(np.isfinite(period.sums[1]).all() for period in self._done)

    def _number(self, time_s: float) -> float:
        """Fractional sample number of a time, from the run's first sample."""
        return (time_s - self._start_s) * self._run.sample_rate_hz

    def _sum(self, opened_s: float, closed_s: float) -> _Period:
        rate = self._run.sample_rate_hz
        held = self._buffer[:, : self._count - self._first]
        edges = np.array([self._number(time) - self._first for time in (opened_s, closed_s)])
        last = int(edges[1])
        held = held[:, : last + _AHEAD + 1]
        until = min(last + REACH + 1, held.shape[1])
        self._spikes += self._watch.take_out(held, self._first, until)
        edges = np.clip(edges, 0.0, held.shape[1] - 1.0)
        gate = Gates(*np.array([*edges, self._cycle, self._cycle + 1.0])[:, None])
        if edges[0] < REACH - 1 or edges[1] >= held.shape[1] - REACH:  # a run's very ends
            gram, moment, ramp = sum_any(held, gate, gate.cycles_of_first, self._orders)
        else:
            sums = sum_straight(held, gate, len(self._orders))
            gram, moment, ramp = (part[0] for part in sums)
        ramp = (ramp + gram[0] * self._first) / rate
        return _Period(opened_s, closed_s, self._cycle, (gram, moment, ramp))

    def _read(self) -> Harmonics:
        gram, moment, ramp = (
            np.array(part) for part in zip(*(p.sums for p in self._done), strict=True)
        )
        sums = PeriodSums(
            self._run.channel_names,
            self._orders,
            np.array([period.opened_s for period in self._done]),
            np.array([period.closed_s for period in self._done]),
            np.array([period.opened_cycle for period in self._done]),
            gram,
            moment,
            ramp,
        )
        return resolve(self._run, sums)

    def _forget(self) -> None:
        """Drop the samples that no later period needs, and the provisional sums."""
        self._partial, self._partial_to = None, 0
        self._keep_from(max(self._first, int(self._number(self._pulses[0])) - 2 * REACH))

    def _keep_from(self, number: int) -> None:
        held = self._buffer[:, number - self._first : self._count - self._first]
        self._buffer[:, : held.shape[1]] = held.copy()
        self._first = number

    def _sum_partial(self) -> None:
        """Add what has come of the present period, its phase going on as in the last."""
        last = self._done[-1]
        opening = self._number(self._pulses[0])
        start = max(self._partial_to, int(np.ceil(opening)))
        if start >= self._count:
            return
        step = 1.0 / (self._run.sample_rate_hz * (last.closed_s - last.opened_s))
        cycles = self._cycle + step * (np.arange(start, self._count, dtype=np.float64) - opening)
        basis = harmonic_basis(cycles, self._orders)
        values = self._buffer[:, start - self._first : self._count - self._first]
        gram, moment = basis @ basis.T, values @ basis.T
        if self._partial is not None:
            gram, moment = gram + self._partial[0], moment + self._partial[1]
        self._partial, self._partial_to = (gram, moment, gram[0]), self._count
