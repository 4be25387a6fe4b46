"""What a run was told to do, against what was found in its recording."""

from collections.abc import Iterator

from analysis.recording import Recording
from analysis.resolver.estimate import resolve
from analysis.resolver.harmonics import Harmonics
from analysis.resolver.reference import PhaseReference
from analysis.resolver.sums import PeriodSums, period_sums
from hardware.description.channels import DISPLACEMENT_AFT, DISPLACEMENT_FORE
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity

_FREQUENCY = 0.01  # relative: a drive without a controller slips as far
_ECCENTRICITY = 0.05  # relative: a scale read a notch off


def set_point_flags(
    recording: Recording, reference: PhaseReference, gate: PeriodSums, reading: Harmonics
) -> tuple[Flag, ...]:
    """Return ``set_point_differs`` for what is not as the set-point says.

    Compared are the frequency over the first gate, and the amplitudes of the struts' displacements
    where they are recorded, as the reference or otherwise.

    Parameters
    ----------
    recording
        With all its channels.
    gate, reading
        The periods of the first gate, and what was read there.
    """
    if recording.set_point is None:
        return ()
    told = recording.set_point.frequency_hz
    flags = []
    if abs(reading.frequency_hz - told) > _FREQUENCY * told:
        flags.append(_flag("frequency", told, reading.frequency_hz, "Hz", _FREQUENCY, None))
    eccentricity_m = recording.set_point.eccentricity_m
    for name, found_m in _amplitudes(recording, reference, gate, reading):
        if abs(found_m - eccentricity_m) > _ECCENTRICITY * eccentricity_m:
            told_mm, found_mm = 1e3 * eccentricity_m, 1e3 * found_m
            flags.append(_flag("eccentricity", told_mm, found_mm, "mm", _ECCENTRICITY, name))
    return tuple(flags)


def _amplitudes(
    recording: Recording, reference: PhaseReference, gate: PeriodSums, reading: Harmonics
) -> Iterator[tuple[str, float]]:
    """Amplitudes of the first harmonics of the displacements that are there, in metres."""
    for strut in (DISPLACEMENT_AFT, DISPLACEMENT_FORE):
        name = strut.name
        if name in reading.channel_names:
            row = reading.channel_names.index(name)
            unit, amplitude = reading.units[row], float(reading.amplitude[row, 0])
        elif name in recording.channel_names:
            unit = recording.channels[recording.index(name)].unit
            amplitude = _amplitude(recording.select([name]), reference, gate)
        else:
            continue
        if unit == strut.unit and amplitude == amplitude:
            yield name, amplitude


def _amplitude(recording: Recording, reference: PhaseReference, gate: PeriodSums) -> float:
    """Amplitude over a gate; NaN where it has no period without missing samples."""
    sums = period_sums(recording, reference, 1, edges_cycles=gate.edges_cycles)
    try:
        return float(resolve(recording, sums).amplitude[0, 0])
    except DataError:
        return float("nan")


def _flag(
    what: str, told: float, found: float, unit: str, limit: float, channel: str | None
) -> Flag:
    away = "" if not told else f", {100.0 * (found / told - 1.0):+.1f} %"
    message = (
        f"the set-point's {what} is {told:.4g} {unit}, found are {found:.5g} {unit}{away} (limit "
        f"{100.0 * limit:g} %): is this the recording of that run, and are unit and scale right?"
    )
    return Flag("set_point_differs", Severity.WARNING, message, channel)
