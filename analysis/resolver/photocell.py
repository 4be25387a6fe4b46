"""The photocell's pulses as a phase reference: one a revolution, some missed, some too many."""

import numpy as np

from analysis.resolver.reference import PhaseReference, ReferenceSource
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity

_NEIGHBOURS = 7  # intervals whose median is the local period
EARLY = 0.7  # of the local period: a pulse too many
LATE = 1.5  # of the local period: a pulse missed
_UNEQUAL = 0.05  # of a pulse's two intervals together, by which they differ: more than a shaft's
_THROUGHOUT = 0.9  # of the pulses
_FEWEST_PAIRED = 5  # pulses between others: fewer may be a single one too many


def from_photocell(
    edges_s: FloatArray, *, latency_s: float = 0.0, angle_offset_rad: float = 0.0
) -> PhaseReference:
    """Build a reference from photocell pulses, straight within each revolution.

    Its knots are at the pulses. A missed pulse is bridged, one too many is dropped; both are
    flagged. Where pulses come in pairs throughout the first of each is taken, and that is flagged.

    Parameters
    ----------
    edges_s
        Times of the pulses, increasing, shape ``(pulses,)``.
    latency_s
        How much later than the mark's passage a pulse is stamped; taken off.
    angle_offset_rad
        Shaft angle at the mark.

    Raises
    ------
    DataError
        With fewer than two pulses, or times that do not increase.
    """
    edges = np.asarray(edges_s, dtype=np.float64) - latency_s
    if len(edges) < 2:
        raise DataError(f"{len(edges)} photocell pulses; a whole period needs at least two")
    if not np.all(np.diff(edges) > 0.0):
        at = int(np.argmin(np.diff(edges) > 0.0))
        raise DataError(
            f"photocell pulse {at + 1} at {edges[at + 1]:.6f} s does not come after pulse {at} "
            f"at {edges[at]:.6f} s; pulses must be given in order of time, each once"
        )
    edges, paired = _first_of_pairs(edges)
    edges, extra = _without_extra(edges)
    turns = _turns(edges)
    cycles = np.concatenate(([0.0], np.cumsum(turns))) + angle_offset_rad / (2.0 * np.pi)
    flags = paired + _pulse_flags(edges, turns, extra)
    return PhaseReference(ReferenceSource.PHOTOCELL, edges, cycles, flags)


def _local_period(intervals: FloatArray) -> FloatArray:
    """Median of the intervals around each one, whole neighbourhoods even at the ends."""
    width = min(_NEIGHBOURS, len(intervals))
    windows = np.lib.stride_tricks.sliding_window_view(intervals, width)
    at = np.clip(np.arange(len(intervals)) - width // 2, 0, len(windows) - 1)
    return np.asarray(np.median(windows, axis=1)[at])


def _first_of_pairs(edges: FloatArray) -> tuple[FloatArray, tuple[Flag, ...]]:
    """Keep the first pulse of each pair where they come in pairs: from two marks, or both flanks.

    Which of the two came out of time with the rest could not be said there.
    """
    intervals = np.diff(edges)
    together = intervals[1:] + intervals[:-1]
    longer = np.diff(intervals) / together  # after a pulse than before it
    again = np.abs(intervals[2:] - intervals[:-2]) < _UNEQUAL * together[1:]
    in_pairs = again & (np.abs(longer[1:]) > _UNEQUAL)
    if len(longer) < _FEWEST_PAIRED or in_pairs.mean() < _THROUGHOUT:
        return edges, ()
    opens = np.concatenate((longer[:1] > 0.0, longer < 0.0, longer[-1:] > 0.0))
    within, between = (float(np.median(intervals[part])) for part in (opens[:-1], ~opens[:-1]))
    apart_deg = 360.0 * within / (within + between)
    message = (
        f"the pulses come in pairs, {apart_deg:.3g} degrees of the shaft apart: two marks, or both "
        "flanks of one. The first of each pair is taken; if the other is the mark, the phases of "
        "harmonic n are n times as many degrees too small. Mask a mark, or measure one flank"
    )
    return edges[opens], (Flag("paired_pulses", Severity.WARNING, message),)


def _without_extra(edges: FloatArray) -> tuple[FloatArray, list[float]]:
    """Drop pulses that cut a revolution short: of the two, the one out of time with the rest."""
    dropped: list[float] = []
    while len(edges) > 2:
        intervals = np.diff(edges)
        period = _local_period(intervals)
        short = np.flatnonzero(intervals < EARLY * period)
        if not short.size:
            break
        k = int(short[0])
        later = _out_of_time(edges, k + 1, period[k]) >= _out_of_time(edges, k, period[k])
        dropped.append(float(edges[k + later]))
        edges = np.delete(edges, k + later)
    return edges, dropped


def _out_of_time(edges: FloatArray, pulse: int, period: float) -> float:
    """How far from whole periods the pulses around one lie, by their median."""
    neighbours = edges[max(0, pulse - _NEIGHBOURS // 2) : pulse + _NEIGHBOURS // 2 + 1]
    distances = (neighbours[neighbours != edges[pulse]] - edges[pulse]) / period
    return float(np.median(np.abs(distances - np.rint(distances))))


def _turns(edges: FloatArray) -> FloatArray:
    """Revolutions from each pulse to the next: more than one where pulses were missed."""
    intervals = np.diff(edges)
    ratio = intervals / _local_period(intervals)
    return np.where(ratio < LATE, 1.0, np.rint(ratio))


def _pulse_flags(edges: FloatArray, turns: FloatArray, extra: list[float]) -> tuple[Flag, ...]:
    flags = []
    missed = np.flatnonzero(turns > 1.0)
    if missed.size:
        where = ", ".join(f"{edges[k]:.3f} s" for k in missed[:5])
        flags.append(
            Flag(
                "missed_pulse",
                Severity.WARNING,
                f"{int((turns - 1.0).sum())} photocell pulses missed after {where}; "
                "the phase is straight across the gap",
            )
        )
    if extra:
        where = ", ".join(f"{time:.3f} s" for time in extra[:5])
        flags.append(
            Flag("extra_pulse", Severity.WARNING, f"{len(extra)} pulses too many dropped: {where}")
        )
    return tuple(flags)
