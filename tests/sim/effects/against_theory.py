"""What the tests of the effects compare with: simulated signatures against stated ones.

Theories that rest on small angles are held to rigs whose model turns little though its struts move
as they do: they stand far apart.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from hardware.description.setpoint import SetPoint
from hardware.description.units import STANDARD_GRAVITY_M_S2
from sim.effects.agreement import mismatch, phasor
from sim.effects.effect import Effect
from sim.model.parameters import HullCoefficients
from sim.rig import SimulatedRig
from sim.solve.linear_system import as_rows

__all__ = ["STRETCH", "at_small_angles", "mismatch", "phasor", "small_angles"]

STRETCH = 1e4  # angles of 0.06 become 6e-6: 4e-11 of a force is of second order


def at_small_angles(
    effect: Effect,
    rig: SimulatedRig,
    set_points: Sequence[SetPoint],
    orders: int = 12,
    points: int = 128,
) -> float:
    """Return the mismatch on the rig of :func:`small_angles`, at the same angles of attack."""
    there = [
        replace(one, carriage_speed_m_s=STRETCH * one.carriage_speed_m_s) for one in set_points
    ]
    return mismatch(effect, small_angles(rig), there, orders, points)


def small_angles(rig: SimulatedRig) -> SimulatedRig:
    """Return a rig with the same forces at the struts, which stand ``STRETCH`` times as far apart.

    Moments are as many times larger and angles as many times smaller. The weight's stiffness goes
    into the restoring.
    """
    by = np.array([1.0, STRETCH])
    weight = rig.body.mass_kg * STANDARD_GRAVITY_M_S2 * rig.body.cg_z_m
    if rig.oscillator.plane == "horizontal":
        weight = 0.0
    water, scale = rig.water, np.outer(by, by)
    restoring = np.array(water.restoring) + np.diag([0.0, weight])
    matrices = (water.added_mass, water.damping, restoring)
    body = rig.body
    return replace(
        rig,
        oscillator=replace(rig.oscillator, half_spacing_m=STRETCH * rig.oscillator.half_spacing_m),
        body=replace(
            body,
            inertia_kg_m2=STRETCH**2 * body.inertia_kg_m2,
            cg_x_m=STRETCH * body.cg_x_m,
            cg_z_m=0.0,
        ),
        water=HullCoefficients(*(as_rows(scale * np.array(one)) for one in matrices)),  # type: ignore[arg-type]  # two by two
    )
