"""H3b: quadratic damping of a model that drifts, too: it stands askew, or there is a current."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, OneSign, Signature, StageName, parameter
from sim.effects.friction import power_law
from sim.effects.hydrodynamics import of_law, with_laws
from sim.effects.situation import Situation
from sim.effects.typical import speed_m_s
from sim.model.law_point import Point
from sim.model.laws import Quadratic
from sim.model.water.force_laws import quadratic_describing_function
from sim.rig import SimulatedRig

if TYPE_CHECKING:
    from sim.model.force_law import ForceLaw

HIGHEST = 4
SLOWEST_M_S = 1e-9  # below it there is the drift only
POINTS = (Point.THROUGH_WATER,)


@dataclass(frozen=True)
class QuadraticDrift(Effect):
    """``B (v + v0)|v + v0|``: a mean of ``4 e/pi`` and ``8 e/(3 pi)`` at order 2, of ``B V^2``.

    e is v0/V, the drift over the velocity's amplitude. The even orders change their sign with the
    drift's. The effect brings its own quadratic damping: do not add that of H3 as well.
    """

    code = "H3b"
    name = "quadratic-drift"
    title = "Quadratic damping with a mean drift"
    stage = StageName.MODEL

    translation_n_s2_m2: float = parameter(
        300.0,
        0.0,
        20000.0,
        "N s2/m2",
        "of heave or sway through the water: C_D rho S/2",
        one_sign=OneSign.DAMPING,
    )
    drift_m_s: float = parameter(0.01, -0.3, 0.3, "m/s", "v0, mean velocity across")
    power: float = parameter(
        2.0,
        1.0,
        3.0,
        "1",
        "of the velocity",
        one_sign="drag grows with the speed",
        forms=(5.0 / 3.0, 2.5),
    )

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with this damping of heave or sway."""
        law: ForceLaw = Quadratic(self.translation_n_s2_m2, self.drift_m_s)
        if self.power != 2.0:
            size = self.translation_n_s2_m2
            law = power_law(size, 2.0, self.power, speed_m_s(rig), self.drift_m_s)
        return with_laws(rig, (Point.THROUGH_WATER, law))

    def signature(self, situation: Situation) -> Signature:
        """Return the describing function of ``(e + cos)|e + cos|``, exact for any drift."""

        def wave(order: int, speed: float, phase: float, _: Point) -> complex:
            if speed < SLOWEST_M_S:
                still = self.translation_n_s2_m2 * self.drift_m_s * abs(self.drift_m_s)
                return still if order == 0 else 0.0
            share = quadratic_describing_function(order, self.drift_m_s / speed)
            turned = 1j * np.exp(1j * order * (phase - np.pi / 2.0)) if order else 1.0
            return complex(self.translation_n_s2_m2 * speed**2 * share * turned)

        return of_law(situation, POINTS, wave, HIGHEST)
