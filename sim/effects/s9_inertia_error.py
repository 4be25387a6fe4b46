"""S9: a model whose inertia or centre of gravity is not the one that was measured."""

from dataclasses import dataclass, replace

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, Signature, StageName, parameter
from sim.effects.inertia import mass_signature
from sim.effects.situation import Situation
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class InertiaError(Effect):
    """``m dx w^2`` couples translation and rotation; ``m g dz`` restores pitch; ``-dI w^2``.

    The static moment of dx is tared away with the model in place.
    """

    code = "S9"
    name = "inertia-error"
    title = "Model's inertia or centre of gravity not as measured"
    stage = StageName.MODEL

    inertia_relative: float = parameter(
        0.01, -0.1, 0.1, "1", "error relative to the inertia about the midpoint"
    )
    cg_x_m: float = parameter(0.002, -0.02, 0.02, "m", "centre of gravity too far forward by")
    cg_z_m: float = parameter(0.002, -0.02, 0.02, "m", "centre of gravity too low by")

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with the real inertia and centre of gravity."""
        body = replace(
            rig.body,
            inertia_kg_m2=rig.body.inertia_kg_m2 * (1.0 + self.inertia_relative),
            cg_x_m=rig.body.cg_x_m + self.cg_x_m,
            cg_z_m=rig.body.cg_z_m + self.cg_z_m,
        )
        return replace(rig, body=body)

    def signature(self, situation: Situation) -> Signature:
        """Return the inertia and the weight of the difference; exact."""
        body = situation.rig.body
        return mass_signature(
            situation,
            0.0,
            body.mass_kg * self.cg_x_m,
            body.inertia_kg_m2 * self.inertia_relative,
            body.mass_kg * self.cg_z_m,
        )
