"""Runs a raw log through the live path again: the same decoding, the same resolver."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from importlib.metadata import EntryPoint
from pathlib import Path
from typing import Any, Final

import numpy as np

from analysis.resolver.harmonics import Harmonics
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError
from hardware.roles import Pulse
from pmm.recorder.campaign_owner import writer_of
from pmm.recorder.decoding import decode
from pmm.recorder.file_changes import changed_files
from pmm.recorder.files import EVENTS, HARMONICS, PULSES
from pmm.recorder.live_path import CycleSamples, GateResolver, as_record, joined_samples
from pmm.recorder.pulse_comparison import PulseComparison, compare_pulses
from pmm.recorder.recording import RunData, read_run
from pmm.recorder.samples import JournalSamples

SAME_READING: Final = 1e-12
ARMED: Final = "armed"
"""Kind of the event that begins a resolver anew; its text is the SYNC of the first sample."""

Reading = Mapping[str, Any]


@dataclass(frozen=True)
class Replay:
    """What came out of the raw log, beside what the run had written.

    Attributes
    ----------
    samples
        Those of the replay, shape ``(channels, n)``, from the run's first SYNC on; NaN where none.
    recorded
        Those of the journal at the same SYNCs.
    differing_samples
        Values that are not the same bit by bit, a NaN being the same as a NaN.
    pulses, recorded_pulses_s
        Pulses of the replay, and their times in the journal.
    pulse_comparison
        What the journal's pulses are beside those of the replay.
    readings, recorded_readings
        Final readings of the resolver, as the journal keeps them; ``None`` where a recorded one
        did not come again.
    difference
        Largest difference of a coefficient, over the largest of its channel.
    faults
        What the devices reported again, in words.
    changed
        File of the run to what of it is not what was written, in words.
    """

    samples: FloatArray
    recorded: FloatArray
    differing_samples: int
    pulses: tuple[Pulse, ...]
    recorded_pulses_s: FloatArray
    pulse_comparison: PulseComparison
    readings: tuple[Mapping[str, Any] | None, ...]
    recorded_readings: tuple[Mapping[str, Any], ...]
    difference: float
    faults: tuple[str, ...]
    changed: Mapping[str, str]

    @property
    def same(self) -> bool:
        """Whether samples and pulses are those of the run bit by bit, and the readings to 1e-12.

        A resolver that got its samples in other blocks rounds its sums in another way.
        """
        return (
            self.differing_samples == 0
            and self.pulse_comparison.same
            and self.difference <= SAME_READING
        )


def replay(folder: Path, drivers: Iterable[EntryPoint] | None = None) -> Replay:
    """Replay a run.

    Parameters
    ----------
    drivers
        Where the rig's drivers are looked for; all installed ones by default.

    Raises
    ------
    DataError
        If the folder holds no samples, no raw log, or no rig to decode it with, or the run is being
        recorded.
    ConfigurationError
        If the rig of the header cannot be built, because a driver is not installed for example.
    """
    run = read_run(folder)
    writer = writer_of(folder.resolve().parent)
    if run.marker is None and writer is not None:
        raise DataError(f"{folder}: is being recorded by {writer}; replay it when it has ended")
    if run.samples is None:
        raise DataError(f"{folder}: holds no whole sample to compare a replay with")
    return _compare(run, run.samples, *decode(run, drivers))


def _compare(
    run: RunData, samples: JournalSamples, taken: list[CycleSamples], faults: list[str]
) -> Replay:
    recorded = samples[:, 0 : samples.sample_count]
    replayed = np.full(recorded.shape, np.nan)
    skipped = samples.first_sync - run.header.first_sync
    decoded = joined_samples(taken, recorded.shape[0])[:, skipped : skipped + samples.sample_count]
    replayed[:, : decoded.shape[1]] = decoded
    differing = ~((replayed == recorded) | (np.isnan(replayed) & np.isnan(recorded)))
    records, again_read = tuple(run.texts[HARMONICS]), resolve_again(run, taken)
    pulses = tuple(pulse for each in taken for pulse in each.pulses)
    end_s = (run.header.first_sync + len(taken) - 1) / run.header.sample_rate_hz
    return Replay(
        replayed,
        recorded,
        int(np.sum(differing)),
        pulses,
        run.pulses_s,
        compare_pulses(run.texts[PULSES], pulses, end_s),
        again_read,
        records,
        largest_difference(records, again_read),
        tuple(faults),
        changed_files(run),
    )


def resolve_again(run: RunData, taken: Sequence[CycleSamples]) -> tuple[Reading | None, ...]:
    """Return each reading of the run's journal as the replay gives it; ``None`` where none comes.

    A reading is over a gate of so many periods that a resolver had found since it was armed: so one
    is armed at the same SYNC again, with as many periods, and the reading over that gate taken.
    """
    records = run.texts[HARMONICS]
    readings_from: dict[tuple[int, int], dict[tuple[float, float], Reading]] = {}
    readings = []
    for record in records:
        start = _start_of(record, run)
        key = (start, int(record["periods"]))
        if key not in readings_from:
            readings_from[key] = dict(_gates(run, taken, *key))
        readings.append(readings_from[key].get((record["opened_s"], record["closed_s"])))
    return tuple(readings)


def largest_difference(records: Sequence[Reading], readings: Sequence[Reading | None]) -> float:
    """Return the largest difference of a coefficient over the largest of its channel.

    Infinite where a reading did not come again.
    """
    largest = 0.0
    for record, reading in zip(records, readings, strict=True):
        if reading is None:
            return float("inf")
        before, after = (np.array(each["coefficients"], float) for each in (record, reading))
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
    run: RunData, taken: Sequence[CycleSamples], start: int, periods: int
) -> Iterator[tuple[tuple[float, float], Reading]]:
    """Yield the readings of a resolver that begins at a SYNC, by their gates."""
    header = run.header
    rate_hz, settings = header.sample_rate_hz, replace(header.live, periods=periods)
    until_s = min((n / rate_hz for n in _armed(run) if n > start), default=np.inf)
    gate_resolver = GateResolver(header.channels, rate_hz, settings, start)
    for each in taken:
        readings = gate_resolver.push(each)
        for pulse in each.pulses:
            if gate_resolver.takes(pulse) and pulse.time_s < until_s:
                with suppress(DataError):  # it had the run's gate armed anew
                    readings += gate_resolver.resolver.pulse(pulse.time_s)
        yield from ((_gate(reading), as_record(reading)) for reading in readings)
    yield from ((_gate(reading), as_record(reading)) for reading in gate_resolver.resolver.finish())


def _gate(reading: Harmonics) -> tuple[float, float]:
    return reading.opened_s, reading.closed_s
