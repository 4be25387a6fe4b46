"""H12: a carriage whose speed varies: wheels that are not round, rail joints."""

import math
from dataclasses import dataclass, replace

import numpy as np

from hardware.description import channels
from hardware.description.setpoint import SetPoint
from sim import signals
from sim.drive.carriage import Fluctuation
from sim.effects.effect import (
    DeviationTrace,
    Effect,
    Lines,
    OneSign,
    Signature,
    StageName,
    parameter,
)
from sim.effects.hydrodynamics import per_speed
from sim.effects.situation import STRUT_FORCES, Situation
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class CarriageFluctuation(Effect):
    """A speed ``U (1 + r sin(W t + p))``: sidebands of the force at w +- W, none at its multiples.

    The speed's record has the line at W itself. A run at another speed moves it.
    """

    code = "H12"
    name = "carriage-fluctuation"
    title = "Fluctuation of the carriage's speed"
    stage = StageName.CARRIAGE
    repeats = False
    by_chance = True
    # A wave of few periods is a trend, too.
    shows_in = (
        DeviationTrace.BESIDE,
        DeviationTrace.CYCLES,
        DeviationTrace.TREND,
    )

    relative: float = parameter(
        0.003, 0.0, 0.05, "1", "r, of the mean speed", one_sign=OneSign.AMPLITUDE
    )
    frequency_hz: float = parameter(0.37, 0.005, 50.0, "Hz", "W/(2 pi)", one_sign=OneSign.RATE)
    phase_rad: float = parameter(0.0, -math.pi, math.pi, "rad", "p, at the first sample")

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with this fluctuation beside those that the carriage has."""
        fluctuation = Fluctuation(self.relative, self.frequency_hz, self.phase_rad)
        carriage = replace(rig.carriage, fluctuations=(*rig.carriage.fluctuations, fluctuation))
        return replace(rig, carriage=carriage)

    def signature(self, situation: Situation) -> Signature:
        """Return nothing: it does not repeat with the shaft."""
        return {}

    def lines(self, situation: Situation) -> Lines:
        """Return both sidebands of each strut's force, of the struts' first harmonic."""
        amplitudes: dict[tuple[str, float], complex] = {}
        wave = self.relative * np.exp(1j * self.phase_rad)
        if situation.rig.acquisition.carriage_speed is not None:
            recorded = signals.recorded(channels.CARRIAGE_SPEED).name
            speed = situation.phasor(recorded, 0).real
            amplitudes[recorded, self.frequency_hz] = complex(speed * wave)
        if not situation.in_water:
            return amplitudes
        start = np.exp(1j * situation.rig.drive.initial_angle_rad)
        motion = situation.displacement() * start
        s = 1j * situation.omega
        for side, turning in ((1, wave), (-1, np.conj(wave))):
            beside = situation.set_point.frequency_hz + side * self.frequency_hz
            at = 2j * np.pi * beside
            # sin(a) sin(b) = (cos(a - b) - cos(a + b))/2; i is the cosine.
            product = -side * 0.5j * motion * turning
            force = situation.flow_m_s * per_speed(situation, s, at) @ product
            for name, value in zip(STRUT_FORCES, force, strict=True):
                amplitudes[name, abs(beside)] = _forwards(complex(value), beside)
        return amplitudes


def _forwards(phasor: complex, frequency_hz: float) -> complex:
    """Return ``S + i C`` at a positive frequency: the sine of a negative one changes its sign."""
    return phasor if frequency_hz >= 0.0 else -phasor.conjugate()
