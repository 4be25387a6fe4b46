"""A5: pulses of the photocell that scatter about the mark."""

import math
from dataclasses import dataclass, replace

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.effects.effect import DeviationTrace, Effect, OneSign, Signature, StageName, parameter
from sim.effects.measurement import of_waves
from sim.effects.situation import Situation
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class TriggerJitter(Effect):
    """Pulses at normally distributed shaft angles; averaging over cycles then loses high orders.

    The signature is the expected mean over cycles, each referred to its own pulse. Cycles that are
    stretched between two pulses lose two thirds of that; cycles whose phase is fitted over the
    whole record lose nothing. What one record shows scatters about it by n sigma over the root of
    the number of cycles.
    """

    code = "A5"
    name = "trigger-jitter"
    title = "Jitter of the photocell's pulses"
    stage = StageName.PHOTOCELL
    repeats = False
    by_chance = True
    shows_in = (DeviationTrace.PERIODS, DeviationTrace.CYCLES)

    jitter_rad: float = parameter(
        5e-3, 0.0, 0.1, "rad", "sigma, as an angle of the shaft", one_sign=OneSign.SCATTER
    )

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with this scatter on top of what its pulses have."""
        if rig.photocell is None:
            return rig
        own_s = self.jitter_rad / (2.0 * math.pi * set_point.frequency_hz)
        jitter_s = math.hypot(rig.photocell.jitter_rms_s, own_s)
        return replace(rig, photocell=replace(rig.photocell, jitter_rms_s=jitter_s))

    def signature(self, situation: Situation) -> Signature:
        """Return ``(exp(-n^2 sigma^2/2) - 1) H_n`` for every channel."""
        if situation.rig.photocell is None:
            return {}
        loss = (self.jitter_rad**2) / 2.0
        return of_waves(
            situation,
            lambda name, order: (
                complex(np.expm1(-(order**2) * loss)) * situation.phasor(name, order)
            ),
        )
