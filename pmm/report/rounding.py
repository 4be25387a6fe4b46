"""Numbers with their intervals, for tables that people read."""

import math

from pmm.tables import is_open

_NEGLIGIBLE = 1e-8  # of a value: its digits would run on without saying more
_SIGNIFICANT = 4  # digits where no interval says how many


def rounded(value: float, half_width: float) -> str:
    """Return ``value ± half_width`` with two digits of the latter, as many places in both.

    A value alone, in four digits, where there is no interval; a dash for no number at all.
    """
    if not math.isfinite(value):
        return "–"
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


def rounded_phase(phase_deg: float, half_width_deg: float, amplitude: float = 1.0) -> str:
    """Return a phase with its interval, or that it is open (:func:`pmm.tables.is_open`)."""
    if is_open(half_width_deg, amplitude):
        return "open"
    return rounded(phase_deg, half_width_deg)


def _minus(text: str) -> str:
    return text.replace("-", "−")
