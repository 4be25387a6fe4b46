"""A6: a photocell that misses a pulse now and then."""

import math
from dataclasses import dataclass, replace

from hardware.description.setpoint import SetPoint
from sim.effects.effect import DeviationTrace, Effect, OneSign, Signature, StageName, parameter
from sim.effects.measurement import of_waves
from sim.effects.situation import Situation
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class MissedPulse(Effect):
    """One pulse in N is missing, so that one cycle in N - 1 seems twice as long.

    The signature is that of an average over cycles which are each stretched to one period: the
    long one shows order n at 2 n and nothing at odd orders. In the periods themselves it is
    obvious.
    """

    code = "A6"
    name = "missed-pulse"
    title = "Missed pulses of the photocell"
    stage = StageName.PHOTOCELL
    repeats = False
    shows_in = (DeviationTrace.PULSES,)

    every: float = parameter(
        20.0,
        3.0,
        10000.0,
        "1",
        "N, rounded: one pulse in so many is missing",
        starts=(5.0, 10.0, 20.0),
        held=True,
        one_sign=OneSign.COUNT,
    )

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with such a photocell; the more frequent miss stands."""
        if rig.photocell is None:
            return rig
        missed = min(round(self.every), rig.photocell.missed_every or math.inf)
        return replace(rig, photocell=replace(rig.photocell, missed_every=int(missed)))

    def signature(self, situation: Situation) -> Signature:
        """Return ``(H_{n/2} - H_n)/(N - 1)``, the first for even n only."""
        if situation.rig.photocell is None:
            return {}

        def change(name: str, order: int) -> complex:
            from_half = 0.0 if order % 2 else situation.phasor(name, order // 2)
            return (from_half - situation.phasor(name, order)) / (round(self.every) - 1)

        return of_waves(situation, change)
