"""What regular waves do to the model, and what a probe on the carriage sees of them.

Loads follow the elevation at the probe by what is stated, and nothing of the model's own motion:

    F(t) = Re(H_1 a e^(i phi)) + D a^2 + Re(H_2 a^2 e^(2 i phi)),     zeta_probe = a cos(phi)
"""

import math
from dataclasses import dataclass, field

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.motor import UNKNOWN_KEYS_REFUSED
from hardware.description.setpoint import SetPoint
from hardware.description.waves import wave_number


@dataclass(frozen=True)
class WaveLoad:
    """One load of the water on the model, by the elevation at the probe.

    Attributes
    ----------
    first, phase_rad
        Per amplitude, and its lead over the crest at the probe.
    mean
        Per amplitude squared.
    second, second_phase_rad
        The same at twice the encounter frequency.
    """

    first: float = 0.0
    phase_rad: float = 0.0
    mean: float = 0.0
    second: float = 0.0
    second_phase_rad: float = 0.0

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED

    def over(self, phase_rad: FloatArray, amplitude_m: float) -> FloatArray:
        """Return the load where the probe's wave has a phase."""
        first = self.first * amplitude_m * np.cos(phase_rad + self.phase_rad)
        second = self.second * np.cos(2.0 * phase_rad + self.second_phase_rad)
        return np.asarray(first + amplitude_m**2 * (self.mean + second))


@dataclass(frozen=True)
class Waves:
    """What waves in the tank do, whichever there are.

    Attributes
    ----------
    ahead, across, about
        Loads on the model about the midpoint: ahead, to starboard (down) and bow to starboard (up).
    probe_x_m
        Where the probe on the carriage stands, ahead of the midpoint.
    depth_m
        Of the tank; ``None`` for deep water.
    """

    ahead: WaveLoad = field(default_factory=WaveLoad)
    across: WaveLoad = field(default_factory=WaveLoad)
    about: WaveLoad = field(default_factory=WaveLoad)
    probe_x_m: float = 0.0
    depth_m: float | None = None

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED

    def met_in(self, point: SetPoint) -> "MetWaves":
        """Return the regular waves that the model meets in a run."""
        asked = (point.wave_frequency_hz, point.wave_amplitude_m, point.wave_heading_rad)
        return MetWaves(self, *asked)


@dataclass(frozen=True)
class MetWaves:
    """Regular waves that the model meets in a run; none of amplitude 0."""

    waves: Waves
    frequency_hz: float
    amplitude_m: float
    heading_rad: float

    def phase_rad(self, time_s: FloatArray, speed_m_s: float) -> FloatArray:
        """Return the phase of the wave at the probe, of a carriage at a steady speed."""
        k = wave_number(self.frequency_hz, self.waves.depth_m) * math.cos(self.heading_rad)
        omega = 2.0 * math.pi * self.frequency_hz
        return np.asarray((omega - k * speed_m_s) * time_s - k * self.waves.probe_x_m)

    def at_instants(self, time_s: FloatArray, speed_m_s: float) -> tuple[FloatArray, FloatArray]:
        """Return the loads ahead, across and about, shape ``(3, n)``, and the elevation in m."""
        phase, waves = self.phase_rad(time_s, speed_m_s), self.waves
        loads = [
            load.over(phase, self.amplitude_m) for load in (waves.ahead, waves.across, waves.about)
        ]
        return np.stack(loads), np.asarray(self.amplitude_m * np.cos(phase))
