"""D1: a speed that varies over a revolution: eccentric gears, a joint."""

from dataclasses import dataclass, replace

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.drive.prescribed_drive import SpeedRipple
from sim.effects.effect import Effect, OneSign, Signature, StageName, parameter
from sim.effects.shaft import uneven_signature
from sim.effects.situation import Situation
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class SpeedRippleEffect(Effect):
    """The shaft is at ``w t + (rho/k) sin(k w t + psi)``: harmonics k - 1 and k + 1 of the motion.

    Both are ``e rho/(2 k)``, in proportion to the amplitude and independent of the frequency. An
    order that is no whole number (a belt) gives lines beside the harmonics. Teeth and joints make
    no pure sine: its double is beside it.
    """

    code = "D1"
    name = "speed-ripple"
    title = "Speed that varies over a revolution"
    stage = StageName.DRIVE

    relative: float = parameter(
        0.005, 0.0, 0.03, "1", "amplitude of the speed over its mean", one_sign=OneSign.AMPLITUDE
    )
    order: float = parameter(
        1.0,
        0.1,
        10.0,
        "1",
        "times a revolution",
        starts=(1.0, 2.0, 3.0),
        held=True,
        one_sign=OneSign.COUNT,
    )
    phase_rad: float = parameter(0.0, -np.pi, np.pi, "rad", "phase at the shaft's zero")

    double: float = parameter(
        0.0,
        0.0,
        1.0,
        "1",
        "amplitude at twice the order, over that at the order",
        held=True,
        one_sign=OneSign.AMPLITUDE,
    )
    double_phase_rad: float = parameter(
        0.0, -np.pi, np.pi, "rad", "its phase at the shaft's zero", held=True
    )

    def forms(self) -> tuple[Effect, ...]:
        """Return waves that are no sine: a third at twice the order, in two phases."""
        with_double = replace(self, double=0.3)
        return (with_double, replace(with_double, double_phase_rad=np.pi / 2.0))

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with this ripple on its drive."""
        ripples = [SpeedRipple(self.order, self.relative, self.phase_rad)]
        if self.double:
            twice = self.double * self.relative
            ripples.append(SpeedRipple(2.0 * self.order, twice, self.double_phase_rad))
        return replace(rig, drive=replace(rig.drive, ripple=(*rig.drive.ripple, *ripples)))

    def signature(self, situation: Situation) -> Signature:
        """Return the modulated motion and the model's reaction to it; exact to the third power."""
        order = round(self.order)
        if order != self.order:
            return {}
        wave = -1j * (self.relative / order) * np.exp(1j * self.phase_rad)
        return uneven_signature(situation, {order: complex(wave)})
