"""What ``pmm recover`` and ``pmm replay`` show of recorded runs."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from pmm.document.content import (
    ABSENT,
    Column,
    Content,
    Data,
    Document,
    Notes,
    Section,
    Table,
    Text,
    number,
    pairs,
    word,
)
from pmm.document.flag_lines import flag_notes
from pmm.document.notation import written
from pmm.recorder.recovery import RecoveredRun
from pmm.recorder.replay import Replay

REPLAY_SCHEMA: Final = "pmm-replay-1"


@dataclass(frozen=True)
class Recovery:
    """What came of a run's folder: a run, or why there is none.

    Attributes
    ----------
    error
        Why it could not be recovered.
    empty
        That nothing had been written.
    """

    folder: Path
    run: RecoveredRun | None = None
    error: str = ""
    empty: str = ""

    @property
    def outcome(self) -> str:
        """What was done, in words."""
        if self.run is None:
            why = "the program ended before anything was written" if self.empty else "see the error"
            return f"nothing: {why}"
        return "nothing: it was closed" if self.run.was_whole else f"{self.run.path.name} is there"


def _of_run(key: str, heading: str | None = None) -> Column[Recovery]:
    """Return a column of a number, or of what programs alone get, of what was recovered."""
    return Column(
        heading,
        lambda row: ABSENT if row.run is None else getattr(row.run, key),
        key,
        lambda value: "0" if value is ABSENT else str(value),
        number=True,
    )


def _if_any(key: str, name: str) -> Column[Recovery]:
    return Column(None, lambda row: getattr(row, key) or ABSENT, name)


_RECOVERIES: Final[tuple[Column[Recovery], ...]] = (
    Column("run", lambda row: row.folder, "folder", lambda folder: folder.name),
    _of_run("samples", "samples"),
    _of_run("missing", "missing"),
    _of_run("frames", "frames"),
    Column("bytes not whole", lambda row: sum(row.run.lost_tail_bytes.values()) if row.run else 0,
           number=True),
    Column("what was done", lambda row: row.outcome),
    *(_of_run(key) for key in ("path", "lost_tail_bytes", "was_whole", "flags", "changed")),
    _if_any("error", "error"),
    _if_any("empty", "nothing_written"),
)  # fmt: skip


def recovery_document(recoveries: Sequence[Recovery]) -> Document:
    """Return what came of runs that were to be recovered."""
    first = Section("", (Table("Runs", _RECOVERIES, recoveries, "runs"),))
    flagged = (
        Section(recovery.folder.name, (Notes(flag_notes(recovery.run.flags)),))
        for recovery in recoveries
        if recovery.run
    )
    return Document("", "recovered runs", (first, *flagged), "")


def _pulses_in_words(replay: Replay) -> str:
    found = replay.pulse_comparison
    words = f"{len(replay.recorded_pulses_s)} recorded, {len(replay.pulses)} again"
    if found.differing:
        words += f", {found.differing} differ"
    if found.missing:
        words += f", {len(found.missing)} not recorded, from {found.missing[0].time_s:.2f} s on"
    return words


def replay_document(replay: Replay) -> Document:
    """Return how far a replay gives what its run had written."""
    count, reading_count = replay.recorded.shape[1], len(replay.recorded_readings)
    counts = {
        "samples": f"{count}, {replay.differing_samples} values differ",
        "pulses": _pulses_in_words(replay),
        "readings": f"{reading_count} recorded, largest difference {replay.difference:.2g}",
    }
    contents: tuple[Content, ...] = (
        pairs("Replay", counts),
        *_last_reading(replay),
        Text([f"reported again: {fault}" for fault in replay.faults], faint=True),
        Data("same", replay.same),
        Data("samples", count),
        Data("differing_values", replay.differing_samples),
        Data("pulses", len(replay.pulses)),
        Data("recorded_pulses", len(replay.recorded_pulses_s)),
        Data("missing_pulses_s", [pulse.time_s for pulse in replay.pulse_comparison.missing]),
        Data("differing_pulses", replay.pulse_comparison.differing),
        Data("readings", [reading and reading["coefficients"] for reading in replay.readings]),
        Data(
            "recorded_readings",
            [recorded_reading["coefficients"] for recorded_reading in replay.recorded_readings],
        ),
        Data("largest_difference", replay.difference),
        Data("faults", replay.faults),
        Data("changed", replay.changed),
    )
    return Document("", "a replay beside its run", (Section("", contents),), REPLAY_SCHEMA)


@dataclass(frozen=True)
class _FirstHarmonics:
    """First harmonic of a channel: in phase and quadrature as recorded, and again."""

    channel: str
    in_phase: float
    quadrature: float
    in_phase_again: float
    quadrature_again: float


def _last_reading(replay: Replay) -> Iterator[Table[_FirstHarmonics]]:
    """Yield the last reading of both."""
    if not replay.recorded_readings:
        return
    recorded_reading, replayed_reading = replay.recorded_readings[-1], replay.readings[-1]
    form = written(".9g")
    columns = (
        word("channel", "channel"),
        number("in phase 1", "in_phase", form),
        number("quadrature 1", "quadrature", form),
        number("in phase 1 again", "in_phase_again", form),
        number("quadrature 1 again", "quadrature_again", form),
    )
    rows = [
        _FirstHarmonics(
            channel, *_first_harmonic(recorded_reading, i), *_first_harmonic(replayed_reading, i)
        )
        for i, channel in enumerate(recorded_reading["channels"])
    ]
    name = (
        f"Last reading: {recorded_reading['periods']} periods "
        f"to {recorded_reading['closed_s']:.3f} s"
    )
    yield Table(name, columns, rows, titled=True)


def _first_harmonic(reading: Mapping[str, Any] | None, channel: int) -> tuple[float, float]:
    """Return a reading's first harmonic of a channel; NaN where there is no reading."""
    if reading is None:
        return float("nan"), float("nan")
    in_phase, quadrature = reading["coefficients"][channel][1:3]
    return in_phase, quadrature
