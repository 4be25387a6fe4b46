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
    def done(self) -> str:
        """What was done, in words."""
        if self.run is None:
            why = "the program ended before anything was written" if self.empty else "see the error"
            return f"nothing: {why}"
        return "nothing: it was closed" if self.run.was_whole else f"{self.run.path.name} is there"


def _of_run(key: str, heading: str | None = None) -> Column[Recovery]:
    """Return a column of a number, or of what programs alone get, of what was recovered."""
    return Column(
        heading,
        lambda one: ABSENT if one.run is None else getattr(one.run, key),
        key,
        lambda value: "0" if value is ABSENT else str(value),
        number=True,
    )


def _if_any(key: str, name: str) -> Column[Recovery]:
    return Column(None, lambda one: getattr(one, key) or ABSENT, name)


_RECOVERIES: Final[tuple[Column[Recovery], ...]] = (
    Column("run", lambda one: one.folder, "folder", lambda folder: folder.name),
    _of_run("samples", "samples"),
    _of_run("missing", "missing"),
    _of_run("frames", "frames"),
    Column("bytes not whole", lambda one: sum(one.run.lost_tail_bytes.values()) if one.run else 0,
           number=True),
    Column("what was done", lambda one: one.done),
    *(_of_run(key) for key in ("path", "lost_tail_bytes", "was_whole", "flags", "changed")),
    _if_any("error", "error"),
    _if_any("empty", "nothing_written"),
)  # fmt: skip


def recovery_document(found: Sequence[Recovery]) -> Document:
    """Return what came of runs that were to be recovered."""
    first = Section("", (Table("Runs", _RECOVERIES, found, "runs"),))
    flagged = (
        Section(one.folder.name, (Notes(flag_notes(one.run.flags)),)) for one in found if one.run
    )
    return Document("", "recovered runs", (first, *flagged), "")


def replay_document(found: Replay) -> Document:
    """Return how far a replay gives what its run had written."""
    count, told = found.recorded.shape[1], len(found.recorded_readings)
    counts = {
        "samples": f"{count}, {found.differing_samples} values differ",
        "pulses": f"{len(found.recorded_pulses_s)} recorded, {len(found.pulses)} again",
        "readings": f"{told} recorded, largest difference {found.difference:.2g}",
    }
    contents: tuple[Content, ...] = (
        pairs("Replay", counts),
        *_last_reading(found),
        Text([f"reported again: {fault}" for fault in found.faults], faint=True),
        Data("same", found.same),
        Data("samples", count),
        Data("differing_values", found.differing_samples),
        Data("pulses", len(found.pulses)),
        Data("recorded_pulses", len(found.recorded_pulses_s)),
        Data("readings", [reading and reading["coefficients"] for reading in found.readings]),
        Data(
            "recorded_readings",
            [recorded_reading["coefficients"] for recorded_reading in found.recorded_readings],
        ),
        Data("largest_difference", found.difference),
        Data("faults", found.faults),
        Data("changed", found.changed),
    )
    return Document("", "a replay beside its run", (Section("", contents),), REPLAY_SCHEMA)


@dataclass(frozen=True)
class _Beside:
    """First harmonic of a channel: in phase and quadrature as recorded, and again."""

    channel: str
    in_phase: float
    quadrature: float
    in_phase_again: float
    quadrature_again: float


def _last_reading(found: Replay) -> Iterator[Table[_Beside]]:
    """Yield the last reading of both."""
    if not found.recorded_readings:
        return
    told, again = found.recorded_readings[-1], found.readings[-1]
    nine = written(".9g")
    columns = (
        word("channel", "channel"),
        number("in phase 1", "in_phase", nine),
        number("quadrature 1", "quadrature", nine),
        number("in phase 1 again", "in_phase_again", nine),
        number("quadrature 1 again", "quadrature_again", nine),
    )
    rows = [
        _Beside(channel, *_first(told, i), *_first(again, i))
        for i, channel in enumerate(told["channels"])
    ]
    name = f"Last reading: {told['periods']} periods to {told['closed_s']:.3f} s"
    yield Table(name, columns, rows, titled=True)


def _first(reading: Mapping[str, Any] | None, channel: int) -> tuple[float, float]:
    """Return a reading's first harmonic of a channel; NaN where there is no reading."""
    if reading is None:
        return float("nan"), float("nan")
    in_phase, quadrature = reading["coefficients"][channel][1:3]
    return in_phase, quadrature
