"""Which gauge was pushed, and to which side: judged from what all gauges read.

:func:`judge` turns two records, at rest and pushed, into channel and sign; :func:`faults` compares
that with what was asked for and names the fix.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.channels import Channel
from hardware.description.errors import DataError

Records = Mapping[str, FloatArray]

NOISE_TIMES: Final = 8.0  # a push is so many standard deviations of the reading at rest
LEAST_SHARE: Final = 0.005  # and at least this part of the full scale
ALONE_SHARE: Final = 0.5  # a second gauge with more than this part of the push leaves it open
_SMOOTH: Final = 5  # samples: a single wild one is no push


class PushError(DataError):
    """It cannot be told which gauge was pushed."""


class NoPushError(PushError):
    """No gauge moved by more than its threshold."""


@dataclass(frozen=True)
class Push:
    """A push as the gauges saw it.

    Attributes
    ----------
    channel
        The gauge that was pushed.
    sign
        +1 if its reading rose, -1 if it fell.
    change, threshold
        Its largest change from rest, and what would have been too little, in ``unit``.
    others
        Largest changes of the other channels, in their units.
    """

    channel: str
    sign: int
    change: float
    threshold: float
    unit: str
    others: Mapping[str, float]


def judge(
    channels: Sequence[Channel],
    rest: Records,
    pushed: Records,
    noise_times: float = NOISE_TIMES,
) -> Push:
    """Return which gauge was pushed and to which side.

    Parameters
    ----------
    rest, pushed
        For each channel its samples, shape ``(samples,)``, in the channel's unit: nobody touches
        the gauges, and one is pushed for some part of the time. Offsets do not matter.
    noise_times
        The threshold: so many standard deviations at rest, and at least :data:`LEAST_SHARE` of the
        full scale.

    Raises
    ------
    NoPushError
        If no gauge passes its threshold.
    PushError
        If a channel has too few samples or one that is not valid, or if two gauges moved alike.
    """
    changes = {channel.name: _largest(channel.name, rest, pushed) for channel in channels}
    limits = {
        channel.name: max(
            noise_times * float(np.std(rest[channel.name])),
            LEAST_SHARE * (channel.full_scale or 0.0),
        )
        for channel in channels
    }
    first, *weaker = sorted(
        channels,
        key=lambda channel: _strength(changes[channel.name], limits[channel.name]),
        reverse=True,
    )
    change, limit = changes[first.name], limits[first.name]
    if not abs(change) > limit:
        raise NoPushError(
            f"no push: {first.name} moved most, by {change:.3g} {first.unit}, and a push is more "
            f"than {limit:.3g} {first.unit}; push harder, or look whether the gauge is connected"
        )
    for weaker_channel in weaker:
        _check_alone(first, changes, limits, weaker_channel)
    weaker_changes = {channel.name: changes[channel.name] for channel in weaker}
    return Push(first.name, 1 if change > 0.0 else -1, change, limit, first.unit, weaker_changes)


def faults(push: Push, channel: str, sign: int = 1) -> tuple[str, ...]:
    """Return what is wrong with a push on the gauge ``channel`` that should read ``sign``.

    Each with its fix; empty if all is right.
    """
    messages = []
    if push.channel != channel:
        messages.append(
            f"the push on {channel} came in on {push.channel}: their cables are swapped; exchange "
            f"the plugs of {channel} and {push.channel}, or the two channels' `object` in the "
            "rig's file"
        )
    if push.sign != sign:
        messages.append(
            f"{push.channel} went to {push.change:+.3g} {push.unit} where it should go to "
            f"{'plus' if sign > 0 else 'minus'}: turn the sign of its `scale` in the rig's file, "
            "or exchange its two signal wires"
        )
    return tuple(messages)


def _largest(name: str, rest: Records, pushed: Records) -> float:
    """Return the largest change of a channel, its sign kept, a few samples smoothed."""
    before, during = rest[name], pushed[name]
    for state, record in (("at rest", before), ("while pushed", during)):
        if record.size < _SMOOTH:
            raise PushError(f"{name}: {record.size} samples {state}; {_SMOOTH} are needed")
        if not np.all(np.isfinite(record)):
            raise PushError(f"{name}: not valid {state}; check the gauge and its cable")
    smooth = np.convolve(during - np.mean(before), np.full(_SMOOTH, 1.0 / _SMOOTH), mode="valid")
    return float(smooth[np.argmax(np.abs(smooth))])


def _strength(change: float, limit: float) -> float:
    if limit > 0.0:
        return abs(change) / limit
    return math.inf if change else 0.0


def _check_alone(
    first: Channel, changes: Mapping[str, float], limits: Mapping[str, float], weaker: Channel
) -> None:
    """Refuse a push that another gauge shows about as much, as a part of its full scale."""
    first_share, weaker_share = (
        abs(changes[channel.name]) / (channel.full_scale or 1.0) for channel in (first, weaker)
    )
    if abs(changes[weaker.name]) > limits[weaker.name] and weaker_share > ALONE_SHARE * first_share:
        raise PushError(
            f"{first.name} ({changes[first.name]:+.3g} {first.unit}) and {weaker.name} "
            f"({changes[weaker.name]:+.3g} {weaker.unit}) moved about alike: push one gauge alone, "
            "close to it, or look for a short between the channels"
        )
