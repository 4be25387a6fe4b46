"""H4: damping that grows with the third power of the velocity."""

from dataclasses import dataclass

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, OneSign, Signature, StageName, parameter
from sim.effects.friction import BOTH_MOTIONS, with_damping
from sim.effects.hydrodynamics import of_law
from sim.effects.situation import Situation
from sim.model.law_point import Point
from sim.model.laws import Cubic
from sim.rig import SimulatedRig

SHARES = {1: 0.75, 3: 0.25}  # of cos^3


@dataclass(frozen=True)
class CubicDamping(Effect):
    """``B v^3``: ``3/4 B V^3`` in quadrature, and a third of it with the same sign at order 3.

    It goes with w^3 a^3; absent in air. As a polynomial's last term it stands for powers from 2.5
    to 3.5, whatever else there is.
    """

    code = "H4"
    name = "cubic-damping"
    title = "Cubic damping"
    stage = StageName.MODEL

    translation_n_s3_m3: float = parameter(
        500.0,
        0.0,
        50000.0,
        "N s3/m3",
        "of heave or sway through the water",
        one_sign=OneSign.DAMPING,
    )
    rotation_n_m_s3: float = parameter(
        80.0, 0.0, 20000.0, "N m s3", "of pitch or yaw", one_sign=OneSign.DAMPING
    )
    power: float = parameter(
        3.0,
        2.0,
        4.0,
        "1",
        "of the velocity",
        one_sign="drag grows with the speed",
        forms=(2.5, 3.5),
    )

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with this damping of both motions."""
        sizes = (self.translation_n_s3_m3, self.rotation_n_m_s3)
        return with_damping(rig, sizes, 3.0, self.power, Cubic)

    def signature(self, situation: Situation) -> Signature:
        """Return the describing function of ``cos^3``."""
        sizes = dict(
            zip(BOTH_MOTIONS, (self.translation_n_s3_m3, self.rotation_n_m_s3), strict=True)
        )

        def wave(order: int, speed: float, phase: float, point: Point) -> complex:
            turned = 1j * np.exp(1j * order * (phase - np.pi / 2.0))
            return complex(sizes[point] * speed**3 * SHARES.get(order, 0.0) * turned)

        return of_law(situation, BOTH_MOTIONS, wave, 3)
