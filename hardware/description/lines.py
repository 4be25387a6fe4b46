"""A motion of many frequencies: lines at harmonics of one base frequency.

Each strut follows its own table over the turn of one master angle ``theta``, as an electronic cam
or a position-controlled axis does:

    d_aft = e sum over lines of a_k sin(n_k theta + phase_k)
    d_fore = e sum over lines of a_k sin(n_k theta + phase_k + strut_phase_k)

A chirp that repeats, or a motion that was recorded, are such sums too. Struts that move unequally
far at one harmonic have two lines there: together, and against each other.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hardware.description.arrays import ComplexArray, FloatArray

_POINTS_PER_LINE = 32  # of a turn, per harmonic of the highest line: a peak to 0.5 %


@dataclass(frozen=True)
class Line:
    """One line of a motion.

    Attributes
    ----------
    order
        n: which harmonic of the base frequency, 1 or more.
    share
        a: its amplitude over the set-point's eccentricity.
    phase_rad
        Of the aft strut.
    strut_phase_rad
        Of the fore strut ahead of the aft one at this line.
    correction
        Whether it only makes another line's motion pure, and is no frequency of its own.
    """

    order: int
    share: float = 1.0
    phase_rad: float = 0.0
    strut_phase_rad: float = 0.0
    correction: bool = False

    @property
    def phasors(self) -> ComplexArray:
        """Of both struts, aft and fore, per eccentricity: ``d = e Im(H exp(i n theta))``."""
        ahead = self.phase_rad + np.array([0.0, self.strut_phase_rad])
        return np.asarray(self.share * np.exp(1j * ahead))


def struts_over_turn(lines: Sequence[Line], times: int = 0, least: int = 0) -> FloatArray:
    """Return both struts over a turn, per eccentricity, differentiated by the angle.

    The result has the shape ``(2, points)``, aft and fore.

    Parameters
    ----------
    times
        How often it is differentiated.
    least
        Points of the turn, if they are not to be more for the highest line.
    """
    order = np.array([line.order for line in lines], dtype=np.float64)
    points = max(least, _POINTS_PER_LINE * int(order.max()))
    theta = np.linspace(0.0, 2.0 * np.pi, points, endpoint=False)
    size = np.array([line.phasors for line in lines]) * (1j * order[:, None]) ** times
    return np.asarray((size.T @ np.exp(1j * order[:, None] * theta)).imag)


def peak_of(lines: Sequence[Line], times: int = 0) -> float:
    """Return the largest displacement of either strut over the eccentricity, or its derivative."""
    return float(np.abs(struts_over_turn(lines, times)).max())
