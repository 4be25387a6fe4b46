"""Resolves the gates of a run again, from samples and pulses of its replay."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Any, Final

import numpy as np

from analysis.resolver.harmonics import Harmonics
from hardware.description.errors import DataError
from pmm.recorder.files import EVENTS, HARMONICS
from pmm.recorder.live_path import GateResolver, Taken, as_record
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
    starts = [n for n in _armed(run) if n / rate_hz <= reading["opened_s"]]
    return max(starts, default=run.header.first_sync)


def _armed(run: RunData) -> list[int]:
    return [int(text["text"]) for text in run.texts[EVENTS] if text["kind"] == ARMED]


def _gates(
    run: RunData, taken: Sequence[Taken], start: int, periods: int
) -> Iterator[tuple[tuple[float, float], Reading]]:
    """Yield the readings of a resolver that begins at a SYNC, by their gates."""
    header = run.header
    rate_hz, settings = header.sample_rate_hz, replace(header.live, periods=periods)
    until_s = min((n / rate_hz for n in _armed(run) if n > start), default=np.inf)
    again = GateResolver(header.channels, rate_hz, settings, start)
    for each in taken:
        found = again.push(each)
        for pulse in each.pulses:
            if again.takes(pulse) and pulse.time_s < until_s:
                with suppress(DataError):  # it had the run's gate armed anew
                    found += again.resolver.pulse(pulse.time_s)
        yield from ((_gate(one), as_record(one)) for one in found)
    yield from ((_gate(one), as_record(one)) for one in again.resolver.finish())


def _gate(reading: Harmonics) -> tuple[float, float]:
    return reading.opened_s, reading.closed_s
