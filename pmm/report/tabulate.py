"""What a page says about an analysis, as plain text in rows."""

import platform
from dataclasses import dataclass, fields
from importlib.metadata import PackageNotFoundError, version

import numpy as np

from analysis.resolver.analyse import Analysis
from analysis.resolver.harmonics import Harmonics
from hardware.description.flags import Flag
from pmm.report.gated import caption
from pmm.report.labels import display, loads_first, plain
from pmm.report.rounding import rounded, rounded_phase

_PACKAGES = ("pmm", "numpy", "scipy", "matplotlib")


@dataclass(frozen=True)
class Row:
    """One harmonic of one channel; harmonic 0 is the mean, which has no phasor."""

    channel: str
    unit: str
    harmonic: int
    in_phase: str
    quadrature: str
    amplitude: str
    phase_deg: str


@dataclass(frozen=True)
class GateTable:
    """The harmonics of one gate, each value with its 95 % interval."""

    caption: str
    notes: tuple[str, ...]
    rows: tuple[Row, ...]
    flags: tuple[Flag, ...]


def gate_table(analysis: Analysis, reading: Harmonics) -> GateTable:
    """Return the table of one reading, loads first."""
    order = loads_first(analysis.recording)
    notes = (
        f"95 % intervals from: {reading.interval_source}.",
        f"Drift from: {reading.drift_source}.",
        f"Estimator: {reading.estimator}.",
    )
    rows = tuple(row for channel in order for row in _channel_rows(reading, channel))
    return GateTable(caption(reading), notes, rows, reading.flags)


def _channel_rows(reading: Harmonics, channel: int) -> list[Row]:
    shown, name = display(reading.units[channel]), plain(reading.channel_names[channel])
    values = reading.coefficients[channel] * shown.factor
    half = reading.half_width()[channel] * shown.factor
    factors = reading.coverage_factor()[1::2]
    along, sideways = (part[channel] * factors for part in reading.polar_uncertainty())
    rows = [Row(name, shown.label, 0, rounded(values[0], half[0]), "", "", "")]
    for n in range(reading.order):
        s, c = 2 * n + 1, 2 * n + 2
        rows.append(
            Row(
                name,
                shown.label,
                n + 1,
                rounded(values[s], half[s]),
                rounded(values[c], half[c]),
                rounded(reading.amplitude[channel, n] * shown.factor, along[n] * shown.factor),
                rounded_phase(
                    float(np.degrees(reading.phase_rad[channel, n])), float(np.degrees(sideways[n]))
                ),
            )
        )
    return rows


def provenance(analysis: Analysis) -> list[tuple[str, str]]:
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
            "steady stretch",
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


def versions() -> list[tuple[str, str]]:
    """Return the versions of what made the numbers."""
    return [("Python", platform.python_version()), *((name, _version(name)) for name in _PACKAGES)]


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return "not installed, run from its sources"
