"""Values that are none: missing, infinite, and beyond any instrument's range.

Files hold them as NaN, as infinity, or as an overload's 1e300; whatever the file, they count as
missing from here on, and are said.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from analysis.recording import Recording, Samples
from hardware.description.arrays import BoolArray, FloatArray
from hardware.description.flags import DAMAGED, Flag, Severity

# Of whatever unit: a load cell ends at 1e8 N and a counter at 1e10, and sums of squares of 1e12 are
# exact to a double's digits.
LARGEST: Final = 1e12
_BLOCK: Final = 1 << 17  # samples read at a time
_SAID: Final = ("missing", "channel_empty", "beyond_range", DAMAGED)
_GAP: Final = "gap"


@dataclass(frozen=True)
class _WithoutBeyond:
    """Samples, NaN where they are beyond; their source is unaltered."""

    source: Samples

    @property
    def shape(self) -> tuple[int, ...]:
        """``(channels, samples)``."""
        return self.source.shape

    def __getitem__(self, key: tuple[slice | Sequence[int], slice], /) -> FloatArray:
        """Return the values of some channels between two sample numbers."""
        values = np.array(self.source[key])
        values[np.abs(values) > LARGEST] = np.nan
        return values


class _Survey:
    """What is none in a recording, channel by channel; it is read once, a stretch at a time.

    Attributes
    ----------
    beyond, missing, longest
        Samples that are beyond; those that are missing (but for what is said of all channels at
        once, a gap); the most of them in a row.
    first
        Row to time and value of the first sample beyond.
    """

    def __init__(self, recording: Recording) -> None:
        count = len(recording.channels)
        self.beyond, self.missing, self.longest, self._open = np.zeros((4, count), dtype=int)
        self.first: dict[int, tuple[float, float]] = {}
        self._gaps_are_said = any(flag.code == _GAP for flag in recording.flags)
        for start in range(0, recording.sample_count, _BLOCK):
            stop = min(start + _BLOCK, recording.sample_count)
            values = recording.samples[:, start:stop]
            with np.errstate(invalid="ignore"):
                within = np.abs(values) <= LARGEST
            if not within.all():
                self._take(values, within, recording.time_s(start, stop))
            else:
                self._open[:] = 0

    def _take(self, values: FloatArray, within: BoolArray, time_s: FloatArray) -> None:
        beyond = ~within & ~np.isnan(values)
        self.beyond += np.count_nonzero(beyond, axis=1)
        for row in np.flatnonzero(beyond.any(axis=1)).tolist():
            at = int(np.argmax(beyond[row]))
            self.first.setdefault(row, (float(time_s[at]), float(values[row, at])))
        missing = ~within & ~beyond
        if self._gaps_are_said:
            missing &= ~missing.all(axis=0)
        self.missing += np.count_nonzero(missing, axis=1)
        for row, lost in enumerate(missing):
            self._runs(row, lost)

    def _runs(self, row: int, lost: BoolArray) -> None:
        """Take the stretches of one channel; one may have begun in the block before."""
        edges = np.flatnonzero(np.diff(lost, prepend=False, append=False))
        lengths = edges[1::2] - edges[::2]
        if lost[0]:
            lengths[0] += self._open[row]
        self.longest[row] = max(int(self.longest[row]), int(lengths.max(initial=0)))
        self._open[row] = lengths[-1] if lost[-1] else 0


def without_beyond(recording: Recording) -> Recording:
    """Count what no sensor gives as missing, and say of each channel when it was and how often.

    Values are beyond where they are infinite or larger than 1e12 of their unit. A recording without
    them is returned as it is; what is long is read a stretch at a time.
    """
    return _with_beyond_said(recording, _Survey(recording))


def with_missing_said(recording: Recording) -> Recording:
    """Count what no sensor gives as missing, and say of each channel what is missing.

    For files that are not repaired. What the recording's own flags say already is not said again: a
    gap of all channels at once, and the missing samples of a channel by name.
    """
    survey = _Survey(recording)
    flagged_channels = {flag.channel for flag in recording.flags if flag.code in _SAID}
    flags = tuple(
        _missing_flag(channel.name, int(survey.missing[row]), int(survey.longest[row]), recording)
        for row, channel in enumerate(recording.channels)
        if survey.missing[row] and channel.name not in flagged_channels
    )
    flagged = _with_beyond_said(recording, survey)
    return replace(flagged, flags=(*flagged.flags, *flags)) if flags else flagged


def _missing_flag(name: str, count: int, longest: int, recording: Recording) -> Flag:
    if count == recording.sample_count:
        return empty_flag(name)
    text = f"{name}: {count} sample(s) are missing in the file, the longest run {longest}"
    return Flag("missing", Severity.VOID, text, name)


def empty_flag(name: str) -> Flag:
    """Return the flag of a channel without a value."""
    return Flag("channel_empty", Severity.VOID, f"{name}: every sample is missing", name)


def _with_beyond_said(recording: Recording, survey: _Survey) -> Recording:
    flags = tuple(_beyond_flags(recording, survey))
    if not flags:
        return recording
    samples = _WithoutBeyond(recording.samples)
    return replace(recording, samples=samples, flags=(*recording.flags, *flags))


def _beyond_flags(recording: Recording, survey: _Survey) -> Iterator[Flag]:
    for row, (time_s, value) in sorted(survey.first.items()):
        channel = recording.channels[row]
        message = (
            f"{channel.name}: {survey.beyond[row]} sample(s) beyond {LARGEST:g}, the first "
            f"{value:g} at {time_s:.6g} s; no sensor gives that, they count as missing: look at "
            "the recorder's overload value and at the column's unit"
        )
        yield Flag("beyond_range", Severity.VOID, message, channel.name)
