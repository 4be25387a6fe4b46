"""How struts and carriage follow what they are told in one run: what is left, gain and phase."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from analysis.recording import Recording
from analysis.resolver.analysis import analyse
from analysis.resolver.harmonics import Harmonics
from analysis.resolver.reference_choice import ReferenceChoice
from analysis.resolver.settings import ResolverSettings
from analysis.response.frequency_response import frequency_response
from hardware.description.carriage_path import CarriagePath
from hardware.description.channels import (
    CARRIAGE_SPEED,
    COMMANDS,
    DISPLACEMENTS,
    SHAFT_ANGLE,
    Channel,
)


@dataclass(frozen=True)
class Following:
    """The following error of one strut, or of the carriage, in one run over the gate.

    In the unit of the displacement, or of the speed.

    Attributes
    ----------
    channel, unit
        Of the displacement or speed.
    frequency_hz
        Of the harmonic that amplitude and phase are told at.
    rms, peak
        Of displacement less set-point; a mean is in both.
    amplitude_relative
        Amplitude of the displacement over that of the set-point, less 1.
    phase_rad
        By which the displacement is ahead of the set-point; a lag is negative.
    u_amplitude_relative, u_phase_rad
        Their standard uncertainties, from the scatter of the periods; NaN where there are too few.
    """

    run: str
    channel: str
    unit: str
    frequency_hz: float
    rms: float
    peak: float
    amplitude_relative: float
    phase_rad: float
    u_amplitude_relative: float
    u_phase_rad: float


def led_struts(recording: Recording) -> tuple[tuple[str, str], ...]:
    """Return set-point and displacement of each strut that has both, in one unit."""
    units = {channel.name: channel.unit for channel in recording.channels}
    pairs = zip(COMMANDS, DISPLACEMENTS, strict=True)
    return tuple(
        (command, moved)
        for command, moved in pairs
        if {command, moved} <= units.keys() and units[command] == units[moved]
    )


def strut_following(recording: Recording, reading: Harmonics, order: int) -> Iterator[Following]:
    """Yield how each strut follows.

    Parameters
    ----------
    reading
        A gate in which the channels of :func:`led_struts` were resolved.
    order
        The harmonic of the run's own motion.

    Raises
    ------
    DataError
        If the set-point does not move at that harmonic, or no sample lies in the gate.
    """
    for command, moved in led_struts(recording):
        yield _following(recording, reading, command, moved, order)


def carriage_following(
    recording: Recording,
    path: CarriagePath,
    age_s: float,
    reference: ReferenceChoice,
    settings: ResolverSettings,
) -> Following | None:
    """Return how the carriage follows its path; ``None`` where no shaft's angle or speed tells it.

    The path is taken at the angles that the record holds, ``age_s`` earlier (that of the recorded
    speed), and amplitude and phase at its largest line.

    Raises
    ------
    DataError
        If no gate is found.
    """
    if not {SHAFT_ANGLE.name, CARRIAGE_SPEED.name} <= set(recording.channel_names):
        return None
    order = 1 + int(np.argmax(np.abs(path.parts[1:])))
    angle = recording.values(SHAFT_ANGLE.name) - path.omega_rad_s * age_s
    waves = np.exp(1j * np.outer(np.arange(len(path.parts)), angle))
    path_channel = Channel("command_carriage", CARRIAGE_SPEED.unit)
    pair_record = replace(
        recording.select((SHAFT_ANGLE.name, CARRIAGE_SPEED.name)),
        channels=(SHAFT_ANGLE, CARRIAGE_SPEED, path_channel),
        samples=np.vstack([
            recording.values(SHAFT_ANGLE.name),
            recording.values(CARRIAGE_SPEED.name),
            (path.parts @ waves).real,
        ]),
    )  # fmt: skip
    order_settings = replace(settings, channels=(CARRIAGE_SPEED.name, path_channel.name))
    reading = analyse(
        pair_record, reference, replace(order_settings, harmonics=max(order, settings.harmonics))
    )
    return _following(
        pair_record, reading.readings[0], path_channel.name, CARRIAGE_SPEED.name, order
    )


def _following(
    recording: Recording, reading: Harmonics, command: str, moved: str, order: int
) -> Following:
    gate = recording.between(reading.opened_s, reading.closed_s)
    error = gate.values(moved) - gate.values(command)
    response = frequency_response(reading, command, moved, [order])
    gain = complex(response.values[0])
    # Half of the variance lies along the phasor, half across it.
    spread = math.sqrt(response.variance[0] / 2.0)
    return Following(
        reading.run,
        moved,
        recording.channels[recording.index(moved)].unit,
        order * reading.frequency_hz,
        float(np.sqrt(np.nanmean(error**2))),
        float(np.nanmax(np.abs(error))),
        abs(gain) - 1.0,
        math.atan2(gain.imag, gain.real),
        spread,
        spread / abs(gain) if gain else math.nan,
    )


def recorded_age(gate: Recording) -> tuple[float, float]:
    """Return how old the recorded speed of a carriage is on average, and what is not known of it.

    A value is asked for, answered, and stands in the record until the next one: it is as old as the
    answer took, which is anything up to the time between two values, and on average half of that
    time, less half a sample, older for standing. In seconds, the second a standard uncertainty.
    """
    changes = int(np.count_nonzero(np.diff(gate.values(CARRIAGE_SPEED.name))))
    stands_s = (gate.sample_count - 1) / gate.sample_rate_hz / max(changes, 1)
    return stands_s - 0.5 / gate.sample_rate_hz, stands_s / math.sqrt(12.0)
