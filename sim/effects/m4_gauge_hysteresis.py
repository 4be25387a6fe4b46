"""M4: a dynamometer whose reading lags behind the force in a Rayleigh loop."""

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, OneSign, Signature, StageName, parameter
from sim.effects.measurement import with_gauges
from sim.effects.situation import RECORDED_FORCES, Situation, at_struts
from sim.rig import SimulatedRig

HIGHEST = 5


@dataclass(frozen=True)
class GaugeHysteresis(Effect):
    """A loop of half width ``(beta/2)(F_m^2 - F^2)``: odd orders, in quadrature to the *force*.

    The third is a fifth of the first, with the same sign. It goes with the force squared and looks
    like damping that changes its sign where inertia and restoring cancel.
    """

    code: ClassVar[str] = "M4"
    name: ClassVar[str] = "gauge-hysteresis"
    title: ClassVar[str] = "Hysteresis of the dynamometers"
    stage: ClassVar[StageName] = StageName.DYNAMOMETERS

    beta_1_n: float = parameter(
        2e-6,
        0.0,
        1e-4,
        "1/N",
        "beta of both gauges; 0.05 % of a full scale of 500 N is 2e-6",
        one_sign=OneSign.LOSS,
    )

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with this loop on top of what the gauges have."""
        return with_gauges(
            rig,
            lambda gauge, _: replace(gauge, hysteresis_1_n=gauge.hysteresis_1_n + self.beta_1_n),
        )

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
