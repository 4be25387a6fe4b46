"""S11: struts and brackets below the dynamometers, which move and are wet like the model."""

from dataclasses import dataclass, replace

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, OneSign, Signature, StageName, parameter
from sim.effects.situation import Situation, at_struts
from sim.model.law_point import Acting, Point
from sim.model.laws import Quadratic, Viscous
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class StrutTare(Effect):
    """``-m w^2 y``, and in water linear and quadratic drag, of each strut by itself.

    As the model's own; a run without the model shows it.
    """

    code = "S11"
    name = "strut-tare"
    title = "Struts and brackets below the dynamometers"
    stage = StageName.MODEL

    mass_kg: float = parameter(
        1.0, 0.0, 10.0, "kg", "mass of each strut below its dynamometer", one_sign=OneSign.MASS
    )
    viscous_n_s_m: float = parameter(
        2.0, 0.0, 50.0, "N s/m", "linear drag of each strut", one_sign=OneSign.DAMPING
    )
    quadratic_n_s2_m2: float = parameter(
        5.0, 0.0, 200.0, "N s2/m2", "quadratic drag of each strut", one_sign=OneSign.DAMPING
    )

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with the struts' mass in the body, and their drag in water."""
        body, struts_kg = rig.body, 2.0 * self.mass_kg
        share = body.mass_kg / (body.mass_kg + struts_kg)
        heavier = replace(
            body,
            mass_kg=body.mass_kg + struts_kg,
            inertia_kg_m2=body.inertia_kg_m2 + struts_kg * rig.oscillator.half_spacing_m**2,
            cg_x_m=body.cg_x_m * share,
            cg_z_m=body.cg_z_m * share,
        )
        laws = (Viscous(self.viscous_n_s_m), Quadratic(self.quadratic_n_s2_m2))
        struts = (Point.AFT, Point.FORE)
        added = (Acting(law, strut, in_water=True) for law in laws for strut in struts)
        return replace(rig, body=heavier, forces=(*rig.forces, *added))

    def signature(self, situation: Situation) -> Signature:
        """Return inertia, linear drag, and the describing function of v|v|; exact."""
        speed = situation.omega * situation.amplitude_m
        force = {1: -situation.omega * speed * self.mass_kg + 0j}
        if situation.in_water:
            quadratic = 1j * self.quadratic_n_s2_m2 * speed**2 * 8.0 / np.pi
            force[1] += quadratic / 3.0 + 1j * self.viscous_n_s_m * speed
            force |= {3: quadratic / 15.0, 5: -quadratic / 105.0}
        predicted: dict[tuple[str, int], complex] = {}
        for order, value in force.items():
            predicted |= at_struts(value * situation.turn**order, order)
        return predicted
