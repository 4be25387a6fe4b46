"""S3: Coulomb friction below the dynamometer: seals, trim guides."""

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, OneSign, Signature, StageName, parameter
from sim.effects.situation import Situation, at_struts
from sim.model.law_point import Acting, Point
from sim.model.laws import Coulomb
from sim.rig import SimulatedRig

HIGHEST = 5


@dataclass(frozen=True)
class CoulombFriction(Effect):
    """``F_c sgn(v)`` at each strut: ``+-4 F_c / (n pi)`` in quadrature at odd orders.

    Independent of frequency and amplitude; present in air.
    """

    code: ClassVar[str] = "S3"
    name: ClassVar[str] = "coulomb-friction"
    title: ClassVar[str] = "Coulomb friction below the dynamometer"
    stage: ClassVar[StageName] = StageName.STRUCTURE

    friction_n: float = parameter(
        0.3, 0.0, 5.0, "N", "friction force at each strut", one_sign=OneSign.FRICTION
    )

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with the friction at both struts."""
        law = Coulomb(self.friction_n)
        added = (Acting(law, Point.AFT), Acting(law, Point.FORE))
        return replace(rig, forces=(*rig.forces, *added))

    def signature(self, situation: Situation) -> Signature:
        """Return the describing function: a square wave with the velocity's sign."""
        predicted: dict[tuple[str, int], complex] = {}
        for order in range(1, HIGHEST + 1, 2):
            sign = (-1.0) ** ((order - 1) // 2)
            size = sign * 4.0 * self.friction_n / (order * np.pi)
            # cos(n theta) of each strut's own crank angle.
            values = 1j * size * situation.turn**order
            predicted |= at_struts(values, order)
        return predicted
