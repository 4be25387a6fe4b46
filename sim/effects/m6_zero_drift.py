"""M6: a zero that wanders off during a run."""

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.effects.effect import (
    DeviationTrace,
    Effect,
    FurtherMeasurement,
    OneSign,
    Signature,
    StageName,
    parameter,
)
from sim.effects.measurement import HIGHEST, settled_more, with_gauges
from sim.effects.situation import RECORDED_FORCES, Situation, at_struts
from sim.gauges.dynamometer import Dynamometer
from sim.rig import SimulatedRig

_AS_FAR_S: Final = 30.0


@dataclass(frozen=True)
class ZeroDrift(Effect):
    """A reading that rises linearly in time: in phase at every order, with 1/n.

    It does not repeat with the shaft. The signature is what an analysis finds that takes whole
    periods from a pulse on and fits no trend: independent of how many periods these are. The zero
    is taken anew as each record begins; the mean, which grows with the time since then, is left out
    of it. One that is taken once for a campaign is ``campaign-drift``. A gauge that creeps under a
    new load settles; it drifts as far in half a minute.
    """

    code = "M6"
    name = "zero-drift"
    title = "Drift of the dynamometers' zero"
    stage = StageName.DYNAMOMETERS
    repeats = False
    shows_in = (DeviationTrace.TREND, DeviationTrace.MEAN)
    shown_by = (FurtherMeasurement.REST,)

    aft_n_s: float = parameter(1e-3, -0.2, 0.2, "N/s", "drift of the aft dynamometer")
    fore_n_s: float = parameter(0.0, -0.2, 0.2, "N/s", "drift of the fore dynamometer")
    settling_s: float = parameter(
        0.0,
        0.0,
        3600.0,
        "s",
        "time constant with which it dies out, 0 for never",
        one_sign=OneSign.TIME,
        forms=(30.0,),
    )

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with these drifts on top of what the gauges have."""
        drifts, settling_s = (self.aft_n_s, self.fore_n_s), self.settling_s or None
        sooner = 1.0 if settling_s is None else settled_more(settling_s, _AS_FAR_S)

        def drifting(gauge: Dynamometer, strut: int) -> Dynamometer:
            drift = gauge.zero_drift_n_s + sooner * drifts[strut]
            return replace(gauge, zero_drift_n_s=drift, zero_settling_s=settling_s)

        return with_gauges(rig, drifting)

    def signature(self, situation: Situation) -> Signature:
        """Return ``-d/(n pi)`` in phase, d the drift over one period."""
        per_period = np.array([self.aft_n_s, self.fore_n_s]) / situation.set_point.frequency_hz
        predicted: dict[tuple[str, int], complex] = {}
        for order in range(1, HIGHEST + 1):
            predicted |= at_struts(-per_period / (order * np.pi), order, RECORDED_FORCES)
        return predicted
