"""Applies a calibration to a recording: readings become forces.

A recording keeps the readings as they came, and beside them, as ``calibration`` in its provenance,
what was known of the gauges when it was made. The matrix is applied when a recording is analysed;
``calibration_applied`` says so then, so that it is not applied twice.
"""

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import date, datetime
from typing import Final

import numpy as np

from analysis.recording import Recording, Samples
from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError, DataError
from hardware.description.flags import Flag, Severity
from pmm.campaign.calibration import Calibration, as_table, from_table

CARRIED: Final = "calibration"
APPLIED: Final = "calibration_applied"
_AT_ONCE: Final = 200_000  # samples
_ROUNDED: Final = 1.0 - 1e-9  # of the full scale


def provenance_of(calibration: Calibration | None) -> dict[str, str]:
    """Return what a recording's provenance keeps of a calibration; nothing where there is none."""
    if calibration is None:
        return {}
    return {
        CARRIED: json.dumps(
            {"file": calibration.file, "sha256": calibration.sha256} | as_table(calibration)
        )
    }


def carried_calibration(recording: Recording) -> Calibration | None:
    """Return the calibration that a recording carries and that is not applied yet.

    Raises
    ------
    DataError
        If what it carries cannot be read.
    """
    return _stored_calibration(recording, CARRIED)


def applied_calibration(recording: Recording) -> Calibration | None:
    """Return the calibration that made a recording's readings forces, if one did.

    It raises what :func:`carried_calibration` raises.
    """
    return _stored_calibration(recording, APPLIED)


def _stored_calibration(recording: Recording, key: str) -> Calibration | None:
    text = recording.provenance.get(key)
    if text is None:
        return None
    try:
        table = dict(json.loads(text))
        calibration = from_table(table, f"{recording.name}: calibration in the provenance")
        return replace(calibration, file=str(table["file"]), sha256=str(table["sha256"]))
    except (ValueError, KeyError, TypeError, AttributeError, ConfigurationError) as error:
        raise DataError(f"{recording.name}: its calibration cannot be read: {error}") from error


def calibrated(recording: Recording, replacement: Calibration | None = None) -> Recording:
    """Return a recording with forces in place of readings.

    Parameters
    ----------
    replacement
        In place of the calibration that the recording carries; without either it stays as it is.

    Raises
    ------
    DataError
        If a calibrated channel is not in the recording, or one was applied to it before.
    """
    calibration = carried_calibration(recording) if replacement is None else replacement
    if calibration is None:
        return recording
    if APPLIED in recording.provenance:
        raise DataError(
            f"{recording.name}: a calibration was applied to it already; apply another one to the "
            "recording that pmm run made"
        )
    rows = tuple(_row(recording, name, calibration) for name in calibration.channels)
    provenance = {key: text for key, text in recording.provenance.items() if key != CARRIED}
    channels = tuple(
        replace(channel, full_scale=None) if row in rows else channel
        for row, channel in enumerate(recording.channels)
    )
    return replace(
        recording,
        channels=channels,
        samples=_Forces(
            recording.samples, rows, np.asarray(np.linalg.inv(calibration.matrix), float)
        ),
        provenance=provenance | {APPLIED: provenance_of(calibration)[CARRIED]},
        flags=(
            *recording.flags,
            _calibration_flag(calibration),
            *_saturated(recording, rows),
            *_expired(recording, calibration),
        ),
    )


def expiry_text(calibration: Calibration, on: date) -> str:
    """Return in words that a calibration had expired by a date, and what to do."""
    return (
        f"the calibration {calibration.file or 'of the gauges'}, made on {calibration.made}, "
        f"expired on {calibration.expires}, {(on - calibration.expires).days} days before {on}; "
        "hang the check weights again and let `pmm evaluate` write a new one"
    )


@dataclass(frozen=True)
class _Forces:
    """Samples of which some rows are the loads behind the readings, read only when asked for."""

    source: Samples
    rows: tuple[int, ...]
    inverse: FloatArray

    @property
    def shape(self) -> tuple[int, ...]:
        return self.source.shape

    def __getitem__(self, key: tuple[slice | Sequence[int], slice], /) -> FloatArray:
        row_key, span = key
        row_numbers = (
            list(range(self.shape[0])[row_key]) if isinstance(row_key, slice) else list(row_key)
        )
        mixed_rows = self.rows if any(row in self.rows for row in row_numbers) else ()
        place = {row: i for i, row in enumerate(sorted({*row_numbers, *mixed_rows}))}
        readings = self.source[list(place), span]
        samples = np.array(readings[[place[row] for row in row_numbers]])
        if mixed_rows:
            forces = self.inverse @ readings[[place[row] for row in mixed_rows]]
            for i, row in enumerate(row_numbers):
                if row in mixed_rows:
                    samples[i] = forces[mixed_rows.index(row)]
        return samples


def _row(recording: Recording, name: str, calibration: Calibration) -> int:
    if name in recording.channel_names:
        return recording.channel_names.index(name)
    raise DataError(
        f"{recording.name}: no channel {name!r}, but the calibration {calibration.file} was made "
        f"of {', '.join(calibration.channels)}: without it their cross-talk cannot be taken out"
    )


def _calibration_flag(calibration: Calibration) -> Flag:
    message = (
        f"readings of {', '.join(calibration.channels)} made newtons by "
        f"{calibration.file or 'a calibration'} of {calibration.made}, good until "
        f"{calibration.expires}"
    )
    return Flag("calibrated", Severity.NOTE, message)


def _saturated(recording: Recording, rows: Sequence[int]) -> Iterator[Flag]:
    """Yield a flag for each gauge whose reading, not its force, reached the end of the range."""
    flagged_channels = {flag.channel for flag in recording.flags if flag.code == "saturated"}
    for row in rows:
        channel = recording.channels[row]
        if channel.full_scale is None or channel.name in flagged_channels:
            continue
        limit, count = channel.full_scale, 0
        for start in range(0, recording.sample_count, _AT_ONCE):
            part = recording.samples[[row], start : start + _AT_ONCE]
            count += int(np.count_nonzero(np.abs(part) >= limit * _ROUNDED))
        if count:
            message = (
                f"{count} readings stand at the full scale of {limit:g} {channel.unit}; the "
                "harmonics are those of the clipped signal"
            )
            yield Flag("saturated", Severity.VOID, message, channel.name)


def _expired(recording: Recording, calibration: Calibration) -> Iterator[Flag]:
    recorded_on = _date_of(recording.provenance)
    if recorded_on is not None and calibration.is_expired(recorded_on):
        yield Flag("calibration_expired", Severity.WARNING, expiry_text(calibration, recorded_on))


def _date_of(provenance: Mapping[str, str]) -> date | None:
    """Return the day on which a run was made; ``None`` where nothing says."""
    try:
        return datetime.fromisoformat(provenance.get("started_utc", "")).date()
    except ValueError:
        return None
