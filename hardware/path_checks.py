"""What a shaft that is a program refuses: a path beyond its struts, and a clock that jumps."""

import math
from typing import Final

from hardware.errors import CycleJumpError, LimitError
from hardware.limits import LATE_PERIODS
from hardware.path_shaft_settings import STRUTS, PathShaftSettings
from hardware.roles import Cycle
from hardware.strut_path import StrutPath

_TURN: Final = 2.0 * math.pi
_ROUNDING: Final = 1.0 + 1e-6


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
            own = getattr(settings, strut)
            most = min(-own.low, own.high) if key == "stroke" else getattr(own, key)
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
