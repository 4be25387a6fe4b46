"""What the recordings of another system seem to hold: which column is what, and the set-points."""

import math
import os
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from analysis.readers import read_recording
from analysis.readers.reader import find_reader
from hardware.description.channels import CARRIAGE_SPEED, DISPLACEMENTS, FORCES, SHAFT_ANGLE
from hardware.description.kinds import RunKind
from hardware.description.setpoint import SetPoint
from pmm.start import words
from pmm.start.behaviour import RecordingBehaviour, at_rest, watch
from pmm.start.channels import as_columns, by_order_of_names
from pmm.start.found_campaign import (
    CHANNELS,
    ON_MODEL,
    PHOTOCELL,
    FoundCampaign,
    FoundColumn,
    FoundRest,
    FoundRun,
)
from pmm.start.pulse_files import STEM, edges_beside, once_a_period, pulse_files, stem_of
from pmm.start.roles import find_roles
from pmm.start.sensors import noise_at_rest, smallest_step, step_of

_CALM_M_S: Final = 0.01  # a carriage that creeps no faster stands
_NOT_SAID: Final = "not in the recordings: put in what it was"
_PLACEHOLDER: Final = SetPoint(0.5, 0.02)
_ZERO: Final = ("zero", "null", "tare", "ruhe", "rust", "rest", "zéro", "repos")


@dataclass(frozen=True)
class _Look:
    """What was taken from one recording, so that its samples need not be kept."""

    path: Path
    watched: RecordingBehaviour
    duration_s: float
    sample_rate_hz: float
    set_point: SetPoint | None
    pulses: bool
    steps: dict[str, float | None]
    noise: dict[str, float]


def find_campaign(paths: Sequence[Path], folder: Path) -> FoundCampaign:
    """Return what recordings tell of a campaign.

    Parameters
    ----------
    folder
        Where the campaign's file will lie.

    Raises
    ------
    DataError, ConfigurationError
        If a recording cannot be read.
    """
    called = pulse_files(paths)
    paths = [path for path in paths if not called or not path.name.endswith(called[len(STEM) :])]
    looks = [_look(path) for path in paths]
    rests = at_rest([look.watched for look in looks])
    running = [look.watched for look, stands in zip(looks, rests, strict=True) if not stands]
    columns = as_columns(find_roles(running), running)
    sure = {column.name: column for column in columns if not column.doubt}
    names = dict(zip(paths, _names(paths), strict=True))
    taken = {column.column for column in columns}
    everything = dict.fromkeys(name for look in looks for name in look.watched.columns)
    edges_file = called if PHOTOCELL not in sure and _in_time(looks, called) else ""
    pulses = PHOTOCELL in sure or bool(edges_file) or any(look.pulses for look in looks)
    reference = _reference(columns, pulses)
    digits = 4 if reference or pulses or {SHAFT_ANGLE.name, DISPLACEMENTS[0]} & set(sure) else 6
    return FoundCampaign(
        runs=tuple(
            _run(look, names[look.path], folder, sure, digits)
            for look, stands in zip(looks, rests, strict=True)
            if not stands
        ),
        at_rest=tuple(
            _found_rest(look, names[look.path], folder, sure)
            for look, stands in zip(looks, rests, strict=True)
            if stands
        ),
        columns=tuple(columns),
        other_columns=tuple(name for name in everything if name not in taken),
        by_order=by_order_of_names(columns),
        mapped=not all(find_reader(path).own_channels for path in paths),
        reference=reference,
        sample_rate_hz=Counter(look.sample_rate_hz for look in looks).most_common(1)[0][0],
        sensors=dict(_sensors(looks, rests, sure)),
        not_recorded=_without(columns),
        photocell=pulses,
        edges_file=edges_file,
    )


def _in_time(looks: Sequence[_Look], called: str) -> bool:
    """Tell whether the pulses beside the runs come once in each period of theirs."""
    if not called:
        return False
    timed = [(look.path, look.watched.line) for look in looks if look.watched.line is not None]
    return bool(timed) and all(
        once_a_period(edges_beside(path, called) or (), line.frequency_hz) for path, line in timed
    )


def _look(path: Path) -> _Look:
    recording = read_recording(path)
    names = recording.channel_names
    return _Look(
        path,
        watch(recording),
        recording.end_s - recording.start_s,
        float(f"{recording.sample_rate_hz:.6g}"),
        recording.set_point,
        recording.photocell_edges_s is not None and bool(len(recording.photocell_edges_s)),
        {name: step_of(recording.values(name)) for name in names},
        {name: noise_at_rest(recording, name) for name in names},
    )


def _names(paths: Sequence[Path]) -> list[str]:
    """Return a name for each recording: its file's, with its folder's where that is not enough."""
    stems = [stem_of(path) for path in paths]
    folders = [path.resolve().parent.name for path in paths]
    full_names = [f"{folder}-{stem}" for folder, stem in zip(folders, stems, strict=True)]
    return next((names for names in (stems, folders) if len(set(names)) == len(names)), full_names)


