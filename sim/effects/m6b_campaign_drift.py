"""M6b: a zero that was taken once, and wanders off over the whole campaign."""

import math
from dataclasses import dataclass, replace
from typing import Final, Self

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.effects.campaign import CampaignRun
from sim.effects.effect import DeviationTrace, Effect, OneSign, Signature, StageName, parameter
from sim.effects.m6_zero_drift import ZeroDrift
from sim.effects.measurement import settled_more, with_gauges
from sim.effects.situation import RECORDED_FORCES, Situation, at_struts
from sim.rig import SimulatedRig

_LEAST_S: Final = 1e-3
_AS_FAR_S: Final = 1800.0


@dataclass(frozen=True)
class CampaignDrift(Effect):
    """A reading that rises linearly on the campaign's clock: a mean that grows from run to run.

    Within a run it is the drift of ``zero-drift``, whose zero is taken anew before each run; here
    it is taken once, so that between two runs, or two records at rest, the mean grows by drift
    times the time between them. The mean of the signature is that with which the run begins; what
    it grows by during the run is left out. In a campaign the time is the run's. A temperature
    moves the zeros of both gauges alike, and the gains and the water with them. What warms up
    settles; it has drifted as far after the first half hour.
    """

    code = "M6b"
    name = "campaign-drift"
    title = "Drift of the dynamometers' zero over the campaign"
    stage = StageName.DYNAMOMETERS
    repeats = False
    shows_in = (DeviationTrace.TREND, DeviationTrace.MEAN)

    aft_n_s: float = parameter(2e-4, -0.01, 0.01, "N/s", "drift of the aft dynamometer")
    fore_n_s: float = parameter(0.0, -0.01, 0.01, "N/s", "drift of the fore dynamometer")
    since_zero_s: float = parameter(
        1800.0,
        _LEAST_S,
        1e7,
        "s",
        "from taking the zero to the beginning of the run",
        held=True,
        one_sign=OneSign.TIME,
    )

    settling_s: float = parameter(
        0.0,
        0.0,
        1e6,
        "s",
        "time constant with which it dies out, 0 for never",
        one_sign=OneSign.TIME,
        forms=(1800.0, 7200.0),
    )

    def at_run(self, run: CampaignRun) -> Self:
        """Return the effect at the run's time; the zero was taken when the campaign began."""
        return replace(self, since_zero_s=self.nearest("since_zero_s", run.since_start_s))

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with the zeros as they are when the run begins, and as they go on."""
        zeros = [drift * self._clock_s for drift in (self.aft_n_s, self.fore_n_s)]
        drifted = with_gauges(
            rig, lambda gauge, i: replace(gauge, zero_drifted_n=gauge.zero_drifted_n + zeros[i])
        )
        return self._within_run.change(drifted, set_point)

    def signature(self, situation: Situation) -> Signature:
        """Return drift times the time since the zero as a mean; at the orders as ``zero-drift``."""
        zeros = self.since_zero_s * np.array([self.aft_n_s, self.fore_n_s])
        return {
            **at_struts(zeros, 0, RECORDED_FORCES),
            **self._within_run.signature(situation),
        }

    @property
    def _clock_s(self) -> float:
        """Time in which a straight drift would be as far when the run begins."""
        t, settling_s = self.since_zero_s, self.settling_s
        if not settling_s:
            return t
        return -settled_more(settling_s, _AS_FAR_S) * settling_s * math.expm1(-t / settling_s)

    @property
    def _within_run(self) -> ZeroDrift:
        slower = 1.0
        if self.settling_s:
            faded = math.exp(-self.since_zero_s / self.settling_s)
            slower = settled_more(self.settling_s, _AS_FAR_S) * faded
        return ZeroDrift(slower * self.aft_n_s, slower * self.fore_n_s)
