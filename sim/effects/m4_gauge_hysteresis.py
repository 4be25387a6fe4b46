"""M4: a dynamometer whose reading lags behind the force in a Rayleigh loop."""

import math
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, OneSign, Signature, StageName, parameter
from sim.effects.friction import UNLIKE, share_at
from sim.effects.measurement import with_gauges
from sim.effects.situation import RECORDED_FORCES, Situation, at_struts
from sim.effects.typical import force_n
from sim.gauges.characteristic import Loop, PowerLoop, SaturatingLoop
from sim.gauges.dynamometer import Dynamometer
from sim.rig import SimulatedRig

HIGHEST = 5
_SLIGHT: Final = 1e-4  # a typical force over that of the widest loop: less is no bend at all


@dataclass(frozen=True)
class GaugeHysteresis(Effect):
    """A loop of half width ``(beta/2)(F_m^2 - F^2)``: odd orders, in quadrature to the *force*.

    The third is a fifth of the first, with the same sign. It goes with the force squared and looks
    like damping that changes its sign where inertia and restoring cancel. Rayleigh's law has an
    in-phase part as well, a gain that grows with the force. Structures and glue lose the same share
    of the energy at all forces (Lazan), and a joint that slips throughout loses what goes with the
    force once (Bouc, Wen): :mod:`sim.gauges.characteristic`.
    """

    code = "M4"
    name = "gauge-hysteresis"
    title = "Hysteresis of the dynamometers"
    stage = StageName.DYNAMOMETERS

    beta_1_n: float = parameter(
        2e-6,
        0.0,
        1e-4,
        "1/N",
        "beta of both gauges; 0.05 % of a full scale of 500 N is 2e-6",
        one_sign=OneSign.LOSS,
    )
    width_power: float = parameter(
        2.0,
        0.5,
        3.0,
        "1",
        "of the force's amplitude that the width goes with",
        one_sign=OneSign.LOSS,
        forms=(1.0,),
    )
    swelling: float = parameter(
        0.0,
        0.0,
        1.0,
        "1",
        "share of Rayleigh's in-phase part",
        one_sign=OneSign.SHARE,
        forms=(1.0,),
    )
    saturates: float = parameter(
        0.0,
        0.0,
        5.0,
        "1",
        "typical force over the one at which the loop is as wide as it gets, 0 for none",
        one_sign=OneSign.LOSS,
        forms=(2.0,),
    )
    unlike: float = parameter(0.0, -1.0, 1.0, "1", UNLIKE, forms=(0.3,))

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with this loop on top of what the gauges have."""

        def lagging(gauge: Dynamometer, strut: int) -> Dynamometer:
            share = share_at(strut, self.unlike)
            if self.width_power == 2.0 and not (self.swelling or self._saturates):
                more = share * self.beta_1_n
                return replace(gauge, hysteresis_1_n=gauge.hysteresis_1_n + more)
            return replace(gauge, loops=(*gauge.loops, self._loop(share, force_n(rig))))

        return with_gauges(rig, lagging)

    @property
    def _saturates(self) -> bool:
        """Whether the loop is as wide as it gets at a force that any gauge knows."""
        return self.saturates > _SLIGHT

    def _loop(self, share: float, force: float) -> Loop:
        """Return the loop that loses as much as Rayleigh's at a force."""
        half_width = share * self.beta_1_n / 2.0 * force**2
        if self._saturates:
            # Over 4/3 of the widths times the range of Rayleigh's.
            lost = 2.0 * (1.0 - math.tanh(self.saturates) / self.saturates)
            return SaturatingLoop(half_width * (4.0 / 3.0) / lost, force / self.saturates, force)
        return PowerLoop(half_width, force, self.width_power, self.swelling)

    def signature(self, situation: Situation) -> Signature:
        """Return ``-(beta/2) F_m^2 cos|cos|`` in the force's own phase."""
        force = situation.force()
        size, phase = np.abs(force), np.angle(force)
        predicted: dict[tuple[str, int], complex] = {}
        for order in range(1, HIGHEST + 1, 2):
            # Fourier coefficient of cos|cos|: 8/3pi, 8/15pi, -8/105pi.
            wave = 8.0 * np.sin(order * np.pi / 2.0) / (order * np.pi * (4 - order**2))
            values = -self.beta_1_n / 2.0 * size**2 * wave * 1j * np.exp(1j * order * phase)
            predicted |= at_struts(values, order, RECORDED_FORCES)
        return predicted
