"""H3: damping that grows with the square of the velocity: separation at bilges and keel."""

from dataclasses import dataclass

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, OneSign, Signature, StageName, parameter
from sim.effects.friction import BOTH_MOTIONS, with_damping
from sim.effects.hydrodynamics import of_law
from sim.effects.situation import Situation
from sim.model.law_point import Point
from sim.model.laws import Quadratic
from sim.rig import SimulatedRig

HIGHEST = 5


@dataclass(frozen=True)
class QuadraticDamping(Effect):
    """``B v|v|``: ``8/(3 pi) B V^2`` in quadrature, and a fifth of it at order 3, of the same sign.

    It goes with w^2 a^2; absent in air. At small amplitudes the drag coefficient falls as its power
    -1/3 for a plate (J. M. R. Graham, J. Fluid Mech. 97, 1980), so that the force goes with a power
    of 5/3; that of a round bilge grows with the amplitude.
    """

    code = "H3"
    name = "quadratic-damping"
    title = "Quadratic damping"
    stage = StageName.MODEL

    translation_n_s2_m2: float = parameter(
        300.0,
        0.0,
        20000.0,
        "N s2/m2",
        "of heave or sway through the water: C_D rho S/2",
        one_sign=OneSign.DAMPING,
    )
    rotation_n_m_s2: float = parameter(
        50.0, 0.0, 10000.0, "N m s2", "of pitch or yaw", one_sign=OneSign.DAMPING
    )
    power: float = parameter(
        2.0,
        1.0,
        3.0,
        "1",
        "of the velocity",
        one_sign="drag grows with the speed",
        forms=(5.0 / 3.0, 2.5),
    )

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with this damping of both motions."""
        sizes = (self.translation_n_s2_m2, self.rotation_n_m_s2)
        return with_damping(rig, sizes, 2.0, self.power, Quadratic)

    def signature(self, situation: Situation) -> Signature:
        """Return the describing function of ``cos|cos|``, 8/3pi, 8/15pi, -8/105pi."""
        sizes = dict(
            zip(BOTH_MOTIONS, (self.translation_n_s2_m2, self.rotation_n_m_s2), strict=True)
        )

        def wave(order: int, speed: float, phase: float, point: Point) -> complex:
            if order % 2 == 0:
                return 0.0
            share = 8.0 * np.sin(order * np.pi / 2.0) / (order * np.pi * (4 - order**2))
            # The velocity V sin(th + phase) is V cos of a quarter turn less.
            turned = 1j * np.exp(1j * order * (phase - np.pi / 2.0))
            return complex(sizes[point] * speed**2 * share * turned)

        return of_law(situation, BOTH_MOTIONS, wave, HIGHEST)
