"""H5: restoring that is not proportional: a flaring hull, a deck edge."""

from dataclasses import dataclass

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, OneSign, Signature, StageName, parameter
from sim.effects.hydrodynamics import AT_STRUTS, along_hull, of_hull_law
from sim.effects.situation import Situation
from sim.effects.typical import amplitude_m, even_share, power_share
from sim.model.laws import Spring, Stiffening
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class NonlinearRestoring(Effect):
    """``k2 y^2 + k3 y^3`` of the whole hull: flare at its ends, or amidships.

    ``k2 a^2/2`` as a mean and against it at order 2, ``3/4 k3 a^3`` in phase and ``-1/4 k3 a^3`` at
    order 3; independent of the frequency, absent in air. A knuckle or a chine makes other powers
    of a polynomial's two; they are as large at a typical motion.
    """

    code = "H5"
    name = "nonlinear-restoring"
    title = "Non-linear restoring"
    stage = StageName.MODEL

    k2_n_m2: float = parameter(5000.0, -1e5, 1e5, "N/m2", "quadratic part, in heave")
    k3_n_m3: float = parameter(50000.0, -2e6, 2e6, "N/m3", "cubic part, in heave")
    at_struts: float = parameter(1.0, 0.0, 1.0, "1", AT_STRUTS, one_sign=OneSign.SHARE)
    steeper: float = parameter(
        0.0,
        -1.0,
        3.0,
        "1",
        "by which both powers are higher",
        one_sign="a hull has no jumps",
        forms=(-0.5, 1.0),
    )

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with this restoring along the hull."""
        if not self.steeper:
            return along_hull(
                rig,
                lambda share: Spring(0.0, share * self.k2_n_m2, share * self.k3_n_m3),
                self.at_struts,
            )
        way = amplitude_m(rig)
        even, odd = 2.0 + self.steeper, 3.0 + self.steeper
        flare = self.k2_n_m2 * way**2 * even_share(2.0) / even_share(even)
        wall = self.k3_n_m3 * way**3 * power_share(3.0) / power_share(odd)
        flaring = along_hull(
            rig, lambda share: Stiffening(share * flare, way, even, even=True), self.at_struts
        )
        return along_hull(flaring, lambda share: Stiffening(share * wall, way, odd), self.at_struts)

    def signature(self, situation: Situation) -> Signature:
        """Return the powers of a sine."""

        def wave(order: int, size: float, phase: float) -> complex:
            square = {0: 0.5, 2: -0.5j * np.exp(2j * phase)}
            cube = {1: 0.75 * np.exp(1j * phase), 3: -0.25 * np.exp(3j * phase)}
            quadratic = self.k2_n_m2 * size**2 * square.get(order, 0.0)
            return complex(quadratic + self.k3_n_m3 * size**3 * cube.get(order, 0.0))

        return of_hull_law(situation, self.at_struts, wave, 3)
