"""S8: a model whose mass is not the one that was weighed."""

from dataclasses import dataclass, replace
from typing import ClassVar

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, Signature, StageName, parameter
from sim.effects.inertia import mass_signature
from sim.effects.situation import Situation
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class MassError(Effect):
    """``-dm w^2 y``, at the centre of gravity: added mass to whoever measures in water only."""

    code: ClassVar[str] = "S8"
    name: ClassVar[str] = "mass-error"
    title: ClassVar[str] = "Model's mass not as weighed"
    stage: ClassVar[StageName] = StageName.MODEL

    relative: float = parameter(0.005, -0.05, 0.05, "1", "error relative to the model's mass")

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with the real mass; centre of gravity and inertia stay."""
        body = replace(rig.body, mass_kg=rig.body.mass_kg * (1.0 + self.relative))
        return replace(rig, body=body)

    def signature(self, situation: Situation) -> Signature:
        """Return the inertia of the difference, and its weight in pitch; exact."""
        body = situation.rig.body
        more = self.relative * body.mass_kg
        return mass_signature(situation, more, more * body.cg_x_m, 0.0, more * body.cg_z_m)
