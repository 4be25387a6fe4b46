"""S10: water that sloshes in the model."""

from dataclasses import dataclass, replace

import numpy as np

from hardware.description.setpoint import Medium, SetPoint
from sim.effects.effect import Effect, OneSign, Signature, StageName, parameter
from sim.effects.hydrodynamics import radiation_of
from sim.effects.situation import Situation, at_struts
from sim.model.law_point import Acting
from sim.model.laws import Viscous
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class EntrainedWater(Effect):
    """A mass on a spring: ``-m w^2/(1 - (w/w_s)^2)``, with a change of sign at its frequency w_s.

    It is on board, at the midpoint: it feels the model's translation, whatever the angle of attack.
    A compartment may drain as the model is lifted out of the water, or not, the one as likely as
    the other: what stays sloshes on in air, and its weight is tared with the model's.
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
    stays_in_air: float = parameter(
        0.0,
        0.0,
        1.0,
        "1",
        "share that does not drain where the model is in air",
        one_sign=OneSign.SHARE,
    )

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with the sloshing as two more states of its memory, and its damper.

        The force per velocity, m s (c s + k)/(m s^2 + c s + k), is c and a proper remainder.
        """
        mass_kg = self._mass_kg(set_point.medium)
        natural = 2.0 * np.pi * self.slosh_hz
        damping = 2.0 * self.damping_ratio * natural
        slosh = [[0.0, 1.0], [-(natural**2), -damping]]
        remainder = mass_kg * np.array([-damping * natural**2, natural**2 - damping**2])
        memory = radiation_of(rig).joined(
            slosh,
            [[0.0, 0.0], [1.0, 0.0]],
            np.vstack([remainder, np.zeros(2)]),
            aboard=True,
        )
        damper = Acting(Viscous(mass_kg * damping))
        return replace(rig, radiation=memory, forces=(*rig.forces, damper))

    def signature(self, situation: Situation) -> Signature:
        """Return the reaction of a mass on spring and damper; exact."""
        s, natural = 1j * situation.omega, 2.0 * np.pi * self.slosh_hz
        spring = natural**2 + 2.0 * self.damping_ratio * natural * s
        apparent_kg = self._mass_kg(situation.set_point.medium) * spring / (s**2 + spring)
        along = situation.system.to_motion[0]
        return at_struts(apparent_kg * s**2 * (along @ situation.displacement()) * along, 1)

    def _mass_kg(self, medium: Medium) -> float:
        """Return what sloshes in a run."""
        return self.mass_kg * (1.0 if medium is Medium.WATER else self.stays_in_air)
