"""S10: water that sloshes in the model."""

from dataclasses import dataclass, replace

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, OneSign, Signature, StageName, parameter
from sim.effects.situation import Situation, at_struts
from sim.model.water.radiation import constant
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class EntrainedWater(Effect):
    """A mass on a spring: ``-m w^2/(1 - (w/w_s)^2)``, with a change of sign at its frequency w_s.

    It moves with the translation at the midpoint, through the water; the model is drained in air.
    """

    code = "S10"
    name = "entrained-water"
    title = "Water that sloshes in the model"
    stage = StageName.MODEL

    mass_kg: float = parameter(
        1.5, 0.0, 20.0, "kg", "mass of the water that sloshes", one_sign=OneSign.MASS
    )
    slosh_hz: float = parameter(
        1.2, 0.1, 10.0, "Hz", "frequency of its sloshing", resonance=True, one_sign=OneSign.RATE
    )
    damping_ratio: float = parameter(
        0.03, 0.001, 0.5, "1", "of its sloshing, to critical", one_sign=OneSign.DAMPING
    )

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with the sloshing as two more states of the water's memory.

        The force per velocity, m s (c s + k)/(m s^2 + c s + k), is c and a proper remainder.
        """
        natural = 2.0 * np.pi * self.slosh_hz
        damping = 2.0 * self.damping_ratio * natural
        slosh = [[0.0, 1.0], [-(natural**2), -damping]]
        remainder = self.mass_kg * np.array([-damping * natural**2, natural**2 - damping**2])
        memory = (constant(np.zeros((2, 2))) if rig.radiation is None else rig.radiation).joined(
            slosh, [[0.0, 0.0], [1.0, 0.0]], np.vstack([remainder, np.zeros(2)])
        )
        first, second = rig.water.damping
        stiffer = ((first[0] + self.mass_kg * damping, first[1]), second)
        return replace(rig, radiation=memory, water=replace(rig.water, damping=stiffer))

    def signature(self, situation: Situation) -> Signature:
        """Return the reaction of a mass on spring and damper; exact."""
        system = situation.system
        s, natural = 1j * situation.omega, 2.0 * np.pi * self.slosh_hz
        spring = natural**2 + 2.0 * self.damping_ratio * natural * s
        per_velocity = self.mass_kg * s * spring / (s**2 + spring)
        velocity = (s * system.to_motion + system.incidence)[0] @ situation.displacement()
        force = per_velocity * velocity * system.to_motion[0]
        return at_struts(force, 1) if situation.in_water else {}
