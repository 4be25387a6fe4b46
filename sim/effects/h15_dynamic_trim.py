"""H15: a model that sinks and trims at speed, as far as its guides let it."""

from dataclasses import dataclass

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, OneSign, Signature, StageName, parameter
from sim.effects.hydrodynamics import AT_STRUTS, along_hull, of_hull_law
from sim.effects.situation import Situation
from sim.model.laws import Spring
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class DynamicTrim(Effect):
    """A mean, a stiffness and its curvature that grow with U^2.

    Sunk and trimmed, the hull carries more, and its waterplane is another one; at rest, and in air,
    there is nothing of it. Towards the hump of its resistance a hull trims with a higher power of
    the speed, as much at 1 m/s.
    """

    code = "H15"
    name = "dynamic-trim"
    title = "Sinkage and trim at speed"
    stage = StageName.MODEL

    load_n_s2_m2: float = parameter(2.0, -100.0, 100.0, "N s2/m2", "mean force over U^2")
    k1_n_s2_m3: float = parameter(100.0, -3000.0, 3000.0, "N s2/m3", "stiffness over U^2")
    k2_n_s2_m4: float = parameter(500.0, -3e4, 3e4, "N s2/m4", "its quadratic part over U^2")
    at_struts: float = parameter(1.0, 0.0, 1.0, "1", AT_STRUTS, one_sign=OneSign.SHARE)
    power: float = parameter(
        2.0, 1.0, 6.0, "1", "of the speed", one_sign="water at rest carries no more", forms=(3.0,)
    )

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with these loads, at the set-point's speed, along the hull."""
        square = set_point.carriage_speed_m_s**self.power
        if not square:
            return rig

        def trim(share: float) -> Spring:
            size = share * square
            return Spring(
                self.k1_n_s2_m3 * size, self.k2_n_s2_m4 * size, preload_n=self.load_n_s2_m2 * size
            )

        return along_hull(rig, trim, self.at_struts)

    def signature(self, situation: Situation) -> Signature:
        """Return the mean, the stiffness in phase, and the square of a sine."""
        square = situation.set_point.carriage_speed_m_s**2

        def wave(order: int, size: float, phase: float) -> complex:
            by_order = {
                0: self.load_n_s2_m2 + self.k2_n_s2_m4 * size**2 / 2.0,
                1: self.k1_n_s2_m3 * size * np.exp(1j * phase),
                2: -0.5j * self.k2_n_s2_m4 * size**2 * np.exp(2j * phase),
            }
            return complex(square * by_order[order])

        return of_hull_law(situation, self.at_struts, wave, 2)
