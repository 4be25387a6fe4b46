"""The four period fits of a swing's record, F1 to F4."""

from enum import StrEnum

import numpy as np

from analysis.inertia.damped_fit import DampedFit, fit_damped
from hardware.description.arrays import FloatArray


class SwingForm(StrEnum):
    """Which function is fitted."""

    F1 = "F1"  # undamped cosine
    F2 = "F2"  # damped
    F3 = "F3"  # damped, over a whole number of periods only
    F4 = "F4"  # damped, with an offset: the one to use


def fit_swing_form(
    time_s: FloatArray,
    values: FloatArray,
    form: SwingForm = SwingForm.F4,
    *,
    start_period_s: float | None = None,
    where: str = "record",
) -> DampedFit:
    """Fit one of the four functions ``A exp(-lambda t) cos(2 pi t/T + phi) [+ offset]``.

    It raises what :func:`analysis.inertia.damped_fit.fit_damped` raises.

    Parameters
    ----------
    time_s, values
        Shape ``(samples,)``; NaN where a sample is missing.
    start_period_s
        A user's guess; the spectrum's own competes with it.
    """
    start = None if start_period_s is None else (start_period_s,)
    fit = fit_damped(
        time_s,
        values,
        offset=form is SwingForm.F4,
        damped=form is not SwingForm.F1,
        start_periods_s=start,
        where=where,
    )
    if form is not SwingForm.F3:
        return fit
    period = fit.modes[0].period_s
    span_s = np.floor((time_s[-1] - time_s[0]) / period) * period
    inside = time_s < time_s[0] + span_s
    return fit_damped(time_s[inside], values[inside], offset=False, where=where)
