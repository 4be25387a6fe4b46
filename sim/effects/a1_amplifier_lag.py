"""A1: the low-pass of the amplifiers, which makes the forces late."""

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.acquisition.amplifier import FilterKind, LowPass
from sim.acquisition.channels import Digitiser
from sim.effects.effect import Effect, OneSign, Signature, StageName, parameter
from sim.effects.measurement import of_forces, with_force_channels
from sim.effects.situation import Situation
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class AmplifierLag(Effect):
    """A low-pass in both force channels: an RC with one pole, Butterworth with more.

    To first order the force is late by tau: damping reads ``B + tau (M w^2 - C)``, mass
    ``M - tau B``. A low-pass that a channel has already gets the cutoff at which the lags of both
    add up; the signature is that of a channel without one.
    """

    code: ClassVar[str] = "A1"
    name: ClassVar[str] = "amplifier-lag"
    title: ClassVar[str] = "Low-pass of the force amplifiers"
    stage: ClassVar[StageName] = StageName.ACQUISITION

    cutoff_hz: float = parameter(10.0, 0.5, 10000.0, "Hz", "3 dB down", one_sign=OneSign.RATE)
    poles: float = parameter(
        1.0, 1.0, 8.0, "1", "number of poles, rounded", held=True, one_sign=OneSign.COUNT
    )

    @property
    def order(self) -> int:
        """Whole number of poles."""
        return round(self.poles)

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with the low-pass in both force channels."""
        kind = FilterKind.RC if self.order == 1 else FilterKind.BUTTERWORTH
        own = LowPass(self.cutoff_hz, kind, self.order)

        def late(digitiser: Digitiser, _: int) -> Digitiser:
            if digitiser.low_pass is None:
                return replace(digitiser, low_pass=own)
            cutoff = 1.0 / (1.0 / digitiser.low_pass.cutoff_hz + 1.0 / self.cutoff_hz)
            return replace(digitiser, low_pass=replace(digitiser.low_pass, cutoff_hz=cutoff))

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
