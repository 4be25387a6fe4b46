"""How numbers and names are written for people: digits, intervals, shares, rows of names."""

import math
from collections.abc import Callable
from typing import Final

NOT_KNOWN: Final = "–"
_NEGLIGIBLE: Final = 1e-8  # of a value: its digits would run on without saying more
_SIGNIFICANT: Final = 4  # digits where no interval says how many
_PLACES: Final = 6  # before and behind the point; others are written with a power of ten
_ANGLE_PLACES: Final = 9  # of degrees: no encoder tells a millionth
_OPEN_DEG: Final = 90.0  # half-width of a phase that is not known


def written(form: str, unit: str = "") -> Callable[[float], str]:
    """Return how a number is written by a format; one that is not known is a dash."""
    return lambda value: f"{value:{form}}{unit}" if math.isfinite(value) else NOT_KNOWN


def degrees(angle_rad: float) -> str:
    """Return an angle in degrees, in four digits; what only rounding makes of none is 0."""
    return f"{round(math.degrees(angle_rad), _ANGLE_PLACES):z.{_SIGNIFICANT}g}"


def percent(form: str) -> Callable[[float], str]:
    """Return how a share is written in per cent."""
    return lambda share: written(form, " %")(100.0 * share)


def rounded(value: float, half_width: float) -> str:
    """Return ``value ± half_width`` with two digits of the latter, as many places in both.

    A value alone, in four digits, where there is no interval; a dash for no number at all.
    """
    if not math.isfinite(value):
        return NOT_KNOWN
    if not (math.isfinite(half_width) and half_width > 0.0):
        return _minus(f"{value:.{_SIGNIFICANT}g}")
    power = math.floor(math.log10(max(abs(value), half_width)))
    if not -5 <= power <= 5:
        scaled = rounded(value / 10.0**power, half_width / 10.0**power)
        return f"({scaled})·10^{_minus(str(power))}"
    if half_width < _NEGLIGIBLE * abs(value):
        return _minus(f"{value:.9g} ± {half_width:.1e}")
    # 0.0996 rounds to 0.10: the exponent after rounding counts.
    places = max(0, 1 - int(f"{half_width:.1e}".partition("e")[2]))
    return _minus(f"{value:z.{places}f} ± {half_width:.{places}f}")


def between(low: float, high: float) -> str:
    """Return ``low to high`` with two digits of the width; a dash where the ends are not known."""
    if not (math.isfinite(low) and math.isfinite(high)):
        return NOT_KNOWN
    largest = max(abs(low), abs(high))
    if not high - low > _NEGLIGIBLE * largest:
        return _minus(f"{low:.{_SIGNIFICANT}g} to {high:.{_SIGNIFICANT}g}")
    places = 1 - math.floor(math.log10(high - low))
    if places <= _PLACES and largest < 10.0**_PLACES:
        ends = [f"{round(end, places):z.{max(places, 0)}f}" for end in (low, high)]
    else:
        digits = max(2, places + 1 + math.floor(math.log10(largest)))
        ends = [f"{end:.{digits}g}" for end in (low, high)]
    return _minus(" to ".join(ends))


def is_open(phase_half_width_deg: float, amplitude: float) -> bool:
    """Whether a phase is not known: its interval takes in half the circle, or nothing turns."""
    return phase_half_width_deg >= _OPEN_DEG or amplitude == 0.0


def counted(number: int, noun: str) -> str:
    """Return ``1 run``, ``2 runs``."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def clock(seconds: float) -> str:
    """Return a time as minutes and seconds, with hours where there are any: ``1:02:03``."""
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02d}:{rest:02d}" if hours else f"{minutes}:{rest:02d}"


def _minus(text: str) -> str:
    return text.replace("-", "−")
