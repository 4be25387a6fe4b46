"""H11: a carriage that runs faster, or slower, than it was told."""

from dataclasses import dataclass, replace

from hardware.description import channels
from hardware.description.setpoint import SetPoint
from sim import signals
from sim.effects.effect import Effect, OneSign, Signature, StageName, parameter
from sim.effects.hydrodynamics import faster
from sim.effects.situation import Situation
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class CarriageSpeedError(Effect):
    """A mean speed of ``U (1 + d)``: what goes with the speed changes by d, with U^2 by 2 d.

    The speed's record, where there is one, shows it. Without speed it does nothing, nor in air but
    for that record. A tachometer's zero makes an error that is the same at all speeds, as large at
    1 m/s.
    """

    code = "H11"
    name = "carriage-speed"
    title = "Error of the carriage's mean speed"
    stage = StageName.CARRIAGE

    relative: float = parameter(0.003, -0.05, 0.05, "1", "d, relative to the speed")
    steady: float = parameter(
        0.0,
        0.0,
        1.0,
        "1",
        "share of it that is the same at all speeds, per 1 m/s",
        one_sign=OneSign.SHARE,
        forms=(1.0,),
    )

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with this error on top of the carriage's own."""
        speed = set_point.carriage_speed_m_s
        fixed = self.steady / speed if speed else 0.0  # a carriage that stands is braked
        relative = self.relative * (1.0 - self.steady + fixed)
        error = (1.0 + rig.carriage.speed_error) * (1.0 + relative) - 1.0
        return replace(rig, carriage=replace(rig.carriage, speed_error=error))

    def signature(self, situation: Situation) -> Signature:
        """Return the linear loads of the additional speed, and the speed's record."""
        changes = dict(faster(situation, situation.flow_m_s * self.relative))
        recorded = signals.recorded(channels.CARRIAGE_SPEED).name
        if situation.rig.acquisition.carriage_speed is not None:
            changes[recorded, 0] = situation.phasor(recorded, 0) * self.relative
        return changes
