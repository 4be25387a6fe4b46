"""K5: the other end of a strut slides as the model turns, and so its angle is another."""

from dataclasses import dataclass, replace

import numpy as np

from hardware.description.arrangement import Joint, Pivot
from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, Signature, StageName
from sim.effects.situation import Situation, at_struts
from sim.rig import SimulatedRig

_OTHER = {
    Joint.SLIDES_ON_MODEL: Joint.SLIDES_ON_RIG,
    Joint.SLIDES_ON_RIG: Joint.SLIDES_ON_MODEL,
}


@dataclass(frozen=True)
class Foreshortening(Effect):
    """The difference of the struts over their spacing 2 l is the angle's sine, not its tangent.

    That is where the struts keep their distance on the model, and one slides along the rig; where
    the rig's description says so, they keep it on the rig and one attachment slides. With s for
    the tangent it is as if the strut that slides moved by l s^3 more, and it carries s^2/2 more of
    its force, which the other does less. Grows with the amplitude cubed; nothing where both struts
    move alike.
    """

    code = "K5"
    name = "foreshortening"
    title = "The joint slides at its other end: sine for tangent of the angle"
    stage = StageName.MECHANISM

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with the other joint."""
        joint = _OTHER.get(rig.oscillator.joint, rig.oscillator.joint)
        return replace(rig, oscillator=replace(rig.oscillator, joint=joint))

    def signature(self, situation: Situation) -> Signature:
        """Return the leading term: s^3 of the motion, and s^2/2 of the lever."""
        oscillator = situation.rig.oscillator
        sign = 1.0 if oscillator.joint is Joint.SLIDES_ON_MODEL else -1.0
        slide = 1 if oscillator.pivot is Pivot.AFT else 0
        aft, fore = situation.displacement()
        s = complex(fore - aft) / (2.0 * oscillator.half_spacing_m)
        if slide == 0:
            s = -s
        force = complex(situation.force()[slide])
        lever = {
            1: abs(s) ** 2 * force / 4.0 + s**2 * force.conjugate() / 8.0,
            3: -(s**2) * force / 8.0,
        }
        moved = {1: 0.75 * abs(s) ** 2 * s, 3: -(s**3) / 4.0}
        along = np.eye(2)[slide] * oscillator.half_spacing_m
        shift = np.eye(2)[slide] - np.eye(2)[1 - slide]
        predicted: dict[tuple[str, int], complex] = {}
        for order, extra in lever.items():
            change = situation.impedance(order) @ (moved[order] * along) + extra * shift
            predicted |= at_struts(sign * change, order)
        return predicted
