"""H14: vortices that the struts shed, and struts that ventilate."""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final, Self

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.setpoint import Medium, SetPoint
from sim.effects.campaign import CampaignRun
from sim.effects.effect import Effect, Lines, OneSign, Signature, StageName, parameter
from sim.effects.hydrodynamics import STRUTS, with_laws
from sim.effects.situation import STRUT_FORCES, Situation, at_struts
from sim.model.friction import Coulomb
from sim.model.laws import Tone
from sim.rig import SimulatedRig

if TYPE_CHECKING:
    from sim.model.force_law import ForceLaw
    from sim.model.law_point import Point

TONES: Final = 24
_LAST_RUN: Final = 1e6


@dataclass(frozen=True)
class VortexShedding(Effect):
    """A band about ``St U/d`` whose force grows with U^2; beyond a speed, a step of the mean.

    Shedding wanders, and does so on each strut by itself. Its band is a normal distribution of the
    power over frequency: at each strut 24 lines of equal power at its quantiles, in phases drawn
    anew for every run. It has the power of one line of the stated amplitude; without a width it is
    that line, in step at both struts. The step is what a strut loses where air is drawn down along
    it.
    """

    code = "H14"
    name = "vortex-shedding"
    title = "Vortex shedding and ventilation of the struts"
    stage = StageName.MODEL

    lift_n_s2_m2: float = parameter(
        0.5,
        0.0,
        50.0,
        "N s2/m2",
        "amplitude at each strut, root 2 of its r.m.s., over U^2",
        one_sign=OneSign.AMPLITUDE,
    )
    diameter_m: float = parameter(0.04, 0.005, 0.5, "m", "d of a strut", one_sign=OneSign.LENGTH)
    strouhal: float = parameter(0.2, 0.1, 0.35, "1", "St", held=True, one_sign=OneSign.RATE)
    step_n: float = parameter(0.0, -20.0, 20.0, "N", "mean at each strut when it ventilates")
    ventilation_m_s: float = parameter(
        1.5, 0.1, 20.0, "m/s", "speed at which that begins", one_sign="a speed"
    )
    bandwidth: float = parameter(
        0.1,
        0.0,
        0.3,
        "1",
        "standard deviation of the band over St U/d",
        held=True,
        one_sign=OneSign.SCATTER,
    )
    run_index: float = parameter(
        0.0,
        0.0,
        _LAST_RUN,
        "1",
        "number of the run, which seeds the phases",
        held=True,
        one_sign=OneSign.COUNT,
    )

    def at_run(self, run: CampaignRun) -> Self:
        """Return the effect with this run's phases."""
        return replace(self, run_index=run.index % _LAST_RUN)

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with both forces at each strut; without speed there are none."""
        laws: list[tuple[Point, ForceLaw]] = []
        for strut, point in enumerate(STRUTS):
            laws += [(point, tone) for tone in self.tones(set_point.carriage_speed_m_s, strut)]
            if self._step(set_point):
                laws.append((point, Coulomb(0.0, self._step(set_point))))
        return with_laws(rig, *laws)

    def tones(self, speed_m_s: float, strut: int) -> tuple[Tone, ...]:
        """Return the lines of the band at a strut (0 aft, 1 fore), rising in frequency."""
        size, middle = self.lift_n_s2_m2 * speed_m_s**2, self.shedding_hz(speed_m_s)
        if not size:
            return ()
        if not self.bandwidth:
            return (Tone(size, middle),)
        # One stream for each run and strut, whatever else of the run is random.
        phases = np.random.default_rng((int(self.run_index), strut)).uniform(-np.pi, np.pi, TONES)
        frequencies = middle * (1.0 + self.bandwidth * _normal_quantiles())
        pairs = zip(frequencies.tolist(), phases.tolist(), strict=True)
        return tuple(Tone(size / TONES**0.5, frequency, phase) for frequency, phase in pairs)

    def shedding_hz(self, speed_m_s: float) -> float:
        """Return the middle frequency of the vortices."""
        return self.strouhal * abs(speed_m_s) / self.diameter_m

    def signature(self, situation: Situation) -> Signature:
        """Return the step alone: the band does not repeat with the shaft."""
        step = self._step(situation.set_point)
        return at_struts(np.full(2, step), 0) if step else {}

    def lines(self, situation: Situation) -> Lines:
        """Return the lines of the band at each strut."""
        if not situation.in_water:
            return {}
        speed = situation.set_point.carriage_speed_m_s
        return {
            (name, tone.tone_hz): tone.tone_n * complex(np.exp(1j * tone.tone_phase_rad))
            for strut, name in enumerate(STRUT_FORCES)
            for tone in self.tones(speed, strut)
        }

    def _step(self, set_point: SetPoint) -> float:
        fast = abs(set_point.carriage_speed_m_s) > self.ventilation_m_s
        return self.step_n if fast and set_point.medium is Medium.WATER else 0.0


def _normal_quantiles() -> FloatArray:
    """Return as many values as there are tones, equally likely, of a variance of exactly 1."""
    from scipy.special import ndtri

    values: FloatArray = ndtri((np.arange(TONES) + 0.5) / TONES)
    values /= np.sqrt(np.mean(values**2))
    return values
