"""Missing values and saturation: what is repaired, what is only said."""

import numpy as np
from numpy.typing import NDArray

from analysis.recording import FloatArray
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
_FEWEST_LEVELS = 16
_ROUNDING = 1e-9  # of what the signal covers: values nearer to each other are the same


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
        flags += _infinite(row, channel.name)
        flags += _repair(row, channel.name)
    return tuple(flags)


def _infinite(row: FloatArray, name: str) -> list[Flag]:
    infinite = np.isinf(row)
    count = int(np.count_nonzero(infinite))
    row[infinite] = np.nan
    message = f"{name}: {count} sample(s) are infinite (overload?); they count as missing"
    return [Flag("infinite", Severity.VOID, message, name)] if count else []


def _repair(row: FloatArray, name: str) -> list[Flag]:
    missing = np.isnan(row)
    if not missing.any():
        return []
    if missing.all():
        return [Flag("channel_empty", Severity.VOID, f"{name}: every sample is missing", name)]
    repaired = left = longest = 0
    for start, stop in runs(missing):
        length = stop - start
        around = np.array([start - 2, start - 1, stop, stop + 1])
        good = around[0] >= 0 and around[-1] < row.size and not missing[around].any()
        if good and length <= LONGEST_REPAIR:
            row[start:stop] = _cubic(length) @ row[around]
            repaired += length
        else:
            left, longest = left + length, max(longest, length)
    return _missing_flags(name, repaired, left, longest)


def _missing_flags(name: str, repaired: int, left: int, longest: int) -> list[Flag]:
    flags = []
    if repaired:
        message = (
            f"{name}: {repaired} missing sample(s) in runs of up to {LONGEST_REPAIR} were filled "
            "by a cubic through two samples on either side"
        )
        flags.append(Flag("repaired", Severity.WARNING, message, name))
    if left:
        message = (
            f"{name}: {left} sample(s) are missing and left so (longest run {longest}; only runs "
            f"of up to {LONGEST_REPAIR} within good samples are filled)"
        )
        flags.append(Flag("missing", Severity.VOID, message, name))
    return flags


def _cubic(length: int) -> FloatArray:
    """Lagrange weights, shape ``(length, 4)``, of the two samples before and after a run."""
    nodes = np.array([-2.0, -1.0, length, length + 1.0])
    places = np.arange(length, dtype=np.float64)
    weights = np.ones((length, 4))
    for k in range(4):
        for other in np.delete(nodes, k):
            weights[:, k] *= (places - other) / (nodes[k] - other)
    return weights


def runs(condition: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Return the stretches ``[start, stop)`` over which a condition holds."""
    padded = np.concatenate(([False], condition, [False]))
    edges = np.flatnonzero(padded[1:] != padded[:-1])
    return [(int(start), int(stop)) for start, stop in edges.reshape(-1, 2)]


def saturation_flags(samples: FloatArray, channels: tuple[Channel, ...]) -> tuple[Flag, ...]:
    """Flag samples at the full scale, or, where that is unknown, tops cut off flat."""
    found = (
        _flat_tops(row, channel)
        if channel.full_scale is None
        else _at_full_scale(row, channel, channel.full_scale)
        for row, channel in zip(samples, channels, strict=True)
    )
    return tuple(flag for flags in found for flag in flags)


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
    for what, values in (("highest", row), ("lowest", -row)):
        count = flat_top(values[np.isfinite(values)])
        if count:
            level = np.nanmax(row) if what == "highest" else np.nanmin(row)
            message = (
                f"{channel.name}: {count} samples stand in flat runs at the {what} value, "
                f"{level:.6g} {channel.unit}: cut off, it seems; state full_scale to be sure"
            )
            flags.append(Flag("saturated", Severity.WARNING, message, channel.name))
    return flags


def flat_top(values: FloatArray) -> int:
    """Count the samples in flat stretches at the maximum; 0 where it is a crest.

    A limit may flicker between two steps of the digitiser. Down from there a crest, however flat,
    has many more samples within a few steps; what is cut off arrives with a slope, and has not.

    Parameters
    ----------
    values
        Finite, shape ``(samples,)``.
    """
    levels = np.unique(values)
    if levels.size < _FEWEST_LEVELS:
        return 0  # a switch, or a display of a few digits
    apart, extent = np.diff(levels), float(np.ptp(levels))
    step = float(apart[apart > _ROUNDING * extent].min(initial=extent))
    below = values.max() - values
    at_top = below < 1.5 * step
    lengths = np.array([stop - start for start, stop in runs(at_top)], dtype=int)
    flat = lengths[lengths >= FLAT_RUN]
    if flat.size < 2:
        return 0
    near = np.count_nonzero(below < max(FLAT_STEPS * step, FLAT_SHARE * extent))
    return int(flat.sum()) if near < FLAT_EXCESS * np.count_nonzero(at_top) else 0
