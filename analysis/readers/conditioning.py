"""Missing values, spikes and saturation: what is repaired, what is only said."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from analysis.readers.missing_values import empty_flag
from analysis.recording import Recording, Samples
from analysis.spikes import FEWEST_LEVELS, Spike, cubic, find_spikes
from hardware.description.arrays import BoolArray, FloatArray
from hardware.description.channels import Channel
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity

LONGEST_REPAIR = 3
# A flat top: at least two stretches of this many samples within a step of the extreme, and within
# so many steps, or this share of all that the signal covers, less than so many times as many
# (twice as many at a sine's crest, 1.4 times at the flattest that a third order makes).
FLAT_RUN = 3
FLAT_STEPS = 6.0
FLAT_SHARE = 0.005
FLAT_EXCESS = 1.25
_SOME = 4096  # values
_ROUNDING = 1e-9  # of what the signal covers: values nearer to each other are the same

_NAMED_SPIKES = 5  # of a channel, the largest; the others are counted


@dataclass(frozen=True)
class WithoutSpikes:
    """Samples in whose spikes' place stands what the cubic puts there; their source is unaltered.

    ``spikes`` has the spikes of each of the source's rows.
    """

    source: Samples
    spikes: tuple[tuple[Spike, ...], ...]

    @property
    def shape(self) -> tuple[int, ...]:
        """``(channels, samples)``."""
        return self.source.shape

    def __getitem__(self, key: tuple[slice | Sequence[int], slice], /) -> FloatArray:
        """Return the values of some channels between two sample numbers."""
        rows, span = key
        values = np.array(self.source[rows, span])
        numbers = np.arange(*span.indices(self.shape[1]))
        spikes = self.spikes[rows] if isinstance(rows, slice) else [self.spikes[k] for k in rows]
        for row, in_row in zip(values, spikes, strict=True):
            for spike in in_row:
                inside = (numbers >= spike.start) & (numbers < spike.stop)
                row[inside] = spike.replacement[numbers[inside] - spike.start]
        return values


def without_spikes(recording: Recording) -> Recording:
    """Take the spikes out of a recording, and say of each channel when they were and how large.

    What stands in their place is the cubic through the two samples on either side, or NaN where one
    of these is missing. A recording without spikes is returned as it is.
    """
    spikes_by_row = find_spikes(recording.samples)
    if not any(spikes_by_row):
        return recording
    flags = tuple(
        spike_flag(channel, spikes, recording.time_s())
        for channel, spikes in zip(recording.channels, spikes_by_row, strict=True)
        if spikes
    )
    samples = WithoutSpikes(recording.samples, spikes_by_row)
    return replace(recording, samples=samples, flags=recording.flags + flags)


def spike_flag(channel: Channel, spikes: Sequence[Spike], time_s: FloatArray) -> Flag:
    """Return the flag of a channel's spikes.

    Parameters
    ----------
    time_s
        Times of all samples that the spikes' numbers count, shape ``(samples,)``.
    """
    unit = f" {channel.unit}" if channel.unit else ""
    largest = sorted(spikes, key=lambda spike: -abs(spike.size))[:_NAMED_SPIKES]
    named = ", ".join(
        f"{spike.size:+.4g}{unit} at {time_s[spike.start]:.6g} s"
        + (f" ({spike.stop - spike.start} samples)" if spike.stop - spike.start > 1 else "")
        for spike in sorted(largest, key=lambda spike: spike.start)
    )
    remainder = f" and {len(spikes) - len(largest)} smaller" if len(spikes) > len(largest) else ""
    message = (
        f"{channel.name}: {len(spikes)} spike(s) were taken out and filled by a cubic through two "
        f"samples on either side: {named}{remainder} off it; look for a loose connector or a "
        "disturbance"
    )
    return Flag("spike", Severity.WARNING, message, channel.name)


def repair_missing(
    samples: FloatArray, channels: tuple[Channel, ...], where: str
) -> tuple[Flag, ...]:
    """Fill short runs of missing values in place, and say what was and what was not.

    Runs of up to 3 samples with two good samples on either side are filled by the cubic through
    those four. Longer runs stay NaN.

    Parameters
    ----------
    samples
        Shape ``(channels, samples)``; changed in place.

    Raises
    ------
    DataError
        If no channel has any value.
    """
    if not np.isfinite(samples).any():
        names = ", ".join(channel.name for channel in channels)
        raise DataError(f"{where}: no channel has any value, all are missing ({names})")
    flags: list[Flag] = []
    for row, channel in zip(samples, channels, strict=True):
        flags += _repair(row, channel.name)
    return tuple(flags)


def _repair(row: FloatArray, name: str) -> list[Flag]:
    missing = np.isnan(row)
    if not missing.any():
        return []
    if missing.all():
        return [empty_flag(name)]
    repaired = unrepaired = longest = 0
    for start, stop in runs(missing):
        length = stop - start
        neighbours = np.array([start - 2, start - 1, stop, stop + 1])
        good = neighbours[0] >= 0 and neighbours[-1] < row.size and not missing[neighbours].any()
        if good and length <= LONGEST_REPAIR:
            row[start:stop] = cubic(length) @ row[neighbours]
            repaired += length
        else:
            unrepaired, longest = unrepaired + length, max(longest, length)
    return _missing_flags(name, repaired, unrepaired, longest)


def _missing_flags(name: str, repaired: int, unrepaired: int, longest: int) -> list[Flag]:
    flags = []
    if repaired:
        message = (
            f"{name}: {repaired} missing sample(s) in runs of up to {LONGEST_REPAIR} were filled "
            "by a cubic through two samples on either side"
        )
        flags.append(Flag("repaired", Severity.WARNING, message, name))
    if unrepaired:
        message = (
            f"{name}: {unrepaired} sample(s) are missing and left so (longest run {longest}; only "
            f"runs of up to {LONGEST_REPAIR} within good samples are filled)"
        )
        flags.append(Flag("missing", Severity.VOID, message, name))
    return flags


def runs(condition: BoolArray) -> list[tuple[int, int]]:
    """Return the stretches ``[start, stop)`` over which a condition holds."""
    padded = np.concatenate(([False], condition, [False]))
    edges = np.flatnonzero(padded[1:] != padded[:-1])
    return [(int(start), int(stop)) for start, stop in edges.reshape(-1, 2)]


def saturation_flags(samples: FloatArray, channels: tuple[Channel, ...]) -> tuple[Flag, ...]:
    """Flag samples at the full scale, or, where that is unknown, tops cut off flat."""
    saturated = (
        _flat_tops(row, channel)
        if channel.full_scale is None
        else _at_full_scale(row, channel, channel.full_scale)
        for row, channel in zip(samples, channels, strict=True)
    )
    return tuple(flag for flags in saturated for flag in flags)


def _at_full_scale(row: FloatArray, channel: Channel, full_scale: float) -> list[Flag]:
    count = int(np.count_nonzero(np.abs(row) >= full_scale * (1.0 - 1e-9)))
    if not count:
        return []
    message = (
        f"{channel.name}: {count} sample(s) at or above the full scale of "
        f"{full_scale:g} {channel.unit}; peaks are cut off: use a larger range"
    )
    return [Flag("saturated", Severity.VOID, message, channel.name)]


def _flat_tops(row: FloatArray, channel: Channel) -> list[Flag]:
    flags = []
    is_finite = np.isfinite(row)
    finite = row if is_finite.all() else row[is_finite]
    for end, sign in (("highest", 1.0), ("lowest", -1.0)):
        count = flat_top(sign * finite) if _many_at_end(finite, sign) else 0
        if count:
            level = np.nanmax(row) if end == "highest" else np.nanmin(row)
            message = (
                f"{channel.name}: {count} samples stand in flat runs at the {end} value, "
                f"{level:.6g} {channel.unit}: cut off, it seems; state full_scale to be sure"
            )
            flags.append(Flag("saturated", Severity.WARNING, message, channel.name))
    return flags


def _many_at_end(values: FloatArray, sign: float) -> bool:
    """Tell quickly of most channels that too few samples for a flat top are at their extreme.

    The step between some of the values is no smaller than between all of them.
    """
    if not values.size:
        return False
    low, high = float(values.min()), float(values.max())
    reach = 1.5 * _step(np.unique(values[:: 1 + values.size // _SOME]), high - low)
    at_end = values > high - reach if sign > 0.0 else values < low + reach
    return bool(np.count_nonzero(at_end) >= 2 * FLAT_RUN)


def flat_top(values: FloatArray) -> int:
    """Count the samples in flat stretches at the maximum; 0 where it is a crest.

    A limit may flicker between two steps of the digitiser. Down from there a crest, however flat,
    has many more samples within a few steps; what is cut off arrives with a slope, and has not.

    Parameters
    ----------
    values
        Finite, shape ``(samples,)``.
    """
    if not values.size:
        return 0
    highest = float(values.max())
    extent = highest - float(values.min())
    levels = np.unique(values)
    if levels.size < FEWEST_LEVELS:
        return 0  # a switch, or a display of a few digits
    step = _step(levels, extent)
    below = highest - values
    at_top = below < 1.5 * step
    lengths = np.array([stop - start for start, stop in runs(at_top)], dtype=int)
    flat = lengths[lengths >= FLAT_RUN]
    if flat.size < 2:
        return 0
    near_count = np.count_nonzero(below < max(FLAT_STEPS * step, FLAT_SHARE * extent))
    return int(flat.sum()) if near_count < FLAT_EXCESS * np.count_nonzero(at_top) else 0


def _step(levels: FloatArray, extent: float) -> float:
    with np.errstate(over="ignore"):  # of numbers near the largest
        steps = np.diff(levels)
    return float(steps[steps > _ROUNDING * extent].min(initial=extent))
