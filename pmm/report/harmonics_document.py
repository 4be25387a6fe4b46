"""What is said of resolved recordings, on a terminal, on a page and to programs."""

from collections.abc import Sequence
from dataclasses import fields, replace
from pathlib import Path
from typing import Final

from analysis.resolver.analysis import Analysis
from hardware.description.flags import Flag
from pmm.document.content import Data, Document, Section, Text, pairs
from pmm.document.labels import plain
from pmm.document.notation import counted
from pmm.harmonics.resolving import Failure
from pmm.harmonics.rows import RunRows, run_rows, window_kind
from pmm.report.gate import WINDOWS
from pmm.report.harmonics_tables import classic_tables, gate_tables, noticed
from pmm.report.plots import figures
from pmm.report.response_tables import response_tables

SCHEMA: Final = "pmm-analysis-1"
PAGE_LEVEL: Final = 0.95
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


def analysis_document(
    runs: Sequence[RunRows],
    failed: Sequence[Failure],
    not_recorded: Sequence[Path],
    doubts: Sequence[tuple[Path, tuple[Flag, ...]]],
    level: float,
) -> Document:
    """Return what ``pmm analyse`` shows; ``docs/campaigns.md`` describes the keys.

    Parameters
    ----------
    not_recorded
        Where the recordings of a campaign's other runs would lie.
    doubts
        Of campaigns: what looks wrong in all their runs.
    level
        Probability of the intervals.
    """
    data = (
        Data("level", level),
        Data("runs", runs),
        Data("campaigns", [{"file": path, "flags": flags} for path, flags in doubts]),
        Data("not_recorded", not_recorded),
        Data("failed", [
            {"file": failure.file, "message": failure.message, "flags": failure.flags}
            for failure in failed
        ]),
    )  # fmt: skip
    sections = (
        *(run_section(run, level) for run in runs),
        *(doubt_section(path, flags) for path, flags in doubts),
        Section("", data),
    )
    return Document("", "harmonics", sections, SCHEMA)


def doubt_section(path: Path, flags: Sequence[Flag]) -> Section:
    """Return what looks wrong in all runs of a campaign."""
    return Section(f"all runs of {path}", (noticed(flags),))


def run_section(rows: RunRows, level: float) -> Section:
    """Return what was found in a recording, its intervals of some probability."""
    channel = f" {rows.reference_channel}" if rows.reference_channel else ""
    steady = (
        ", where each part of a first harmonic keeps within "
        f"{100.0 * rows.steady_tolerance:g} % of the usual amplitude about its middle"
    )
    about = {
        "recording": f"{rows.samples} samples, {rows.sample_rate_hz:.6g} Hz, "
        f"{rows.duration_s:.6g} s",
        "reference": f"{rows.reference}{channel}, {rows.reference_frequency_hz:.6g} Hz",
        "window": f"{rows.window}, {counted(rows.window_periods, 'period')} from "
        f"{rows.window_opened_s:.3f} s to {rows.window_closed_s:.3f} s"
        + (steady if rows.window == "found steady" else ""),
    }
    vibrations = [
        f"lets through of a vibration at {vibration.frequency_hz:g} Hz: "
        + ", ".join(
            f"{100.0 * part:.2g} % into n = {n}" for n, part in enumerate(vibration.parts, 1)
        )
        for vibration in rows.let_through
    ]
    return Section(
        rows.file,
        (
            pairs("Recording", about),
            *gate_tables(rows, level),
            Text(vibrations),
            *classic_tables(rows.classic),
            *response_tables(rows.response),
            noticed(rows.flags),
        ),
    )


def harmonics_document(analyses: Sequence[Analysis], name: str) -> Document:
    """Return what a page says of analyses: tables of all gates, figures of each first one."""
    sections = [_page_section(analyse, f"run{k}") for k, analyse in enumerate(analyses, start=1)]
    first = Section("", (Text((_INTRODUCTION,)),))
    last = Section("How to read the numbers", (Text((_READING,), faint=True),))
    return Document(name, "harmonics", (first, *sections, last), "")


def _page_section(analysis: Analysis, anchor: str) -> Section:
    rows = run_rows((analysis,), file=analysis.recording.name, level=PAGE_LEVEL)
    drawn = (replace(figure, name=f"{anchor}-{figure.name}") for figure in figures(analysis))
    return Section(
        plain(analysis.recording.name),
        (
            noticed(analysis.flags),
            *gate_tables(rows, PAGE_LEVEL),
            Text(("The figures show gate 1.",) if len(rows.gates) > 1 else (), faint=True),
            *drawn,
            pairs("Where it comes from", dict(_provenance(analysis)), titled=True),
        ),
    )


def _provenance(analysis: Analysis) -> list[tuple[str, str]]:
    """Return where an analysis comes from: the recording, the reference and the settings."""
    recording, reference = analysis.recording, analysis.reference
    rows = [
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
        rows += [
            (f"set-point, {field.name}", str(getattr(point, field.name))) for field in fields(point)
        ]
    rows += [(f"recording, {key}", str(value)) for key, value in recording.provenance.items()]
    settings = analysis.settings
    return rows + [
        (f"setting, {field.name}", _plain(getattr(settings, field.name)))
        for field in fields(settings)
    ]


def _plain(value: object) -> str:
    if isinstance(value, tuple):
        return ", ".join(map(str, value)) or "all"
    if isinstance(value, bool):
        return "yes" if value else "no"
    return "not given" if value is None else str(value)
