"""K5: struts keep to their own lines while the model turns: its angle is an arc sine."""

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.acting import Acting, Point
from sim.effects.effect import Effect, Signature, StageName
from sim.effects.situation import Situation, at_struts
from sim.hull_system import HullSystem
from sim.laws import ArcSine
from sim.rig import SimulatedRig
from sim.signals import FloatArray


@dataclass(frozen=True)
class Foreshortening(Effect):
    """The angle ``asin(s sin)`` has a third harmonic of s^3/24, s = e/l in pure pitch.

    Grows with the amplitude cubed; nothing where both struts move alike. The surge of the model,
    l s^2/4 at twice the frequency, is no signal of this rig. The water's memory and the coupling
    with the translation do not see the small change of the angle.
    """

    code: ClassVar[str] = "K5"
    name: ClassVar[str] = "foreshortening"
    title: ClassVar[str] = "Struts on parallel lines: the model's angle is an arc sine"
    stage: ClassVar[StageName] = StageName.MECHANISM

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with what the couple has more than the linear one."""
        system = Situation.system_of(rig, set_point)
        law = ArcSine(*(float(one) for one in _rotation(system)))
        return replace(rig, forces=(*rig.forces, Acting(law, Point.ROTATION)))

    def signature(self, situation: Situation) -> Signature:
        """Return the leading term: u^3/6 of the angle, and u^2/2 of the lever."""
        system = situation.system
        inertia, damping, stiffness = _rotation(system)
        u = complex(system.to_motion[1] @ situation.displacement())
        couple = complex((np.linalg.inv(system.to_motion).T @ situation.force())[1])
        size, double = abs(u), (u / abs(u)) ** 2 if u else 0.0
        s = 1j * situation.omega * np.array([1.0, 3.0])
        first, third = inertia * s**2 + damping * s + stiffness
        lever = (size**2 / 4.0) * (couple + double * couple.conjugate() / 2.0)
        found = {
            1: first * u * size**2 / 8.0 + lever,
            3: -third * u**3 / 24.0 - couple * u**2 / 8.0,
        }
        predicted: dict[tuple[str, int], complex] = {}
        for order, extra in found.items():
            predicted |= at_struts(extra * system.to_motion[1], order)
        return predicted


def _rotation(system: HullSystem) -> FloatArray:
    """Return inertia, damping and stiffness of the rotation about the midpoint."""
    from_motion = np.linalg.inv(system.to_motion)
    matrices = (system.mass, system.damping, system.stiffness)
    return np.array([(from_motion.T @ one @ from_motion)[1, 1] for one in matrices])