def _reference(columns: Iterable[FoundColumn], pulses: bool) -> str:
    """Return the channel that tells the phase where no channel does that is asked by itself."""
    sure = {column.name for column in columns if not column.doubt}
    if pulses or {SHAFT_ANGLE.name, DISPLACEMENTS[0]} & sure:
        return ""
    if DISPLACEMENTS[1] in sure:
        return DISPLACEMENTS[1]
    guesses = (column.column for column in columns if column.doubt and column.name in DISPLACEMENTS)
    return next((name for name in guesses if name in sure), "")


def _without(columns: Sequence[FoundColumn]) -> tuple[str, ...]:
    """Return the gauges that are not there beside one that is; what may be one is not said."""
    doubts = {column.name: column.doubt for column in columns if column.name in FORCES}
    return tuple(name for name in FORCES if name not in doubts) if "" in doubts.values() else ()


def _run(
    look: _Look, name: str, folder: Path, sure: dict[str, FoundColumn], digits: int
) -> FoundRun:
    line, set_point = look.watched.line, look.set_point
    phasors = {
        channel: look.watched.columns[column.column].part.first * column.factor
        for channel, column in sure.items()
        if column.column in look.watched.columns
    }
    speed_m_s, remarks = _speed_m_s(look, sure), {}
    if set_point is None:
        set_point = _PLACEHOLDER if line is None else _set_point(line.frequency_hz, phasors)
        strut = next(
            (displacement for displacement in DISPLACEMENTS if displacement in phasors), None
        )
        if line is None:
            remarks["frequency_hz"] = "NOT FOUND: put in what was set"
        if strut is None:
            remarks["eccentricity_mm"] = (
                "NOT FOUND, since no displacement is sure: put in what was set"
            )
        if not all(displacement in phasors for displacement in DISPLACEMENTS):
            remarks["strut_phase_deg"] = _NOT_SAID
        if speed_m_s is None:
            remarks["carriage_speed_m_s"] = f"{_NOT_SAID}; without it the carriage stands"
    else:
        speed_m_s, digits = set_point.carriage_speed_m_s, 6
    return FoundRun(
        name,
        Path(os.path.relpath(look.path, folder)).as_posix(),
        _rounded(set_point.frequency_hz, digits),
        _rounded(1e3 * set_point.eccentricity_m, 3),
        float(round(math.degrees(set_point.strut_phase_rad))) % 360.0,
        speed_m_s or 0.0,
        set_point.medium,
        remarks,
        "nothing in it keeps time" if line is None else line.doubt,
    )


def _set_point(frequency_hz: float, phasors: dict[str, complex]) -> SetPoint:
    aft, fore = (phasors.get(displacement) for displacement in DISPLACEMENTS)
    moved = aft if aft is not None else fore
    turned = fore / aft if aft and fore else 1.0
    return SetPoint(
        frequency_hz,
        _PLACEHOLDER.eccentricity_m if moved is None else abs(moved),
        math.atan2(turned.imag, turned.real),
    )


def _speed_m_s(look: _Look, sure: dict[str, FoundColumn]) -> float | None:
    column = sure.get(CARRIAGE_SPEED.name)
    if column is None or column.column not in look.watched.columns:
        return None
    mean = look.watched.columns[column.column].mean
    return 0.0 if abs(mean) < _CALM_M_S else _rounded(mean, 4)


def _found_rest(look: _Look, name: str, folder: Path, sure: dict[str, FoundColumn]) -> FoundRest:
    speed_m_s = _speed_m_s(look, sure)
    is_known = speed_m_s is not None or words.says(name, _ZERO)
    doubt = "" if is_known else "nothing says whether the carriage stood"
    return FoundRest(
        name,
        Path(os.path.relpath(look.path, folder)).as_posix(),
        RunKind.STRAIGHT_TOW if speed_m_s else RunKind.ZERO,
        _rounded(look.duration_s, 4),
        speed_m_s or 0.0,
        doubt,
    )


def _sensors(
    looks: Sequence[_Look], rests: Sequence[bool], sure: dict[str, FoundColumn]
) -> Iterator[tuple[str, dict[str, float]]]:
    """Yield what the numbers of each channel tell of its sensor, in SI."""
    for name, column in sure.items():
        if name not in CHANNELS or name in ON_MODEL:
            continue
        holding = [look for look in looks if column.column in look.steps]
        # A shaft that turns evenly is sampled at angles of a grid of its own.
        turns = name == SHAFT_ANGLE.name
        step = None if turns else smallest_step(look.steps[column.column] for look in holding)
        quiet = [
            look.noise[column.column]
            for look, stands in zip(looks, rests, strict=True)
            if stands and column.column in look.noise
        ]
        numbers = {}
        if quiet:
            rounding = 0.0 if step is None else step / math.sqrt(12.0)
            white = math.sqrt(max(float(np.mean(np.square(quiet))) - rounding**2, 0.0))
            numbers["noise_rms"] = _rounded(white * column.factor, 3)
        if step is not None:
            numbers["resolution"] = _rounded(step * column.factor, 6)
        if numbers:
            yield name, numbers


def _rounded(value: float, digits: int) -> float:
    return float(f"{value:.{digits}g}")
