"""Readings of the live resolver, for people and for the recorder."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from analysis.resolver.harmonics import Harmonics
from analysis.resolver.live_resolver import Provisional
from analysis.uncertainty.freedom import student_factor
from hardware.description.arrays import FloatArray
from hardware.description.channels import Channel
from pmm.plan.force_estimate import ExpectedAmplitude
from pmm.run.status import ChannelReading


def rows_of(reading: Harmonics) -> tuple[ChannelReading, ...]:
    """Return mean and first harmonic of each channel with the larger 95 % half-width."""
    widths = half_widths(reading)
    return tuple(
        ChannelReading(
            name,
            unit,
            float(row[0]),
            float(row[1]),
            float(row[2]),
            float(width),
            final=True,
        )
        for name, unit, row, width in zip(
            reading.channel_names, reading.units, reading.coefficients, widths, strict=True
        )
    )


def needles(
    channels: Sequence[Channel], now: Provisional | None, last: Harmonics | None
) -> tuple[ChannelReading, ...]:
    """Return the provisional readings, with the interval of the last final one."""
    if now is None:
        return ()
    widths = half_widths(last) if last is not None else np.full(len(channels), math.nan)
    return tuple(
        ChannelReading(
            channel.name, channel.unit, float(row[0]), float(row[1]), float(row[2]), float(width)
        )
        for channel, row, width in zip(channels, now.coefficients, widths, strict=True)
    )


class Means:
    """Means of a record at rest."""

    def __init__(self, channels: Sequence[Channel]) -> None:
        self._channels = tuple(channels)
        self._sum, self._square = np.zeros((2, len(channels)))
        self._count = 0

    def take(self, values: FloatArray) -> None:
        """Take samples, shape ``(channels, n)``; those that any channel lacks do not count."""
        good = values[:, np.isfinite(values).all(axis=0)]
        self._sum += good.sum(axis=1)
        self._square += (good**2).sum(axis=1)
        self._count += good.shape[1]

    def rows(self) -> tuple[ChannelReading, ...]:
        """Return the means; the half-width is that of white noise, NaN of a single sample."""
        if not self._count:
            return ()
        means = self._sum / self._count
        freedom = self._count - 1
        squares = np.maximum(self._square - self._count * means**2, 0.0)
        spread = np.sqrt(squares / max(freedom, 1) / self._count)
        widths = student_factor(freedom) * spread
        return tuple(
            ChannelReading(
                channel.name, channel.unit, float(mean), 0.0, 0.0, float(width), final=True
            )
            for channel, mean, width in zip(self._channels, means, widths, strict=True)
        )


def with_expected(
    rows: Sequence[ChannelReading], expected: Mapping[str, ExpectedAmplitude]
) -> tuple[ChannelReading, ...]:
    """Return the rows with what the plan estimates; without an interval yet none is far."""
    compared_rows = []
    for row in rows:
        estimate = expected.get(row.channel)
        if estimate is not None:
            far = math.isfinite(row.half_width) and estimate.is_far(row.amplitude)
            row = replace(row, expected=estimate.amplitude_n, far=far)
        compared_rows.append(row)
    return tuple(compared_rows)


def far_text(row: ChannelReading) -> str:
    """Return in words that a force is far from its estimate, and what to look at."""
    return (
        f"{row.channel}: first harmonic {row.amplitude:.4g} N, the plan estimates "
        f"{row.expected:.4g} N; look whether [model] and [hull] of rig.toml are those of the rig, "
        "then at scale and sign of the gauge and at the amplitude of its strut"
    )


def half_widths(reading: Harmonics) -> FloatArray:
    """Return the larger 95 % half-width of the first harmonic's parts, shape ``(channels,)``."""
    if not np.isfinite(reading.covariance).any():
        return np.full(len(reading.channel_names), math.nan)
    return np.asarray(reading.half_width()[:, 1:3].max(axis=1))


def worst_relative(reading: Harmonics, rows: Sequence[int]) -> float:
    """Return the largest half-width of the first harmonic over its size, of some channels.

    Infinite where there is no interval yet, or no such channel.
    """
    if not rows:
        return math.inf
    with np.errstate(divide="ignore", invalid="ignore"):
        shares = half_widths(reading)[list(rows)] / reading.amplitude[list(rows), 0]
    return float(shares.max()) if np.isfinite(shares).all() else math.inf
