"""The one door to a run's recording: all that a campaign says of it, for every command alike."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from hardware.description.errors import ConfigurationError, DataError
from hardware.description.flags import Flag, Severity
from hardware.description.setpoint import SetPoint
from hardware.roles import Reading
from pmm.campaign.campaign import Campaign
from pmm.campaign.runs import AtRest, Run
from pmm.recorder.files import EVENTS, RECORDING
from pmm.recorder.line_shapes import read_lines
from pmm.remote import local_path

if TYPE_CHECKING:
    from analysis.readers import ColumnMap
    from analysis.readers.text_source import Progress
    from analysis.recording import Recording
    from pmm.campaign.calibration import Calibration

RAW = "none"  # readings stay as the gauges gave them
COMPLETE = "complete"
# Relative: a NetCDF file keeps a set-point as it was typed, and units for people cost a rounding.
_SAME = 1e-6
_WITHIN = 3.0  # standard uncertainties of a reading


@dataclass(frozen=True, eq=False)
class RecordingSource:
    """Where a recording lies, and what is known of it besides: plain values for any process.

    Attributes
    ----------
    path
        Of the recording, or of the copy of one that lies elsewhere (:func:`pmm.remote.local_path`).
    name
        Of the run; ``None`` leaves the file's own.
    set_point
        What the campaign says that the run was told to do; ``None`` leaves the recording's own.
    columns, sample_rate_hz
        How a file of another system is read; not for NetCDF.
    at_rest
        Whether the shaft stood: then no pulses are looked for, and where run control wrote when its
        gate was open, that part is the recording.
    outcome
        Of the run.
    differs
        What plan, rig, model and calibration say otherwise of other runs of its campaign.
    calibration
        In place of the one that the recording carries; :data:`RAW` for none at all.
    edges_file
        Times of the photocell's pulses; ``None`` leaves what the recording or its columns say.
    """

    path: Path
    name: str | None = None
    set_point: SetPoint | None = None
    columns: "ColumnMap | None" = None
    sample_rate_hz: float | None = None
    at_rest: bool = False
    outcome: str = COMPLETE
    differs: tuple[str, ...] = ()
    calibration: "Calibration | str | None" = None
    edges_file: Path | None = None

    @classmethod
    def of(cls, campaign: Campaign, run: Run | AtRest, folder: Path) -> "RecordingSource":
        """Return that of a campaign's run or record at rest.

        Parameters
        ----------
        folder
            Where the campaign file lies.
        """
        return cls(
            run.recording_path(folder),
            run.name,
            run.set_point if isinstance(run, Run) else None,
            campaign.columns,
            at_rest=isinstance(run, AtRest),
            outcome=run.outcome,
            differs=run.differs,
        )


def open_recording(
    source: RecordingSource, *, partial: bool = False, progress: "Progress" = lambda _: None
) -> "Recording":
    """Read a run's recording: columns, pulses, forces in newtons, gate and set-point as they are.

    Parameters
    ----------
    partial
        Whether a run that was stopped is wanted too.
    progress
        Told which part of a text file has been read, from 0 to 1.

    Raises
    ------
    DataError
        If the run is not complete, or as :func:`analysis.readers.read_recording` and
        :func:`pmm.campaign.calibrated_recording.calibrated` do.
    ConfigurationError
        If there is no such file, here or elsewhere, or a column map or sample rate that cannot be.
    """
    from analysis.readers import read_recording
    from analysis.readers.photocell import read_edges
    from pmm.recorder.file_changes import text_flags

    if source.outcome != COMPLETE and not partial:
        raise DataError(f"{source.name}: its outcome is {source.outcome!r}")
    source = replace(source, path=local_path(source.path))
    _check_there(source.path)
    recording = read_recording(
        source.path,
        _columns(source),
        sample_rate_hz=source.sample_rate_hz,
        progress=progress,
    )
    if source.path.name == RECORDING:
        flags = text_flags(source.path.parent)
        recording = replace(recording, flags=(*recording.flags, *flags))
    recording = _in_newtons(recording, source.calibration)
    if source.edges_file is not None:
        edges_file = local_path(source.edges_file)
        _check_there(edges_file)
        recording = replace(recording, photocell_edges_s=read_edges(edges_file))
    if source.at_rest:
        recording = replace(_gated(recording, source.path), photocell_edges_s=None)
    return _relabelled(recording, source)


def _columns(source: RecordingSource) -> "ColumnMap | None":
    from analysis.readers.reader import find_reader

    if source.columns is None or find_reader(source.path).own_channels:
        return None  # a column map is for the files of other systems
    # A shaft that stands gives no pulses: neither a column nor a file of them is asked for.
    return replace(source.columns, photocell=None) if source.at_rest else source.columns


def _in_newtons(recording: "Recording", calibration: "Calibration | str | None") -> "Recording":
    from pmm.campaign.calibrated_recording import calibrated

    return recording if isinstance(calibration, str) else calibrated(recording, calibration)


def _gated(recording: "Recording", path: Path) -> "Recording":
    """Return the part of a record at rest in which the gate was open, where that was written."""
    if not (path.parent / EVENTS).exists():
        return recording
    events, _ = read_lines(path.parent / EVENTS)
    times = {event["text"]: float(event["time_s"]) for event in events if event["kind"] == "state"}
    if not {"gate open", "hold"} <= set(times):
        return recording
    return recording.between(times["gate open"], times["hold"])


def _relabelled(recording: "Recording", source: RecordingSource) -> "Recording":
    """Return a recording under its run's name and set-point, flagged where its own is another."""
    recorded, stated = recording.set_point, source.set_point
    flags = (
        ()
        if recorded is None or stated is None
        else _differences(recorded, stated, _readings(recording))
    )
    return replace(
        recording,
        name=source.name or recording.name,
        set_point=recorded if stated is None else stated,
        flags=(*recording.flags, *flags, *_difference_note(source)),
    )


