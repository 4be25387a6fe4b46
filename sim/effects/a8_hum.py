"""A8: hum from the mains in the force channels."""

import math
from dataclasses import dataclass, replace

import numpy as np

from hardware.description.errors import ConfigurationError
from hardware.description.setpoint import SetPoint
from sim.acquisition.channels import Digitiser
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
from sim.effects.measurement import with_force_channels
from sim.effects.situation import RECORDED_FORCES, Situation
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class Hum(Effect):
    """A line at the mains' frequency, sampled as it is: it folds to ``|f - k f_s|``.

    It is no multiple of the shaft's frequency and has no harmonic of its own. Where it folds onto
    one, a slightly other frequency of the shaft moves the harmonic and leaves the line. A diagnosis
    looks for it at the frequencies that mains have: a line elsewhere is something else.
    """

    code = "A8"
    name = "hum"
    title = "Hum of the mains, and its alias"
    stage = StageName.ACQUISITION
    repeats = False
    by_chance = True
    shows_in = (DeviationTrace.BESIDE, DeviationTrace.CYCLES)
    shown_by = (
        FurtherMeasurement.REST,
        FurtherMeasurement.INJECTION,
    )

    amplitude_n: float = parameter(
        0.2, 0.0, 20.0, "N", "amplitude in both force channels", one_sign=OneSign.AMPLITUDE
    )
    frequency_hz: float = parameter(
        50.0,
        1.0,
        2000.0,
        "Hz",
        "frequency of the mains, or of what else hums",
        held=True,
        starts=(50.0, 60.0),
        one_sign=OneSign.RATE,
    )
    phase_rad: float = parameter(0.0, -math.pi, math.pi, "rad", "phase at the first sample")

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with the hum; hum of the same frequency that it has already is added to.

        Raises
        ------
        ConfigurationError
            If a channel hums at another frequency already.
        """

        def humming(digitiser: Digitiser, _: int) -> Digitiser:
            phasor = self.amplitude_n * np.exp(1j * self.phase_rad)
            if digitiser.hum:
                if digitiser.hum_hz != self.frequency_hz:
                    raise ConfigurationError(
                        f"a force channel hums at {digitiser.hum_hz:g} Hz already, and can have no "
                        f"second line at frequency_hz = {self.frequency_hz:g}; give them the same"
                    )
                phasor += digitiser.hum * np.exp(1j * digitiser.hum_phase_rad)
            size, phase = float(abs(phasor)), float(np.angle(phasor))
            return replace(digitiser, hum=size, hum_hz=self.frequency_hz, hum_phase_rad=phase)

        return with_force_channels(rig, humming)

    def signature(self, situation: Situation) -> Signature:
        """Return nothing: it does not repeat with the shaft."""
        return {}

    def lines(self, situation: Situation) -> Lines:
        """Return the line in both channels, before it folds."""
        line = self.amplitude_n * complex(np.exp(1j * self.phase_rad))
        return dict.fromkeys(((name, self.frequency_hz) for name in RECORDED_FORCES), line)
