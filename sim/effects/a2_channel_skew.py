"""A2: channels that are scanned one after the other."""

from dataclasses import dataclass, replace

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, Signature, StageName, parameter
from sim.effects.measurement import delayed_rig, of_forces, with_force_channels
from sim.effects.situation import Situation
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class ChannelSkew(Effect):
    """Samples of a force that show what it was a little earlier: ``exp(-i n w dt)``.

    In one channel, a part of the inertia becomes damping there, with w^3. A force that is ahead, a
    negative delay, is one that is sampled before the other channels and the photocell: these are
    then late.
    """

    code = "A2"
    name = "channel-skew"
    title = "Sampling skew of the force channels"
    stage = StageName.ACQUISITION

    aft_s: float = parameter(0.0, -0.02, 0.02, "s", "delay of the aft force")
    fore_s: float = parameter(1e-3, -0.02, 0.02, "s", "delay of the fore force")

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with these delays on top of what the channels have."""
        delays = (self.aft_s, self.fore_s)
        # No sample shows what is yet to come: where a force is ahead, all others are later.
        ahead_s = max(0.0, *(-delay for delay in delays))
        return with_force_channels(
            delayed_rig(rig, ahead_s),
            lambda digitiser, i: replace(digitiser, delay_s=digitiser.delay_s + delays[i]),
        )

    def signature(self, situation: Situation) -> Signature:
        """Return ``(exp(-i n w dt) - 1) F_n``."""
        turned = situation.omega * np.array([self.aft_s, self.fore_s])
        return of_forces(
            situation, lambda order, force: (np.exp(-1j * order * turned) - 1.0) * force
        )
