"""How far pulses scatter about a shaft that turns evenly."""

import numpy as np

from hardware.description.arrays import FloatArray

_ROUNDING = 1e-7  # of an interval: what no clock tells
_DEGREE = 3  # of how a shaft that settles comes to its speed, by the number of turns


def scatter_of_pulses(pulses_s: FloatArray) -> tuple[float, float]:
    """Return the log of the intervals' standard deviation, relative, and its standard deviation.

    What a shaft that still settles does to its speed is no scatter: it goes on evenly, and pulses
    follow it as a cubic of their number. What is left of n pulses that scatter by themselves is
    chi-squared of n - 4, whose log has a variance of ``psi'((n - 4)/2)``.

    Parameters
    ----------
    pulses_s
        At least three, a turn apart or several, shape ``(n,)``.
    """
    from scipy.special import polygamma

    interval_s = float(np.median(np.diff(pulses_s)))
    number = np.rint((pulses_s - pulses_s[0]) / interval_s)
    degree = min(_DEGREE, len(pulses_s) - 2)
    line = np.polynomial.Polynomial.fit(number, pulses_s, degree)
    left_s, freedom = pulses_s - line(number), len(pulses_s) - degree - 1
    spread = float(np.sqrt(2.0 * (left_s @ left_s) / freedom)) / interval_s
    return float(np.log(spread + _ROUNDING)), 0.5 * float(np.sqrt(polygamma(1, freedom / 2.0)))
