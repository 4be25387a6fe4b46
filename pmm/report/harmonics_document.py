"""What a page says about analyses: per recording what was noticed, a table per gate, figures."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields, replace
from typing import Final

import numpy as np

from analysis.resolver.analysis import Analysis
from analysis.resolver.harmonics import Harmonics
from pmm.document.content import (
    Column,
    Content,
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
from pmm.document.labels import display, loads_first, plain
from pmm.document.notation import rounded, rounded_phase
from pmm.document.run_rows import floored, window_kind
from pmm.report.gate_fit import WINDOWS, caption
from pmm.report.plots import figures

_INTRODUCTION: Final = (
    "Each recording is resolved into its mean and harmonics over whole periods of the motion, each "
    "value with its 95 % interval. For every run there are what was noticed, a table per gate, the "
    "record with its gate, the harmonics as phasors, the spectrum, and where it all comes from."
)
_READING: Final = (
    "In phase and quadrature go with the sine and the cosine of the reference's phase; amplitude "
    "and phase are those of A sin(nθ + φ). An interval holds the value with 95 % confidence, each "
    "number for itself; the regions in the figures hold both parts of a phasor at once and are "
    "wider. A phase is open where its interval is wider than ± 90 degrees, or where nothing is "
    "there. Lengths are in mm and angles in degrees, here as in the tables of pmm analyse; its "
    "JSON is in SI."
)


@dataclass(frozen=True)
class _Row:
    """One harmonic of one channel, or its mean, which has no phasor."""

    channel: str
    unit: str
    harmonic: str
    in_phase: str
    quadrature: str = ""
    amplitude: str = ""
    phase: str = ""


_COLUMNS: Final[tuple[Column[_Row], ...]] = (
    word("channel", "channel"),
    word("unit", "unit"),
    word("harmonic", "harmonic"),
    number("in phase", "in_phase"),
    number("quadrature", "quadrature"),
    number("amplitude", "amplitude"),
    number("phase", "phase", unit="deg"),
)


def harmonics_document(analyses: Sequence[Analysis], name: str) -> Document:
    """Return what is said about analyses: figures of each first gate, tables of all gates."""
    sections = [_section(one, f"run{k}") for k, one in enumerate(analyses, start=1)]
    first = Section("", (Text((_INTRODUCTION,)),))
    last = Section("How to read the numbers", (Text((_READING,), faint=True),))
    return Document(name, "harmonics", (first, *sections, last), "")


def _section(analysis: Analysis, anchor: str) -> Section:
    count = len(analysis.readings)
    drawn = (replace(one, name=f"{anchor}-{one.name}") for one in figures(analysis))
    return Section(
        plain(analysis.recording.name),
        (
            Notes(flag_notes(analysis.flags)),
            *(one for k in range(count) for one in _gate(analysis, k)),
            Text(("The figures show gate 1.",) if count > 1 else (), faint=True),
            *drawn,
            pairs("Where it comes from", dict(_provenance(analysis)), titled=True),
        ),
    )


def _gate(analysis: Analysis, place: int) -> Iterator[Content]:
    """Yield the table of one reading, loads first, and what was noticed of it."""
    reading, count = analysis.readings[place], len(analysis.readings)
    said, source = caption(reading), str(reading.interval_source)
    notes = (
        f"No intervals{source.removeprefix('none')}."
        if source.startswith("none")
        else f"95 % intervals from the {source}.",
        f"Drift from: {reading.drift_source}.",
        f"Estimator: {reading.estimator}.",
    )
    order = loads_first(analysis.recording)
    rows = [row for channel in order for row in _channel_rows(reading, channel)]
    title = f"Gate {place + 1} of {count}: {said}" if count > 1 else said[0].upper() + said[1:]
    yield Table(title, _COLUMNS, rows, titled=True, notes=(" ".join(notes),))
    yield Notes(flag_notes(reading.flags))


def _channel_rows(reading: Harmonics, channel: int) -> Iterator[_Row]:
    shown = display(reading.units[channel])
    values = reading.coefficients[channel] * shown.factor
    half = reading.half_width()[channel] * shown.factor
    factors = reading.coverage_factor()[1::2]
    along, sideways = (part[channel] * factors for part in reading.polar_uncertainty())
    amplitude = reading.amplitude[channel] * shown.factor
    size = float(max(abs(values[0]), amplitude.max()))

    def told(value: float, half_width: float) -> str:
        return rounded(*floored(float(value), float(half_width), size))

    name = plain(reading.channel_names[channel])
    yield _Row(name, shown.label, "mean", told(values[0], half[0]))
    for n in range(reading.order):
        s, c = 2 * n + 1, 2 * n + 2
        phase = rounded_phase(
            float(np.degrees(reading.phase_rad[channel, n])),
            float(np.degrees(sideways[n])),
            floored(float(amplitude[n]), 0.0, size)[0],
        )
        yield _Row(
            "",
            shown.label,
            str(n + 1),
            told(values[s], half[s]),
            told(values[c], half[c]),
            told(amplitude[n], along[n] * shown.factor),
            phase,
        )


def _provenance(analysis: Analysis) -> list[tuple[str, str]]:
    """Return where an analysis comes from: the recording, the reference and the settings."""
    recording, reference = analysis.recording, analysis.reference
    told = [
        ("recording", recording.name),
        (
            "samples",
            f"{recording.sample_count} at {recording.sample_rate_hz:g} Hz, "
            f"{recording.start_s:.3f} s to {recording.end_s:.3f} s",
        ),
        ("reference", f"{reference.source}, {reference.frequency_hz:.6g} Hz"),
        (
            WINDOWS[window_kind(analysis)],
            f"{analysis.stretch.period_count} of {analysis.sums.period_count} whole periods",
        ),
    ]
    point = recording.set_point
    if point is not None:
        told += [(f"set-point, {one.name}", str(getattr(point, one.name))) for one in fields(point)]
    told += [(f"recording, {key}", str(value)) for key, value in recording.provenance.items()]
    settings = analysis.settings
    return told + [
        (f"setting, {one.name}", _plain(getattr(settings, one.name))) for one in fields(settings)
    ]


def _plain(value: object) -> str:
    if isinstance(value, tuple):
        return ", ".join(map(str, value)) or "all"
    if isinstance(value, bool):
        return "yes" if value else "no"
    return "not given" if value is None else str(value)
