"""Comparison of a run's set-point with the motion in its recording."""

import cmath
import math
from collections.abc import Iterator, Mapping

import numpy as np

from analysis.recording import Recording
from analysis.resolver.estimate import resolve
from analysis.resolver.harmonics import Harmonics
from analysis.resolver.reference import PhaseReference
from analysis.resolver.sums import PeriodSums, period_sums
from hardware.description.channels import DISPLACEMENT_AFT, DISPLACEMENT_FORE, DISPLACEMENTS
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity

_FREQUENCY = 0.01  # relative: a drive without a controller slips as far
_ECCENTRICITY = 0.05  # relative: a scale read a notch off
_STRUT_PHASE_RAD = 0.05  # moves a strut as far as that part of its amplitude


def set_point_flags(
    recording: Recording, reference: PhaseReference, gate: PeriodSums, reading: Harmonics
) -> tuple[Flag, ...]:
    """Return ``set_point_differs`` for each quantity that differs from the set-point.

    Compared are the frequency over the first gate, and amplitudes and phase of the struts'
    displacements where they are recorded, as the reference or otherwise; of a motion of many lines
    those of the largest.

    Parameters
    ----------
    recording
        With all its channels.
    gate, reading
        The periods of the first gate, and what was read there.
    """
    if recording.set_point is None:
        return ()
    set_hz = recording.set_point.frequency_hz
    flags = []
    if abs(reading.frequency_hz - set_hz) > _FREQUENCY * set_hz:
        flags.append(_flag("frequency", set_hz, reading.frequency_hz, "Hz", _FREQUENCY, None))
    line = max(recording.set_point.every_line, key=lambda line: line.share)
    phasors = [
        same_line.phasors
        for same_line in recording.set_point.every_line
        if same_line.order == line.order
    ]
    told_m = recording.set_point.eccentricity_m * np.abs(np.sum(phasors, axis=0))
    asked_m = dict(zip(DISPLACEMENTS, told_m.tolist(), strict=True))
    moved = dict(_phasors(recording, reference, gate, reading, line.order))
    for name, phasor_m in moved.items():
        eccentricity_m, found_m = asked_m[name], abs(phasor_m)
        if abs(found_m - eccentricity_m) > _ECCENTRICITY * eccentricity_m:
            told_mm, found_mm = 1e3 * eccentricity_m, 1e3 * found_m
            flags.append(_flag("eccentricity", told_mm, found_mm, "mm", _ECCENTRICITY, name))
    return (*flags, *_phase_flags(line.strut_phase_rad, moved))


def _phase_flags(told_rad: float, moved: Mapping[str, complex]) -> Iterator[Flag]:
    """Compare the fore strut's phase ahead of the aft one's, where both were recorded and moved."""
    aft, fore = (moved.get(strut.name, 0j) for strut in (DISPLACEMENT_AFT, DISPLACEMENT_FORE))
    if not (abs(aft) > 0.0 and abs(fore) > 0.0):
        return
    off_rad = cmath.phase(fore / aft * cmath.exp(-1j * told_rad))
    if abs(off_rad) > _STRUT_PHASE_RAD:
        actual, set_deg = math.degrees(told_rad + off_rad), math.degrees(told_rad)
        text = (
            f"the set-point's strut phase is {set_deg:.4g} deg, found are {actual:.5g} deg (limit "
            f"{math.degrees(_STRUT_PHASE_RAD):.2g} deg off): is this the recording of that run, "
            "and has each displacement its sign?"
        )
        yield Flag("set_point_differs", Severity.WARNING, text)


def _phasors(
    recording: Recording,
    reference: PhaseReference,
    gate: PeriodSums,
    reading: Harmonics,
    order: int,
) -> Iterator[tuple[str, complex]]:
    """Phasors of a harmonic of the displacements that are there, in metres."""
    for strut in (DISPLACEMENT_AFT, DISPLACEMENT_FORE):
        name = strut.name
        if name in reading.channel_names and order <= reading.order:
            row = reading.channel_names.index(name)
            unit, phasor = reading.units[row], _phasor(reading, row, order)
        elif name in recording.channel_names:
            unit = recording.channels[recording.index(name)].unit
            phasor = _resolved(recording.select([name]), reference, gate, order)
        else:
            continue
        if unit == strut.unit and not cmath.isnan(phasor):
            yield name, phasor


def _phasor(reading: Harmonics, row: int, order: int) -> complex:
    return complex(*reading.coefficients[row, 2 * order - 1 : 2 * order + 1])


def _resolved(
    recording: Recording, reference: PhaseReference, gate: PeriodSums, order: int
) -> complex:
    """Phasor over a gate; NaN where it has no period without missing samples."""
    sums = period_sums(recording, reference, order, edges_cycles=gate.edges_cycles)
    try:
        return _phasor(resolve(recording, sums), 0, order)
    except DataError:
        return complex("nan")


def _flag(
    quantity: str, set_value: float, actual: float, unit: str, limit: float, channel: str | None
) -> Flag:
    deviation = "" if not set_value else f", {100.0 * (actual / set_value - 1.0):+.1f} %"
    message = (
        f"the set-point's {quantity} is {set_value:.4g} {unit}, found are {actual:.5g} "
        f"{unit}{deviation} (limit {100.0 * limit:g} %): is this the recording of that run, and "
        "are unit and scale right?"
    )
    return Flag("set_point_differs", Severity.WARNING, message, channel)
