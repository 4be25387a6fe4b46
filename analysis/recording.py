"""One type for a run: channels, sampling, photocell edges, set-points, and where it came from."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from difflib import get_close_matches
from typing import Protocol

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.channels import Channel
from hardware.description.errors import DataError
from hardware.description.flags import Flag
from hardware.description.setpoint import SetPoint


def sample_numbers(
    time_s: FloatArray, start_s: float, sample_rate_hz: float, stamps_s: FloatArray | None
) -> FloatArray:
    """Turn times into fractional sample numbers; the first sample is number 0.

    Parameters
    ----------
    stamps_s
        Times of samples that are not evenly spaced; between two the numbers run straight, and
        beyond the ends on at the mean rate.
    """
    times = np.asarray(time_s, dtype=np.float64)
    if stamps_s is None:
        return np.asarray((times - start_s) * sample_rate_hz)
    beyond = np.minimum(times - stamps_s[0], 0.0) + np.maximum(times - stamps_s[-1], 0.0)
    numbers = np.interp(times, stamps_s, np.arange(float(stamps_s.size)))
    return np.asarray(numbers + beyond * sample_rate_hz)


class Samples(Protocol):
    """A run's values, shape ``(channels, samples)``: an array, or a file read lazily.

    Several threads may ask at once.
    """

    @property
    def shape(self) -> tuple[int, ...]:
        """``(channels, samples)``."""
        ...

    def __getitem__(self, key: tuple[slice | Sequence[int], slice], /) -> FloatArray:
        """Return the values of some channels between two sample numbers."""
        ...


@dataclass(frozen=True)
class Recording:
    """A run as it was recorded.

    Attributes
    ----------
    samples
        Values in SI units, shape ``(channels, samples)``; NaN where a sample is missing.
    sample_rate_hz
        Samples are evenly spaced; the mean rate where ``stamps_s`` says otherwise.
    start_s
        Time of the first sample.
    photocell_edges_s
        Times of the photocell's pulses on the same clock, increasing; ``None`` without one.
    flags
        What the reader noticed or repaired.
    stamps_s
        Times of samples that are not evenly spaced, increasing, shape ``(samples,)``; ``None``
        where they are.
    """

    name: str
    channels: tuple[Channel, ...]
    samples: Samples
    sample_rate_hz: float
    start_s: float = 0.0
    photocell_edges_s: FloatArray | None = None
    set_point: SetPoint | None = None
    provenance: Mapping[str, str] = field(default_factory=dict)
    flags: tuple[Flag, ...] = ()
    stamps_s: FloatArray | None = None

    @property
    def sample_count(self) -> int:
        """Number of samples of each channel."""
        return self.samples.shape[1]

    @property
    def end_s(self) -> float:
        """Time of the last sample."""
        last = self.sample_count - 1
        if self.stamps_s is not None:
            return float(self.stamps_s[last])
        return self.start_s + last / self.sample_rate_hz

    @property
    def channel_names(self) -> tuple[str, ...]:
        """The channels' names, in the order of ``samples``."""
        return tuple(channel.name for channel in self.channels)

    def time_s(self, start: int = 0, stop: int | None = None) -> FloatArray:
        """Return the times of samples ``start`` to ``stop`` (exclusive)."""
        stop = self.sample_count if stop is None else stop
        if self.stamps_s is not None:
            return self.stamps_s[start:stop]
        times: FloatArray = self.start_s + np.arange(start, stop) / self.sample_rate_hz
        return times

    def sample_number(self, time_s: FloatArray) -> FloatArray:
        """Turn times into fractional sample numbers; the first sample is number 0."""
        return sample_numbers(time_s, self.start_s, self.sample_rate_hz, self.stamps_s)

    def index(self, name: str) -> int:
        """Return the row of a channel.

        Raises
        ------
        DataError
            If there is no such channel; the message names the nearest ones.
        """
        if name in self.channel_names:
            return self.channel_names.index(name)
        matches = get_close_matches(name, self.channel_names, n=3, cutoff=0.4)
        hint = f"; did you mean {', '.join(matches)}?" if matches else ""
        raise DataError(
            f"{self.name}: no channel {name!r}{hint} (channels: {', '.join(self.channel_names)})"
        )

    def values(self, name: str) -> FloatArray:
        """Return all samples of one channel, shape ``(samples,)``."""
        row = self.index(name)
        values: FloatArray = self.samples[row : row + 1, 0 : self.sample_count][0]
        return values

    def select(self, names: Sequence[str]) -> "Recording":
        """Return the recording with these channels only, in this order."""
        rows = [self.index(name) for name in names]
        if rows == list(range(len(self.channels))):
            return self
        return replace(
            self,
            channels=tuple(self.channels[row] for row in rows),
            samples=_Part(self.samples, tuple(rows), 0, self.sample_count),
        )

    def between(self, start_s: float, end_s: float) -> "Recording":
        """Return the samples between two times; the photocell's edges stay as they are.

        Raises
        ------
        DataError
            If no sample lies there.
        """
        numbers = self.sample_number(np.array([start_s, end_s]))
        first = max(0, int(np.ceil(numbers[0])))
        stop = min(self.sample_count, int(np.floor(numbers[1])) + 1)
        if first >= stop:
            raise DataError(
                f"{self.name}: no samples from {start_s:g} s to {end_s:g} s; the record runs from "
                f"{self.start_s:g} s to {self.end_s:g} s"
            )
        return self.part(first, stop)

    def part(self, first: int, stop: int) -> "Recording":
        """Return samples ``first`` to ``stop`` (exclusive); the photocell's edges stay."""
        rows = tuple(range(len(self.channels)))
        stamps_s = None if self.stamps_s is None else self.stamps_s[first:stop]
        return replace(
            self,
            samples=_Part(self.samples, rows, first, stop),
            start_s=float(self.time_s(first, first + 1)[0]),
            stamps_s=stamps_s,
        )

    def complete(self) -> "Recording":
        """Return unevenly spaced samples without those at which any channel is missing.

        On an even grid a missing sample keeps its place, and the recording is returned as it is.

        Raises
        ------
        DataError
            If no sample is left.
        """
        if self.stamps_s is None:
            return self
        values = self.samples[:, 0 : self.sample_count]
        complete = np.isfinite(values).all(axis=0)
        if complete.all():
            return self
        if not complete.any():
            raise DataError(
                f"{self.name}: at no time stamp have all of {', '.join(self.channel_names)} a "
                "value; take fewer channels"
            )
        stamps_s = self.stamps_s[complete]
        return replace(
            self, samples=values[:, complete], start_s=float(stamps_s[0]), stamps_s=stamps_s
        )

    def check_even(self, procedure: str) -> None:
        """Refuse samples that are not evenly spaced, for what cannot do without.

        Raises
        ------
        DataError
            If they are not; the message says that ``procedure`` needs it.
        """
        if self.stamps_s is not None:
            raise DataError(
                f"{self.name}: {procedure} needs evenly spaced samples, and the time stamps are "
                "not; resample the record, or, if only the stamps are wrong, give the sample rate"
            )


@dataclass(frozen=True)
class _Part:
    """Some rows and a stretch of other samples, read only when asked for."""

    source: Samples
    rows: tuple[int, ...]
    first: int
    stop: int

    @property
    def shape(self) -> tuple[int, ...]:
        return (len(self.rows), self.stop - self.first)

    def __getitem__(self, key: tuple[slice | Sequence[int], slice], /) -> FloatArray:
        chosen, span = key
        rows = self.rows[chosen] if isinstance(chosen, slice) else [self.rows[i] for i in chosen]
        start, stop, _ = span.indices(self.shape[1])
        within = slice(self.first + start, self.first + stop)
        return np.ascontiguousarray(self.source[list(rows), within])
