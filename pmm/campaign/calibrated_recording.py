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


def provenance_of(one: Calibration | None) -> dict[str, str]:
    """Return what a recording's provenance keeps of a calibration; nothing where there is none."""
    if one is None:
        return {}
    return {CARRIED: json.dumps({"file": one.file, "sha256": one.sha256} | as_table(one))}


def carried(recording: Recording) -> Calibration | None:
    """Return the calibration that a recording carries and that is not applied yet.

    Raises
    ------
    DataError
        If what it carries cannot be read.
    """
    return _kept(recording, CARRIED)


def applied(recording: Recording) -> Calibration | None:
    """Return the calibration that made a recording's readings forces, if one did.

    It raises what :func:`carried` raises.
    """
    return _kept(recording, APPLIED)


def _kept(recording: Recording, key: str) -> Calibration | None:
    text = recording.provenance.get(key)
    if text is None:
        return None
    try:
        table = dict(json.loads(text))
        found = from_table(table, f"{recording.name}: calibration in the provenance")
        return replace(found, file=str(table["file"]), sha256=str(table["sha256"]))
    except (ValueError, KeyError, TypeError, AttributeError, ConfigurationError) as error:
        raise DataError(f"{recording.name}: its calibration cannot be read: {error}") from error


def calibrated(recording: Recording, given: Calibration | None = None) -> Recording:
    """Return a recording with forces in place of readings.

    Parameters
    ----------
    given
        In place of the calibration that the recording carries; without either it stays as it is.

    Raises
    ------
    DataError
        If a calibrated channel is not in the recording, or one was applied to it before.
    """
    one = carried(recording) if given is None else given
    if one is None:
        return recording
    if APPLIED in recording.provenance:
        raise DataError(
            f"{recording.name}: a calibration was applied to it already; apply another one to the "
            "recording that pmm run made"
        )
    rows = tuple(_row(recording, name, one) for name in one.channels)
    kept = {key: text for key, text in recording.provenance.items() if key != CARRIED}
    channels = tuple(
        replace(channel, full_scale=None) if row in rows else channel
        for row, channel in enumerate(recording.channels)
    )
    return replace(
        recording,
        channels=channels,
        samples=_Forces(recording.samples, rows, np.asarray(np.linalg.inv(one.matrix), float)),
        provenance=kept | {APPLIED: provenance_of(one)[CARRIED]},
        flags=(
            *recording.flags,
            _told(one),
            *_saturated(recording, rows),
            *_expired(recording, one),
        ),
    )


def expiry_text(one: Calibration, on: date) -> str:
    """Return in words that a calibration had expired by a date, and what to do."""
    return (
        f"the calibration {one.file or 'of the gauges'}, made on {one.made}, expired on "
        f"{one.expires}, {(on - one.expires).days} days before {on}; hang the check weights again "
        "and let `pmm evaluate` write a new one"
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
        chosen, when = key
        wanted = list(range(self.shape[0])[chosen]) if isinstance(chosen, slice) else list(chosen)
        mixed = self.rows if any(row in self.rows for row in wanted) else ()
        place = {row: i for i, row in enumerate(sorted({*wanted, *mixed}))}
        read = self.source[list(place), when]
        found = np.array(read[[place[row] for row in wanted]])
        if mixed:
            forces = self.inverse @ read[[place[row] for row in mixed]]
            for i, row in enumerate(wanted):
                if row in mixed:
                    found[i] = forces[mixed.index(row)]
        return found


def _row(recording: Recording, name: str, one: Calibration) -> int:
    if name in recording.channel_names:
        return recording.channel_names.index(name)
    raise DataError(
        f"{recording.name}: no channel {name!r}, but the calibration {one.file} was made of "
        f"{', '.join(one.channels)}: without it their cross-talk cannot be taken out"
    )


def _told(one: Calibration) -> Flag:
    message = (
        f"readings of {', '.join(one.channels)} made newtons by {one.file or 'a calibration'} of "
        f"{one.made}, good until {one.expires}"
    )
    return Flag("calibrated", Severity.NOTE, message)


def _saturated(recording: Recording, rows: Sequence[int]) -> Iterator[Flag]:
    """Yield a flag for each gauge whose reading, not its force, reached the end of the range."""
    known = {flag.channel for flag in recording.flags if flag.code == "saturated"}
    for row in rows:
        channel = recording.channels[row]
        if channel.full_scale is None or channel.name in known:
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


def _expired(recording: Recording, one: Calibration) -> Iterator[Flag]:
    made = _date_of(recording.provenance)
    if made is not None and one.is_expired(made):
        yield Flag("calibration_expired", Severity.WARNING, expiry_text(one, made))


def _date_of(provenance: Mapping[str, str]) -> date | None:
    """Return the day on which a run was made; ``None`` where nothing says."""
    try:
        return datetime.fromisoformat(provenance.get("started_utc", "")).date()
    except ValueError:
        return None
