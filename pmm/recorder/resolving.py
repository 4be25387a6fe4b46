"""Resolves the gates of a run again, from samples and pulses of its replay."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, Final

import numpy as np

from analysis.resolver.weights import REACH
from pmm.recorder.files import EVENTS, HARMONICS
from pmm.recorder.live_path import Feed, Taken, as_record
from pmm.recorder.recording import RunData

ARMED: Final = "armed"
"""Kind of the event that begins a resolver anew; its text is the SYNC of the first sample."""

Reading = Mapping[str, Any]


def resolve_again(run: RunData, taken: Sequence[Taken]) -> tuple[Reading | None, ...]:
    """Return each reading of the run's journal as the replay gives it; ``None`` where none comes.

    A reading is over a gate of so many periods that a resolver had found since it was armed: so one
    is armed at the same SYNC again, with as many periods, and the reading over that gate taken.
    """
    told = run.texts[HARMONICS]
    found: dict[tuple[int, int], dict[tuple[float, float], Reading]] = {}
    again = []
    for one in told:
        start = _start_of(one, run)
        key = (start, int(one["periods"]))
        if key not in found:
            found[key] = dict(_gates(run, taken, *key))
        again.append(found[key].get((one["opened_s"], one["closed_s"])))
    return tuple(again)


def largest_difference(told: Sequence[Reading], again: Sequence[Reading | None]) -> float:
    """Return the largest difference of a coefficient over the largest of its channel.

    Infinite where a reading did not come again.
    """
    largest = 0.0
    for one, other in zip(told, again, strict=True):
        if other is None:
            return float("inf")
        before, after = (np.array(each["coefficients"], float) for each in (one, other))
        scale = np.max(np.abs(before), axis=1, keepdims=True)
        off = np.abs(after - before) / np.where(scale > 0.0, scale, 1.0)
        largest = max(largest, float(np.max(off, initial=0.0)))
    return largest


def _start_of(reading: Reading, run: RunData) -> int:
    """Return the SYNC at which the reading's resolver began."""
    rate_hz = run.header.sample_rate_hz
    starts = [run.header.first_sync, *_armed(run)]
    return max(n for n in starts if n / rate_hz <= reading["opened_s"] or n == starts[0])


def _armed(run: RunData) -> list[int]:
    return [int(one["text"]) for one in run.texts[EVENTS] if one["kind"] == ARMED]


def _gates(
    run: RunData, taken: Sequence[Taken], start: int, periods: int
) -> Iterator[tuple[tuple[float, float], Reading]]:
    """Yield the readings of a resolver that begins at a SYNC, by their gates."""
    header = run.header
    rate_hz, settings = header.sample_rate_hz, replace(header.live, periods=periods)
    later = [n for n in _armed(run) if n > start]
    until_s = min(later) / rate_hz if later else np.inf
    from_s = start / rate_hz
    if start in _armed(run):
        from_s += REACH / rate_hz + settings.latency_s
    feed = Feed(header.channels, rate_hz, settings, start, from_s)
    for each in taken:
        pulses = tuple(one for one in each.pulses if one.time_s < until_s)
        for one in feed.take(replace(each, pulses=pulses)):
            yield (one.opened_s, one.closed_s), as_record(one)
    for one in feed.resolver.finish():
        yield (one.opened_s, one.closed_s), as_record(one)
