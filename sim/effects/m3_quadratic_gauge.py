"""M3: a dynamometer whose characteristic is curved."""

from dataclasses import dataclass, replace
from typing import ClassVar

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, Signature, StageName, parameter
from sim.effects.measurement import of_forces, squared, with_gauges
from sim.effects.situation import Situation
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class QuadraticGauge(Effect):
    """``F + q F^2``: a mean of q F^2/2, and a second order with twice the force's phase.

    It goes with the square of the force, so with w^4 a^2 where inertia dominates, and is there in
    air; the second order of a crank keeps the crank's phase instead.
    """

    code: ClassVar[str] = "M3"
    name: ClassVar[str] = "quadratic-gauge"
    title: ClassVar[str] = "Quadratic non-linearity of the dynamometers"
    stage: ClassVar[StageName] = StageName.DYNAMOMETERS

    curvature_1_n: float = parameter(
        2e-6, -1e-4, 1e-4, "1/N", "q of both gauges; 0.1 % of a full scale of 500 N is 2e-6"
    )

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with this curvature on top of what the gauges have."""
        return with_gauges(
            rig,
            lambda gauge, _: replace(gauge, curvature_1_n=gauge.curvature_1_n + self.curvature_1_n),
        )

    def signature(self, situation: Situation) -> Signature:
        """Return q times the harmonics of the force squared."""
        squares = squared(situation)
        return of_forces(situation, lambda order, _: self.curvature_1_n * squares[order])
