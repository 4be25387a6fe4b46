"""M3: a dynamometer whose characteristic is curved."""

from dataclasses import dataclass, replace

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, Signature, StageName, parameter
from sim.effects.friction import UNLIKE, share_at
from sim.effects.measurement import of_forces, squared_forces, with_gauges
from sim.effects.situation import Situation
from sim.effects.typical import even_share, force_n
from sim.gauges.characteristic import Curve
from sim.gauges.dynamometer import Dynamometer
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class QuadraticGauge(Effect):
    """``F + q F^2``: a mean of q F^2/2, and a second order with twice the force's phase.

    It goes with the square of the force, so with w^4 a^2 where inertia dominates, and is there in
    air; the second order of a crank keeps the crank's phase instead. A gauge that is not alike in
    pull and push goes with ``|F|``, one of slender bars with a higher even power, and stops or
    thin rings bend it oddly as well, ``F^3``.
    """

    code = "M3"
    name = "quadratic-gauge"
    title = "Quadratic non-linearity of the dynamometers"
    stage = StageName.DYNAMOMETERS

    curvature_1_n: float = parameter(
        2e-6, -1e-4, 1e-4, "1/N", "q of both gauges; 0.1 % of a full scale of 500 N is 2e-6"
    )
    power: float = parameter(
        2.0,
        1.0,
        6.0,
        "1",
        "of the force's size",
        one_sign="what is calibrated is right for small forces",
        forms=(1.0, 4.0),
    )
    cubic: float = parameter(
        0.0, -2.0, 2.0, "1", "odd part, of the third power, over the even one", forms=(0.5,)
    )
    unlike: float = parameter(0.0, -1.0, 1.0, "1", UNLIKE, forms=(0.3,))

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with this curvature on top of what the gauges have."""
        force = force_n(rig)

        def curved(gauge: Dynamometer, strut: int) -> Dynamometer:
            q = self.curvature_1_n * share_at(strut, self.unlike)
            if self.power == 2.0 and not self.cubic:
                return replace(gauge, curvature_1_n=gauge.curvature_1_n + q)
            as_large = even_share(2.0) / even_share(self.power)
            even = Curve(as_large * q * force, force, self.power)
            odd = Curve(self.cubic * q * force, force, 3.0, odd=True)
            return replace(gauge, curves=(*gauge.curves, even, odd))

        return with_gauges(rig, curved)

    def signature(self, situation: Situation) -> Signature:
        """Return q times the harmonics of the force squared."""
        squares = squared_forces(situation)
        return of_forces(situation, lambda order, _: self.curvature_1_n * squares[order])
