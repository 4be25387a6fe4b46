"""M2: a dynamometer that feels what another one, or the drag, is loaded with."""

from dataclasses import dataclass, replace

from hardware.description.arrays import ComplexArray
from hardware.description.setpoint import Medium, SetPoint
from sim.effects.effect import Effect, Signature, StageName, parameter
from sim.effects.measurement import of_forces, with_gauges
from sim.effects.situation import Situation
from sim.gauges.dynamometer import Dynamometer
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class CrossTalk(Effect):
    """``F_i + c_i F_j`` of the other strut, and a mean that grows with the square of the speed.

    The first changes its sign against the strut's own force between heave and pitch. The second is
    what both gauges feel of the drag, whose small part at twice the frequency is left out.
    """

    code = "M2"
    name = "cross-talk"
    title = "Cross-talk between the dynamometers, and from the drag"
    stage = StageName.DYNAMOMETERS

    aft: float = parameter(0.01, -0.1, 0.1, "1", "what the aft gauge feels of the fore force")
    fore: float = parameter(0.01, -0.1, 0.1, "1", "what the fore gauge feels of the aft force")
    drag_n_s2_m2: float = parameter(
        0.0, -2.0, 2.0, "N s2/m2", "what each gauge feels of the drag, per speed squared"
    )

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with these shares on top of what the dynamometers have."""
        old = rig.dynamometers
        dynamometers = replace(
            old,
            cross_talk_aft=old.cross_talk_aft + self.aft,
            cross_talk_fore=old.cross_talk_fore + self.fore,
        )
        felt = self._felt_drag(set_point)

        def loaded(dynamometer: Dynamometer, _: int) -> Dynamometer:
            return replace(dynamometer, offset_n=dynamometer.offset_n + dynamometer.gain * felt)

        return with_gauges(replace(rig, dynamometers=dynamometers), loaded)

    def signature(self, situation: Situation) -> Signature:
        """Return ``c F_n`` of the other strut, and the drag's share as a mean."""
        felt = self._felt_drag(situation.set_point)

        def change(order: int, force: ComplexArray) -> ComplexArray:
            from_other: ComplexArray = force[::-1] * (self.aft, self.fore)
            return from_other + felt if order == 0 else from_other

        return of_forces(situation, change)

    def _felt_drag(self, set_point: SetPoint) -> float:
        in_water = set_point.medium is Medium.WATER
        return self.drag_n_s2_m2 * set_point.carriage_speed_m_s**2 if in_water else 0.0
