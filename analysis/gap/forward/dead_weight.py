"""A rig with a dead weight hung on its model, as a further run is proposed with one."""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

from analysis.gap.observe.components import GapRun
from hardware.description.body import Body
from hardware.description.units import STANDARD_GRAVITY_M_S2
from sim.effects.effect import Effect
from sim.model.hull import Hull
from sim.model.law_point import Acting
from sim.model.laws import Spring
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class _WeightedRig(SimulatedRig):
    """A rig with a dead weight on the model; its gauges were tared without."""

    tared_body: Body | None = None

    def lifted_n(self, hull: Hull) -> tuple[float, float]:
        """Return what the struts hold at rest without the weight; a law has its force."""
        return super().lifted_n(replace(hull, body=self.tared_body or hull.body))


def with_dead_weight(
    effects: Sequence[Effect], rig: SimulatedRig, run: GapRun
) -> tuple[Sequence[Effect], SimulatedRig]:
    """Return the rig with a run's dead weight on the model, and the effects that it leaves.

    The weight hangs at the midpoint between the struts, and its mass moves with the model: the
    moments of the model's own mass and inertia about that point stay as they are.
    """
    if not run.preload_n:
        return effects, rig
    weight = Acting(Spring(preload_n=run.preload_n))
    remaining_effects = [effect for effect in effects if not effect.taken_up]
    body, mass_kg = rig.body, rig.body.mass_kg + run.preload_n / STANDARD_GRAVITY_M_S2
    share = body.mass_kg / mass_kg
    heavier = replace(body, mass_kg=mass_kg, cg_x_m=share * body.cg_x_m, cg_z_m=share * body.cg_z_m)
    own = {each.name: getattr(rig, each.name) for each in fields(SimulatedRig)}
    own |= {"body": heavier, "forces": (*rig.forces, weight)}
    return remaining_effects, _WeightedRig(**own, tared_body=body)
