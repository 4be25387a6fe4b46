"""How a strut follows its set-points in one run: what is left between both, and gain and phase."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from analysis.recording import Recording
from analysis.resolver.harmonics import Harmonics
from analysis.response.frequency_response import frequency_response
from hardware.description.channels import CARRIAGE_SPEED, COMMANDS, DISPLACEMENTS


@dataclass(frozen=True)
class StrutFollowing:
    """The following error of one strut in one run over the gate, in its displacement's unit.

    Attributes
    ----------
    channel, unit
        Of the displacement.
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
    units = {one.name: one.unit for one in recording.channels}
    both = zip(COMMANDS, DISPLACEMENTS, strict=True)
    return tuple(
        (command, moved)
        for command, moved in both
        if {command, moved} <= units.keys() and units[command] == units[moved]
    )


def strut_following(
    recording: Recording, reading: Harmonics, order: int
) -> Iterator[StrutFollowing]:
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
    gate = recording.between(reading.opened_s, reading.closed_s)
    for command, moved in led_struts(recording):
        off = gate.values(moved) - gate.values(command)
        response = frequency_response(reading, command, moved, [order])
        gain = complex(response.values[0])
        # Half of the variance lies along the phasor, half across it.
        spread = math.sqrt(response.variance[0] / 2.0)
        yield StrutFollowing(
            reading.run,
            moved,
            recording.channels[recording.index(moved)].unit,
            order * reading.frequency_hz,
            float(np.sqrt(np.nanmean(off**2))),
            float(np.nanmax(np.abs(off))),
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