def _difference_note(source: RecordingSource) -> tuple[Flag, ...]:
    """Say what a run was recorded with that others of its campaign were not."""
    if not source.differs:
        return ()
    text = f"recorded with other values, which are taken for it: {'; '.join(source.differs)}"
    return (Flag("recorded_otherwise", Severity.NOTE, text),)


def _readings(recording: "Recording") -> dict[str, Reading]:
    """Return where the axes stood as run control read them, which its campaign states."""
    tables = json.loads(recording.provenance.get("readings", "{}"))
    return {axis: Reading(**table) for axis, table in tables.items()}


def _differences(
    recorded: SetPoint, stated: SetPoint, readings: Mapping[str, Reading]
) -> tuple[Flag, ...]:
    """Say where a recording was made with another set-point than its campaign states."""
    e = readings.get("eccentricity", Reading(recorded.eccentricity_m, 0.0, ""))
    phase = readings.get("phase", Reading(recorded.strut_phase_rad, 0.0, ""))
    pairs = (
        ("frequency", "Hz", recorded.frequency_hz, stated.frequency_hz, 0.0),
        ("eccentricity", "m", e.value, stated.eccentricity_m, e.standard_uncertainty),
        ("strut phase", "rad", phase.value, stated.strut_phase_rad, phase.standard_uncertainty),
        ("carriage speed", "m/s", recorded.carriage_speed_m_s, stated.carriage_speed_m_s, 0.0),
        ("drift", "rad", recorded.drift_rad, stated.drift_rad, 0.0),
        ("rudder angle", "rad", recorded.rudder_angle_rad, stated.rudder_angle_rad, 0.0),
        ("revolutions", "Hz", recorded.revolutions_hz, stated.revolutions_hz, 0.0),
        ("heel", "rad", recorded.heel_rad, stated.heel_rad, 0.0),
        ("rate of turn", "rad/s", recorded.turn_rate_rad_s, stated.turn_rate_rad_s, 0.0),
        ("release", "rad", recorded.release_rad, stated.release_rad, 0.0),
        ("waves", "Hz", recorded.wave_frequency_hz, stated.wave_frequency_hz, 0.0),
    )
    differences = [
        f"{quantity} {recorded_value:.6g} {unit}, the campaign says {stated_value:.6g} {unit}"
        for quantity, unit, recorded_value, stated_value, u in pairs
        if abs(recorded_value - stated_value)
        > max(_SAME * max(abs(recorded_value), abs(stated_value)), _WITHIN * u)
    ]
    if recorded.medium is not stated.medium:
        differences.append(f"medium {recorded.medium}, the campaign says {stated.medium}")
    if not differences:
        return ()
    text = (
        f"recorded with {'; '.join(differences)}: is this the recording of that run? The "
        "campaign's set-point is used"
    )
    return (Flag("set_point_differs", Severity.WARNING, text),)


def _check_there(path: Path) -> None:
    if not path.exists():
        kind = "file" if path.suffix else "file or folder"
        raise ConfigurationError(f"{path}: no such {kind}")
