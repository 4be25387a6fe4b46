"""A path of two struts over their master angle."""

from collections.abc import Iterator
from typing import Final

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.lines import Line, struts_over_turn

_INSTANTS: Final = 720  # of a turn


class StrutPath:
    """Where both struts are over the master angle, per eccentricity, aft first.

    Parameters
    ----------
    lines
        Of the motion; none for a single sine.
    strut_phase_rad
        Of the single sine.
    """

    def __init__(self, lines: tuple[Line, ...] = (), strut_phase_rad: float = 0.0) -> None:
        self._lines = lines or (Line(1, strut_phase_rad=strut_phase_rad),)
        self._orders = 1j * np.array([line.order for line in self._lines])
        self._phasors = np.array([line.phasors for line in self._lines])

    def at(self, angle_rad: float) -> FloatArray:
        """Return both struts' places, shape ``(2,)``."""
        return np.asarray((np.exp(self._orders * angle_rad) @ self._phasors).imag)

    def peaks(self, times: int) -> Iterator[tuple[float, float]]:
        """Yield each strut's largest derivative by the angle, and at which part of the turn."""
        for one in np.abs(struts_over_turn(self._lines, times, _INSTANTS)):
            yield float(one.max()), float(one.argmax()) / len(one)
