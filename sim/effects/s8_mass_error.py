"""S8: a model whose mass is not the one that was weighed."""

from dataclasses import dataclass, replace

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, Signature, StageName, parameter
from sim.effects.inertia import mass_signature
from sim.effects.situation import Situation
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class MassError(Effect):
    """``-dm w^2 y``, at the centre of gravity: added mass to whoever measures in water only.

    What was not weighed may as well lie somewhere else.
    """

    code = "S8"
    name = "mass-error"
    title = "Model's mass not as weighed"
    stage = StageName.MODEL

    relative: float = parameter(0.005, -0.05, 0.05, "1", "error relative to the model's mass")
    ahead: float = parameter(
        0.0,
        -2.0,
        2.0,
        "1",
        "where it lies ahead of the centre of gravity, over half the struts' distance",
        forms=(0.5,),
    )

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with the real mass; its lump moves centre of gravity and inertia."""
        body, ahead_m = rig.body, self.ahead * rig.oscillator.half_spacing_m
        more_kg, at_m = self.relative * body.mass_kg, body.cg_x_m + ahead_m
        mass_kg = body.mass_kg + more_kg
        real = replace(
            body,
            mass_kg=mass_kg,
            cg_x_m=body.cg_x_m + more_kg * ahead_m / mass_kg,
            inertia_kg_m2=body.inertia_kg_m2 + more_kg * (at_m**2 - body.cg_x_m**2),
        )
        return replace(rig, body=real)

    def signature(self, situation: Situation) -> Signature:
        """Return the inertia of the difference, and its weight in pitch; exact."""
        body = situation.rig.body
        more = self.relative * body.mass_kg
        return mass_signature(situation, more, more * body.cg_x_m, 0.0, more * body.cg_z_m)
