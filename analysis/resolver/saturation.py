"""Samples at the end of an instrument's range, within the periods that were used."""

import numpy as np

from analysis.recording import Recording
from hardware.description.flags import Flag, Severity

_AT_ONCE = 200_000  # samples
_ROUNDED = 1.0 - 1e-9  # of the full scale


def saturation_flags(recording: Recording, opened_s: float, closed_s: float) -> tuple[Flag, ...]:
    """Return a flag for each channel that reached its full scale between two times.

    A channel that its reader has flagged already is not flagged again.
    """
    known = {flag.channel for flag in recording.flags if flag.code == "saturated"}
    rows = [
        row
        for row, channel in enumerate(recording.channels)
        if channel.full_scale is not None and channel.name not in known
    ]
    if not rows:
        return ()
    used = recording.between(opened_s, closed_s)
    limits = np.array([recording.channels[row].full_scale for row in rows], dtype=np.float64)
    counts = np.zeros(len(rows), dtype=np.int64)
    for start in range(0, used.sample_count, _AT_ONCE):
        values = used.samples[rows, start : start + _AT_ONCE]
        counts += (np.abs(values) >= limits[:, None] * _ROUNDED).sum(axis=1)
    return tuple(
        Flag(
            "saturated",
            Severity.VOID,
            f"{count} samples of the periods used stand at the full scale of {limit:g} "
            f"{recording.channels[row].unit}; the harmonics are those of the clipped signal",
            recording.channels[row].name,
        )
        for row, limit, count in zip(rows, limits, counts.tolist(), strict=True)
        if count
    )
