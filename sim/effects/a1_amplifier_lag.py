"""A1: the low-pass of the amplifiers, which makes the forces late."""

import math
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.acquisition.amplifier import FilterKind, LowPass
from sim.acquisition.channels import Digitiser
from sim.effects.effect import Effect, OneSign, Signature, StageName, parameter
from sim.effects.measurement import of_forces, with_force_channels
from sim.effects.situation import Situation
from sim.rig import SimulatedRig

_HIGHEST_HZ: Final = 10000.0
_POLES: Final = (1, 3)  # of other forms


@dataclass(frozen=True)
class AmplifierLag(Effect):
    """A low-pass in both force channels: an RC with one pole, Butterworth with more, or a delay.

    To first order the force is late by tau: damping reads ``B + tau (M w^2 - C)``, mass
    ``M - tau B``. A low-pass that a channel has already gets the cutoff at which the lags of both
    add up; the signature is that of a channel without one. Analogue filters of more poles hardly
    weaken what they make late, and converters that average over many samples have a plain delay:
    other forms have the same lag at low frequencies.
    """

    code = "A1"
    name = "amplifier-lag"
    title = "Low-pass of the force amplifiers"
    stage = StageName.ACQUISITION

    cutoff_hz: float = parameter(10.0, 0.5, _HIGHEST_HZ, "Hz", "3 dB down", one_sign=OneSign.RATE)
    poles: float = parameter(
        1.0, 1.0, 8.0, "1", "number of poles, rounded", held=True, one_sign=OneSign.COUNT
    )
    pure: float = parameter(
        0.0,
        0.0,
        1.0,
        "1",
        "share of the lag that is a plain delay",
        one_sign=OneSign.SHARE,
        forms=(1.0,),
    )

    @property
    def order(self) -> int:
        """Whole number of poles."""
        return round(self.poles)

    @property
    def lag_s(self) -> float:
        """Lag at low frequencies, ``1/(w_c sin(pi/2N))`` of N poles."""
        return 1.0 / (2.0 * math.pi * self.cutoff_hz * math.sin(math.pi / (2 * self.order)))

    def forms(self) -> tuple[Effect, ...]:
        """Return the plain delay, and filters of other poles with the same lag."""
        orders = [poles for poles in _POLES if poles != self.order]
        return (*super().forms(), *(self._with_poles(poles) for poles in orders))

    def _with_poles(self, poles: int) -> "AmplifierLag":
        as_late = math.sin(math.pi / (2 * self.order)) / math.sin(math.pi / (2 * poles))
        return replace(self, cutoff_hz=min(self.cutoff_hz * as_late, _HIGHEST_HZ), poles=poles)

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with the low-pass in both force channels."""
        kind = FilterKind.RC if self.order == 1 else FilterKind.BUTTERWORTH
        cutoff_hz, delay_s = self.cutoff_hz, self.pure * self.lag_s

        def late(digitiser: Digitiser, _: int) -> Digitiser:
            digitiser = replace(digitiser, delay_s=digitiser.delay_s + delay_s)
            if self.pure == 1.0:
                return digitiser
            low_pass = LowPass(cutoff_hz / (1.0 - self.pure), kind, self.order)
            if digitiser.low_pass is None:
                return replace(digitiser, low_pass=low_pass)
            both_hz = 1.0 / (1.0 / digitiser.low_pass.cutoff_hz + 1.0 / low_pass.cutoff_hz)
            return replace(digitiser, low_pass=replace(digitiser.low_pass, cutoff_hz=both_hz))

        return with_force_channels(rig, late)

    def signature(self, situation: Situation) -> Signature:
        """Return ``(G(i n w) - 1) F_n``, G from the poles on the circle of the cutoff."""
        steps = (2 * np.arange(self.order) + self.order + 1) / (2 * self.order)
        poles = np.exp(1j * np.pi * steps)

        def change(order: int, force: np.ndarray) -> np.ndarray:
            relative = 1j * order * situation.set_point.frequency_hz / self.cutoff_hz
            gain = np.prod(-poles) / np.prod(relative - poles)
            changed: np.ndarray = (gain - 1.0) * force
            return changed

        return of_forces(situation, change)
