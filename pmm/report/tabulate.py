"""What a page says about an analysis, as plain text in rows."""

import platform
from dataclasses import dataclass, fields

import numpy as np

from analysis.resolver.analysis import Analysis
from analysis.resolver.harmonics import Harmonics
from hardware.description.version import version_of
from pmm.document.flag_lines import FlagLine, flag_lines
from pmm.document.labels import display, loads_first, plain
from pmm.document.notation import rounded, rounded_phase
from pmm.report.gated import caption
from pmm.tables import floored, window_kind

# What a window is called by how it was come by.
WINDOWS = {
    "found steady": "steady stretch",
    "given": "window given",
    "run's gate": "the run's own gate",
    "not steady": "all periods, not steady",
}
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
    flags: tuple[FlagLine, ...]


def gate_table(analysis: Analysis, reading: Harmonics) -> GateTable:
    """Return the table of one reading, loads first."""
    order = loads_first(analysis.recording)
    source = str(reading.interval_source)
    notes = (
        f"No intervals{source.removeprefix('none')}."
        if source.startswith("none")
        else f"95 % intervals from the {source}.",
        f"Drift from: {reading.drift_source}.",
        f"Estimator: {reading.estimator}.",
    )
    rows = tuple(row for channel in order for row in _channel_rows(reading, channel))
    return GateTable(caption(reading), notes, rows, flag_lines(reading.flags))


def _channel_rows(reading: Harmonics, channel: int) -> list[Row]:
    shown, name = display(reading.units[channel]), plain(reading.channel_names[channel])
    values = reading.coefficients[channel] * shown.factor
    half = reading.half_width()[channel] * shown.factor
    factors = reading.coverage_factor()[1::2]
    along, sideways = (part[channel] * factors for part in reading.polar_uncertainty())
    amplitude = reading.amplitude[channel] * shown.factor
    size = float(max(abs(values[0]), amplitude.max()))

    def told(value: float, half_width: float) -> str:
        return rounded(*floored(float(value), float(half_width), size))

    rows = [Row(name, shown.label, 0, told(values[0], half[0]), "", "", "")]
    for n in range(reading.order):
        s, c = 2 * n + 1, 2 * n + 2
        rows.append(
            Row(
                name,
                shown.label,
                n + 1,
                told(values[s], half[s]),
                told(values[c], half[c]),
                told(amplitude[n], along[n] * shown.factor),
                rounded_phase(
                    float(np.degrees(reading.phase_rad[channel, n])),
                    float(np.degrees(sideways[n])),
                    floored(float(amplitude[n]), 0.0, size)[0],
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


def versions() -> list[tuple[str, str]]:
    """Return the versions of what made the numbers."""
    return [
        ("Python", platform.python_version()),
        *((name, version_of(name)) for name in _PACKAGES),
    ]
