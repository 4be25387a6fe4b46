"""H10: a tank that is narrow: the water flows past the model faster than the carriage runs."""

from dataclasses import dataclass, replace

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, Signature, StageName, parameter
from sim.effects.hydrodynamics import faster
from sim.effects.situation import Situation
from sim.model.water.tank import blockage_speed_factor
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class Blockage(Effect):
    """A mean flow of ``U/(1 - A_m/A_t)``, by continuity; the recorded carriage speed stays.

    As an error of the speed, without a trace of it in the speed's record; loads that go with U^2
    follow as well.
    """

    code = "H10"
    name = "blockage"
    title = "Blockage by a narrow tank"
    stage = StageName.MODEL

    section_ratio: float = parameter(
        0.01,
        0.0,
        0.1,
        "1",
        "section of the model over the tank's",
        one_sign="a model only narrows the tank",
    )

    @property
    def factor(self) -> float:
        """Speed of the flow over the carriage's."""
        return blockage_speed_factor(self.section_ratio, 1.0)

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with a faster flow, on top of what the tank does already."""
        return replace(rig, flow_factor=rig.flow_factor * self.factor)

    def signature(self, situation: Situation) -> Signature:
        """Return the linear loads of the additional speed."""
        ratio = self.section_ratio
        return faster(situation, situation.flow_m_s * ratio / (1.0 - ratio))
