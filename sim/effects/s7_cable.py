"""S7: a cable or umbilical between the model and the carriage."""

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.acting import Acting, Point
from sim.effects.effect import Effect, Signature, StageName, parameter
from sim.effects.situation import Situation, at_struts
from sim.laws import RubbingSpring, Spring
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class Cable(Effect):
    """``F_0 + k x + k_2 x^2 + k_3 x^3 + k_h |x| sgn(v)`` on the translation x at the midpoint.

    Independent of frequency: in phase ``k x + 3 k_3 x^3/4``, in quadrature ``2 k_h x/pi`` from the
    strands that rub on each other.
    """

    code: ClassVar[str] = "S7"
    name: ClassVar[str] = "cable"
    title: ClassVar[str] = "Cable between model and carriage"
    stage: ClassVar[StageName] = StageName.STRUCTURE

    stiffness_n_m: float = parameter(5.0, 0.0, 100.0, "N/m", "stiffness")
    rubbing_n_m: float = parameter(1.0, 0.0, 50.0, "N/m", "friction per displacement")
    preload_n: float = parameter(0.0, -20.0, 20.0, "N", "force in the middle position")
    stiffness_n_m2: float = parameter(0.0, -1e3, 1e3, "N/m2", "asymmetry of the stiffness")
    stiffness_n_m3: float = parameter(0.0, 0.0, 1e5, "N/m3", "stiffening")

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with the cable at the midpoint between the struts."""
        spring = Spring(
            self.stiffness_n_m, self.stiffness_n_m2, self.stiffness_n_m3, self.preload_n
        )
        added: tuple[Acting, ...] = (Acting(spring, Point.TRANSLATION),)
        if self.rubbing_n_m:
            added = (*added, Acting(RubbingSpring(self.rubbing_n_m), Point.TRANSLATION))
        return replace(rig, forces=(*rig.forces, *added))

    def signature(self, situation: Situation) -> Signature:
        """Return the powers of a sine, and the loop of the rubbing strands; exact."""
        along = situation.system.to_motion[0]
        x = complex(along @ situation.displacement())
        size, rubbing = abs(x), 1j * (2.0 / np.pi) * self.rubbing_n_m * abs(x)
        turn = x / size if size else 0j
        force = {
            0: self.preload_n + self.stiffness_n_m2 * size**2 / 2.0,
            1: (self.stiffness_n_m + 0.75 * self.stiffness_n_m3 * size**2) * x + rubbing * turn,
            2: -1j * self.stiffness_n_m2 * x**2 / 2.0,
            3: -self.stiffness_n_m3 * x**3 / 4.0 - rubbing * turn**3,
            5: rubbing * turn**5 / 3.0,
        }
        predicted: dict[tuple[str, int], complex] = {}
        for order, value in force.items():
            predicted |= at_struts(value * along, order)
        return predicted
