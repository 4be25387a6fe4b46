"""H13: waves and currents that the run before has left in the tank."""

import math
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.effects.campaign import CampaignRun
from sim.effects.effect import (
    DeviationTrace,
    Effect,
    FurtherMeasurement,
    Lines,
    OneSign,
    Signature,
    StageName,
    parameter,
)
from sim.effects.hydrodynamics import with_laws
from sim.effects.situation import STRUT_FORCES, Situation
from sim.model.law_point import Point
from sim.model.laws import Tone
from sim.rig import SimulatedRig

LONGEST_WAIT_S = 7200.0


@dataclass(frozen=True)
class ResidualWaves(Effect):
    """A force at the frequency of the run before that dies out while one waits, and in the run.

    In a campaign, frequency and waiting time are those of the run's place in it, and the first run
    finds calm water. Repeats with another waiting time scatter; where both runs have the same
    frequency, it is in the harmonic itself. A tank that any run sets swaying at a frequency of its
    own (a seiche, waves between its ends) answers every run with that one.
    """

    code = "H13"
    name = "residual-waves"
    title = "Waves left by the run before"
    stage = StageName.MODEL
    repeats = False
    by_chance = True
    # A wave of few periods is a trend, too.
    shows_in = (
        DeviationTrace.BESIDE,
        DeviationTrace.CYCLES,
        DeviationTrace.TREND,
    )
    shown_by = (FurtherMeasurement.REST,)

    force_n: float = parameter(
        3.0, 0.0, 100.0, "N", "amplitude when the run before has ended", one_sign=OneSign.AMPLITUDE
    )
    decay_s: float = parameter(
        200.0, 10.0, 3600.0, "s", "time in which it falls to 1/e", held=True, one_sign=OneSign.TIME
    )
    waited_s: float = parameter(
        300.0,
        0.0,
        LONGEST_WAIT_S,
        "s",
        "since the run before has ended",
        held=True,
        one_sign=OneSign.TIME,
    )
    frequency_hz: float = parameter(
        0.63, 0.01, 3.0, "Hz", "of the waves", held=True, one_sign=OneSign.RATE
    )
    tank_hz: float = parameter(
        0.0,
        0.0,
        3.0,
        "Hz",
        "of waves that the tank has at its own, whichever run left them; 0 for none",
        held=True,
        starts=(0.0, 0.4, 0.7, 1.1),
        one_sign=OneSign.RATE,
    )
    phase_rad: float = parameter(0.0, -math.pi, math.pi, "rad", "phase at the first sample")

    @property
    def left_n(self) -> float:
        """Amplitude at the first sample of the run."""
        return self.force_n * math.exp(-self.waited_s / self.decay_s)

    def at_run(self, run: CampaignRun) -> Self:
        """Return the effect with the waves that this run meets."""
        if run.before is None:
            return replace(self, force_n=0.0)
        # After two hours nothing is left.
        waited = self.nearest("waited_s", run.waited_s)
        frequency_hz = self.tank_hz or run.before.frequency_hz
        return replace(self, waited_s=waited, frequency_hz=frequency_hz)

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with this force on the model's heave or sway."""
        tone = Tone(self.left_n, self.frequency_hz, self.phase_rad, self.decay_s)
        return with_laws(rig, (Point.TRANSLATION, tone))

    def signature(self, situation: Situation) -> Signature:
        """Return nothing: it does not repeat with the shaft."""
        return {}

    def lines(self, situation: Situation) -> Lines:
        """Return half of the force at each strut, as it is at the first sample."""
        if not situation.in_water:
            return {}
        half = 0.5 * self.left_n * complex(np.exp(1j * self.phase_rad))
        return dict.fromkeys(((name, self.frequency_hz) for name in STRUT_FORCES), half)
