"""The force that an error of the model's mass properties makes."""

import numpy as np

from hardware.description.oscillator import Plane
from hardware.description.units import STANDARD_GRAVITY_M_S2
from sim.effects.effect import Signature
from sim.effects.situation import Situation, at_struts


def mass_signature(
    situation: Situation,
    mass_kg: float,
    moment_kg_m: float = 0.0,
    inertia_kg_m2: float = 0.0,
    height_kg_m: float = 0.0,
) -> Signature:
    """Return ``(-w^2 dM + dG) y`` at the struts.

    Parameters
    ----------
    mass_kg, moment_kg_m, inertia_kg_m2
        Changes of m, m x_G and of the inertia about the midpoint.
    height_kg_m
        Change of m z_G, whose weight restores pitch.
    """
    vertical = situation.rig.oscillator.plane is Plane.VERTICAL
    coupling = -moment_kg_m if vertical else moment_kg_m
    gravity = STANDARD_GRAVITY_M_S2 * height_kg_m if vertical else 0.0
    mass = np.array([[mass_kg, coupling], [coupling, inertia_kg_m2]])
    load = np.array([[0.0, 0.0], [0.0, gravity]]) - situation.omega**2 * mass
    to_motion = situation.system.to_motion
    return at_struts(to_motion.T @ load @ to_motion @ situation.displacement(), 1)
