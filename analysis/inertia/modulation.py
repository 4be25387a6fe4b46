"""A photogate's yaw periods with the sway modulation removed: equation 14.

T(t) = T_y0 (1 + b t + exp(-t/tau_m) a_m sin(2 pi t/T_m + phi_m)),   T_m the beat period
"""

from dataclasses import dataclass

import numpy as np

from analysis.inertia.damped_fit import DampedFit, fit_damped
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError


@dataclass(frozen=True)
class ModulatedPeriods:
    """Yaw period without the modulation.

    Attributes
    ----------
    period_s
        ``T_y0`` at the middle of the record.
    uncertainty_s
        Of that fit alone.
    trend_1_s
        ``b``, relative change of the period per second (the amplitude decays).
    modulation_period_s, modulation_depth
        ``T_m`` (the beat period) and ``a_m`` at the first reading.
    fit
        With the covariance of all of them.
    """

    period_s: float
    uncertainty_s: float
    trend_1_s: float
    modulation_period_s: float
    modulation_depth: float
    fit: DampedFit


def remove_modulation(time_s: FloatArray, period_s: FloatArray) -> ModulatedPeriods:
    """Fit equation 14 to successive yaw periods.

    Parameters
    ----------
    time_s, period_s
        When each period was read and how long it was, shape ``(readings,)``.

    Raises
    ------
    DataError
        Under sixteen readings, or one and a half modulations.
    """
    if period_s.size < 16:
        raise DataError(
            f"{period_s.size} periods; at least 16 are needed to remove a modulation: count longer"
        )
    fit = fit_damped(time_s, period_s, trend=True, where="photogate periods")
    half = 0.5 * float(time_s[-1] - time_s[0])
    centre = fit.offset
    return ModulatedPeriods(
        period_s=centre,
        uncertainty_s=float(np.sqrt(fit.covariance[4, 4])),
        trend_1_s=fit.trend / half / centre,
        modulation_period_s=fit.modes[0].period_s,
        modulation_depth=fit.modes[0].amplitude / centre,
        fit=fit,
    )
