"""A path of two struts over their master angle, and what of it is refused.

Refused are a path beyond its struts and a clock that jumps.
"""

import math
from collections.abc import Iterator
from typing import Final

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.lines import Line, struts_over_turn
from hardware.errors import CycleJumpError, LimitError
from hardware.limits import LATE_PERIODS
from hardware.path_shaft_settings import STRUTS, PathShaftSettings
from hardware.roles import Cycle

_INSTANTS: Final = 720  # of a turn
_TURN: Final = 2.0 * math.pi
_ROUNDING: Final = 1.0 + 1e-6


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
        """Return both struts' displacements at a master angle, in metres, shape ``(2,)``."""
        return np.asarray((np.exp(self._orders * angle_rad) @ self._phasors).imag)

    def peaks(self, times: int) -> Iterator[tuple[float, float]]:
        """Yield each strut's largest derivative by the angle, and at which part of the turn."""
        for derivative in np.abs(struts_over_turn(self._lines, times, _INSTANTS)):
            yield float(derivative.max()), float(derivative.argmax()) / len(derivative)


def check_path(
    name: str, settings: PathShaftSettings, path: StrutPath, eccentricity_m: float, rate_hz: float
) -> None:
    """Refuse a path beyond a strut's own limits, with the place in it.

    Parameters
    ----------
    rate_hz
        Turns of the master angle per second.

    Raises
    ------
    LimitError
        With the strut, the time in the period and the limit.
    """
    for times, key in ((0, "stroke"), (1, "speed"), (2, "acceleration")):
        size = eccentricity_m * (_TURN * rate_hz) ** times
        for strut, (peak, part) in zip(STRUTS, path.peaks(times), strict=True):
            limits = getattr(settings, strut)
            most = min(-limits.low, limits.high) if key == "stroke" else getattr(limits, key)
            if size * peak > most * _ROUNDING:
                raise LimitError(
                    name,
                    f"the path's {key} of {size * peak:.4g} at {part / rate_hz:.3g} s of its "
                    f"period is beyond {strut}.{key} = {most:.4g}; lower amplitude or frequency",
                )


def check_clock(name: str, cycle: Cycle, sample_rate_hz: float) -> None:
    """Refuse a cycle so late that set-points were left out.

    Raises
    ------
    CycleJumpError
        With lateness and limit.
    """
    if cycle.lateness_s * sample_rate_hz >= LATE_PERIODS:
        raise CycleJumpError(
            name,
            f"SYNC {cycle.number} came {1e3 * cycle.lateness_s:.3g} ms late (limit "
            f"{1e3 * LATE_PERIODS / sample_rate_hz:.3g} ms): set-points have lost their time; look "
            "at the load and the clock of this computer (pmm doctor), then reset",
        )
