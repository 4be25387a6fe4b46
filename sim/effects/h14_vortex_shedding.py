"""H14: vortices that the struts shed, and struts that ventilate."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hardware.description.setpoint import Medium, SetPoint
from sim.effects.effect import Effect, Lines, Signature, StageName, parameter
from sim.effects.hydrodynamic import STRUTS, with_laws
from sim.effects.situation import STRUT_FORCES, Situation, at_struts
from sim.laws import Coulomb, ForceLaw, Tone
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class VortexShedding(Effect):
    """A line at ``St U/d`` that grows with U^2; beyond a speed of its own, a step of the mean.

    The line stands for what is really a band: shedding wanders, and does so on each strut by
    itself. The step is what a strut loses where air is drawn down along it.
    """

    code: ClassVar[str] = "H14"
    name: ClassVar[str] = "vortex-shedding"
    title: ClassVar[str] = "Vortex shedding and ventilation of the struts"
    stage: ClassVar[StageName] = StageName.MODEL

    lift_n_s2_m2: float = parameter(0.5, 0.0, 50.0, "N s2/m2", "amplitude at each strut, over U^2")
    diameter_m: float = parameter(0.04, 0.005, 0.5, "m", "d of a strut")
    strouhal: float = parameter(0.2, 0.1, 0.35, "1", "St")
    step_n: float = parameter(0.0, -20.0, 20.0, "N", "mean at each strut when it ventilates")
    ventilation_m_s: float = parameter(1.5, 0.1, 20.0, "m/s", "speed at which that begins")

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with both forces at each strut; without speed there are none."""
        speed = set_point.carriage_speed_m_s
        laws: list[ForceLaw] = []
        if speed:
            laws.append(Tone(self.lift_n_s2_m2 * speed**2, self.shedding_hz(speed)))
        if self._step(set_point):
            laws.append(Coulomb(0.0, self._step(set_point)))
        return with_laws(rig, *((point, law) for point in STRUTS for law in laws))

    def shedding_hz(self, speed_m_s: float) -> float:
        """Return the frequency of the vortices."""
        return self.strouhal * abs(speed_m_s) / self.diameter_m

    def signature(self, situation: Situation) -> Signature:
        """Return the step alone: the line does not repeat with the shaft."""
        step = self._step(situation.set_point)
        return at_struts(np.full(2, step), 0) if step else {}

    def lines(self, situation: Situation) -> Lines:
        """Return the line at each strut."""
        speed = situation.set_point.carriage_speed_m_s
        if not (situation.in_water and speed):
            return {}
        size = complex(self.lift_n_s2_m2 * speed**2)
        return dict.fromkeys(((name, self.shedding_hz(speed)) for name in STRUT_FORCES), size)

    def _step(self, set_point: SetPoint) -> float:
        fast = abs(set_point.carriage_speed_m_s) > self.ventilation_m_s
        return self.step_n if fast and set_point.medium is Medium.WATER else 0.0
