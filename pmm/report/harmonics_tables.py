"""Tables of harmonics: those of each gate, of the modes of 1963, and of many runs in one."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from operator import attrgetter
from types import MappingProxyType
from typing import Final

from hardware.description.flags import Flag
from pmm.document.content import Column, Content, Notes, Table, number, word
from pmm.document.flag_lines import flag_notes
from pmm.document.labels import display, plain
from pmm.document.notation import counted, is_open, rounded, written
from pmm.harmonics.classic_rows import ClassicRow
from pmm.harmonics.rows import ChannelRows, GateRows, HarmonicRow, RunRows, Value, floored

# Code of a flag -> the options of ``pmm analyse`` that act on it.
FLAG_OPTIONS: Final[Mapping[str, str]] = MappingProxyType({
    "few_reference_periods": "--reference, --frequency",
    "frequency_differs": "--frequency, --reference",
    "no_interval": "--periods, --gate",
    "not_steady": "--channel, --steady-tolerance, --opens-at",
    "reference_gap": "--reference, --frequency",
    "stretch_limited": "--channel, --steady-tolerance",
    "time_unit_assumed": "--column or --map",
    "transient": "--opens-at, --periods, --gate",
})  # fmt: skip
_OPEN: Final = "open: the interval of that phase is wider than ± 90 degrees, or nothing is there."


@dataclass(frozen=True)
class _Row:
    """A line of a channel: a harmonic, its mean or its drift; the latter two are no phasors."""

    run: str
    channel: str
    n: str
    in_phase: str
    quadrature: str = ""
    amplitude: str = ""
    phase: str = ""
    faint: bool = False


_COLUMNS: Final[tuple[Column[_Row], ...]] = (
    Column("channel", lambda row: row.channel, once=True),
    number("n", "n"),
    number("in phase", "in_phase"),
    number("quadrature", "quadrature"),
    number("amplitude", "amplitude"),
    number("phase", "phase", unit="deg"),
)


def noticed(flags: Sequence[Flag]) -> Notes:
    """Return flags as notes, with the options that act on them."""
    return Notes(flag_notes(flags, FLAG_OPTIONS))


def gate_tables(rows: RunRows, level: float) -> Iterator[Content]:
    """Yield the table of each gate, loads first, and what was noticed of it."""
    apart = len({tuple(channel.name for channel in gate.channels) for gate in rows.gates}) > 1
    for gate in rows.gates:
        names = f", {', '.join(plain(channel.name) for channel in gate.channels)}" if apart else ""
        where = (
            f"Gate {gate.number} of {gate.count}{names}: {counted(gate.periods, 'period')} from "
            f"{gate.opened_s:.3f} s to {gate.closed_s:.3f} s, {gate.frequency_hz:.6g} Hz"
        )
        harmonics = [row for channel in gate.channels for row in _channel_rows(channel)]
        notes = (
            _rests_on(gate, level),
            *((_OPEN,) if any(row.phase == "open" for row in harmonics) else ()),
        )
        yield Table(where, _COLUMNS, harmonics, titled=True, notes=notes,
                    grade=lambda row: "faint" if row.faint else "")  # fmt: skip
        yield noticed(gate.flags)


def _rests_on(gate: GateRows, level: float) -> str:
    source, drift = gate.interval_source, gate.drift_source
    intervals = (
        f"No intervals{source.removeprefix('none')}."
        if source.startswith("none")
        else f"{100.0 * level:g} % intervals from the {source}."
    )
    taken = f"Drift {drift if drift.startswith('not') else f'taken out by {drift}'}."
    return f"{intervals} {taken} Estimator: {gate.estimator}."


def _channel_rows(channel: ChannelRows, run: str = "") -> Iterator[_Row]:
    """Yield a channel's mean, its drift if there is one, and its harmonics."""
    unit = display(channel.unit)
    name = f"{plain(channel.name)} [{unit.label}]"

    def value_text(value: Value) -> str:
        return rounded(
            *floored(value.value * unit.factor, value.half_width * unit.factor,
                     channel.size * unit.factor)
        )  # fmt: skip

    yield _Row(run, name, "mean", value_text(channel.mean))
    if channel.drift_per_s:
        slope, _ = floored(channel.drift_per_s, 0.0, channel.size)
        yield _Row(run, name, "drift per s", rounded(slope * unit.factor, math.nan))
    for row in channel.harmonics:
        amplitude, _ = floored(row.amplitude.value, row.amplitude.half_width, channel.size)
        in_phase, quadrature, size = map(value_text, (row.in_phase, row.quadrature, row.amplitude))
        faint = not (row.is_significant and amplitude)
        yield _Row(
            run, name, str(row.order), in_phase, quadrature, size, _phase(row, amplitude), faint
        )


def _phase(row: HarmonicRow, amplitude: float) -> str:
    phase = row.phase_deg
    if is_open(phase.half_width, amplitude):
        return "open"
    return rounded(*floored(phase.value, phase.half_width, 180.0))


def classic_tables(rows: Sequence[ClassicRow]) -> Iterator[Content]:
    """Yield what each mode of 1963 reads in the first gate's window, a table for each channel."""
    five = written(".5g")
    for name, group in groupby(rows, attrgetter("channel")):
        mode_rows = list(group)
        parts: tuple[Column[ClassicRow], ...] = tuple(
            Column(f"{part} {k // 2 + 1}", lambda row, k=k: five(row.parts[k]), number=True)  # type: ignore[misc]
            for k in range(len(mode_rows[0].parts))
            for part in (("in phase", "quadrature")[k % 2],)
        )
        yield Table(f"{name} [{mode_rows[0].unit}] by mode", (word("mode", "mode"), *parts),
                    mode_rows, titled=True)  # fmt: skip


def first_harmonics_table(runs: Sequence[RunRows], channels: Sequence[str]) -> Table[_Row]:
    """Return the first harmonic of some channels of each run, and higher ones that are no noise."""
    rows = [
        row
        for run in runs
        for channel in run.gates[0].channels
        if channel.name in channels
        for row in _channel_rows(channel, run.run)
        if row.n == "1" or (row.n.isdigit() and not row.faint)
    ]
    run: Column[_Row] = Column("run", lambda row: row.run, once=True)
    return Table("First harmonics", (run, *_COLUMNS), rows)
