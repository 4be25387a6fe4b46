"""A phase channel with missing samples: the longest part of the record without a gap."""

import numpy as np

from analysis.recording import Recording
from analysis.resolver.reference import NoReferenceError
from hardware.description.arrays import BoolArray, IntArray
from hardware.description.flags import Flag, Severity


def without_gaps(
    recording: Recording, name: str, holds_s: float | None = None
) -> tuple[Recording, tuple[Flag, ...]]:
    """Cut a recording to the longest stretch in which one channel has no missing sample.

    Parameters
    ----------
    name
        The channel that is to tell the phase.
    holds_s
        Take the stretch that holds this time instead.

    Returns
    -------
    Recording
        The recording itself where nothing is missing; of uneven samples those that are there.
    tuple of Flag
        ``reference_gap`` where something is, with what was left out.

    Raises
    ------
    NoReferenceError
        If every sample is missing, or the one at ``holds_s``.
    """
    if recording.stamps_s is not None:
        return recording.select([name]).complete(), ()
    missing = ~np.isfinite(recording.values(name))
    if not missing.any():
        return recording, ()
    stretches, gaps = _runs(~missing), _runs(missing)
    where = _in_words(recording, gaps)
    if not len(stretches):
        raise NoReferenceError(
            f"{recording.name}: every sample of channel {name!r} is missing, so that it cannot "
            "tell the phase; take another reference, or give the frequency"
        )
    if holds_s is None:
        start, stop = stretches[int(np.argmax(np.diff(stretches, axis=1)))]
    else:
        start, stop = _that_holds(recording, name, stretches, holds_s, where)
    half = 0.5 / recording.sample_rate_hz
    first_s, last_s = recording.time_s(int(start), int(stop))[[0, -1]].tolist()
    message = (
        f"{where}; the phase is told from {first_s:.3f} s to {last_s:.3f} s, what lies outside is "
        "left out. With another reference, or a given frequency, all of it counts"
    )
    part = recording.between(first_s - half, last_s + half)
    return part, (Flag("reference_gap", Severity.WARNING, message, name),)


def gap_in_words(flags: tuple[Flag, ...]) -> str:
    """Return what a message of a reference that failed should add: where its gaps are."""
    return "".join(
        f"; {flag.channel}: {flag.message.split(';')[0]}"
        for flag in flags
        if flag.code == "reference_gap"
    )


def _runs(condition: BoolArray) -> IntArray:
    """Stretches ``[start, stop)`` over which a condition holds, shape ``(stretches, 2)``."""
    padded = np.concatenate(([False], condition, [False]))
    return np.flatnonzero(padded[1:] != padded[:-1]).astype(np.int64).reshape(-1, 2)


def _in_words(recording: Recording, gaps: IntArray) -> str:
    """Say how many samples are missing, and where the most are."""
    lengths = np.diff(gaps, axis=1)[:, 0]
    longest = int(np.argmax(lengths))
    at_s = recording.time_s(int(gaps[longest, 0]), int(gaps[longest, 0]) + 1)[0]
    count = int(lengths[longest])
    worst = f"{count} samples from {at_s:.3f} s on ({count / recording.sample_rate_hz:.3g} s)"
    if len(gaps) == 1:
        return f"missing are {worst}"
    return f"{int(lengths.sum())} samples are missing in {len(gaps)} places, at most {worst}"


def _that_holds(
    recording: Recording, name: str, stretches: IntArray, holds_s: float, where: str
) -> IntArray:
    number = float(recording.sample_number(np.array([holds_s]))[0])
    inside = (stretches[:, 0] <= number + 1e-6) & (number - 1e-6 <= stretches[:, 1] - 1)
    if not inside.any():
        raise NoReferenceError(
            f"{recording.name}: channel {name!r} has no sample at {holds_s:g} s to tell the phase "
            f"from: {where}; open the gate elsewhere, take another reference, or give the frequency"
        )
    return np.asarray(stretches[int(np.argmax(inside))])
