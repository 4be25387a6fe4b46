"""S3: Coulomb friction below the dynamometer: seals, trim guides."""

from dataclasses import dataclass

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, OneSign, Signature, StageName, parameter
from sim.effects.friction import UNLIKE, at_both_struts, power_law
from sim.effects.situation import Situation, at_struts
from sim.effects.typical import speed_m_s
from sim.model.force_law import ForceLaw
from sim.model.friction import Coulomb
from sim.rig import SimulatedRig

HIGHEST = 5


@dataclass(frozen=True)
class CoulombFriction(Effect):
    """``F_c sgn(v)`` at each strut: ``+-4 F_c / (n pi)`` in quadrature at odd orders.

    Independent of frequency and amplitude; present in air. Seals and guides turn it over the
    distance in which their lips or asperities bend (Dahl), or over the speed at which a film
    carries, and rubber rubs a little more the faster it slides, ``|v|^p``.
    """

    code = "S3"
    name = "coulomb-friction"
    title = "Coulomb friction below the dynamometer"
    stage = StageName.STRUCTURE

    friction_n: float = parameter(
        0.3, 0.0, 5.0, "N", "friction force at each strut", one_sign=OneSign.FRICTION
    )
    presliding_m: float = parameter(
        0.0,
        0.0,
        2e-3,
        "m",
        "distance in which bristles bend the other way, 0 for none",
        one_sign=OneSign.LENGTH,
        forms=(4e-4,),
    )
    film_m_s: float = parameter(
        0.0,
        0.0,
        0.05,
        "m/s",
        "speed over which it turns in place of that, 0 for none",
        one_sign=OneSign.LUBRICATION,
        forms=(6e-3,),
    )
    speed_power: float = parameter(
        0.0,
        0.0,
        0.5,
        "1",
        "power of the speed that it grows with in place of both",
        one_sign=OneSign.LUBRICATION,
        forms=(0.1,),
    )
    unlike: float = parameter(0.0, -1.0, 1.0, "1", UNLIKE, forms=(0.3,))

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with the friction at both struts."""
        return at_both_struts(rig, self._law(rig), self.unlike)

    def _law(self, rig: SimulatedRig) -> ForceLaw:
        if self.speed_power:
            return power_law(self.friction_n, 0.0, self.speed_power, speed_m_s(rig))
        return Coulomb(self.friction_n, 0.0, self.presliding_m or None, self.film_m_s or None)

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
