"""Planning of a bifilar test: what each suspension measures, and its expected uncertainty."""

from dataclasses import dataclass

from analysis.inertia.bifilar import resonance_flags, sway_period, yaw_gyradius, yaw_period
from analysis.inertia.double_pendulum import (
    LineLengthReading,
    best_line_length,
    gyradius_from_periods,
    mode_periods,
)
from analysis.uncertainty.budget import derived
from analysis.uncertainty.estimate import Estimate, require_positive
from hardware.description.flags import Flag

# Points A to H around a square frame (figure 21): yaw, pitch, roll, depth that each pair gives.
SUSPENSION_OPTIONS = {
    "B-F": ("k_zz (yaw)", "k_yy (pitch)", "", "l_2"),
    "H-D": ("k_zz (yaw)", "", "k_xx (roll)", "l_2"),
    "A-G": ("yaw about the axis tilted by phi_A", "k_yy (pitch)", "", "l_2"),
    "C-E": ("yaw about the axis tilted by phi_B", "k_yy (pitch)", "", "l_2"),
    "A-C": ("yaw about the axis rolled by phi_A", "", "k_xx (roll)", "l_2"),
    "G-E": ("yaw about the axis rolled by phi_B", "", "k_xx (roll)", "l_2"),
    "A-C + G-E": ("", "k_yy (pitch)", "", ""),
    "A-G + C-E": ("", "", "k_xx (roll)", ""),
}


@dataclass(frozen=True)
class SuspensionForecast:
    """Expected periods and uncertainties of a suspension.

    Attributes
    ----------
    sway_s, yaw_s, slow_s, fast_s
        The periods to expect: sway, yaw, both pitch modes.
    yaw_gyradius, pitch_gyradius
        With the uncertainties to expect.
    best_line_m
        Line length for the best pitch gyradius, by each reading.
    """

    sway_s: float
    yaw_s: float
    slow_s: float
    fast_s: float
    yaw_gyradius: Estimate
    pitch_gyradius: Estimate
    best_line_m: dict[str, float]
    flags: tuple[Flag, ...]


def forecast_suspension(
    yaw_gyradius_m: float,
    pitch_gyradius_m: float,
    depth_m: float,
    half_spacing: Estimate,
    line: Estimate,
    gravity: Estimate,
    *,
    period_scatter_relative: float,
) -> SuspensionForecast:
    """Forecast a test from design values.

    Raises
    ------
    ConfigurationError
        For a value that is not above zero.
    """
    d, length, g = half_spacing.value, line.value, gravity.value
    require_positive(
        "forecast",
        yaw_gyradius_m=yaw_gyradius_m,
        pitch_gyradius_m=pitch_gyradius_m,
        depth_m=depth_m,
        half_spacing_m=d,
        line_m=length,
        gravity_m_s2=g,
    )
    sway, yaw = sway_period(length, g), yaw_period(yaw_gyradius_m, d, length, g)
    slow, fast = mode_periods(pitch_gyradius_m, depth_m, length, g)

    def expected(period: float) -> Estimate:
        return Estimate.of(period, period_scatter_relative * period, "s")

    yaw_inputs = {
        "period_s": expected(yaw),
        "half_spacing_m": half_spacing,
        "line_m": line,
        "gravity_m_s2": gravity,
    }
    pitch_inputs = {
        "slow_period_s": expected(slow),
        "fast_period_s": expected(fast),
        "sway_period_s": expected(sway),
        "gravity_m_s2": gravity,
    }
    best = {
        str(reading): best_line_length(pitch_gyradius_m, depth_m, g, reading)
        for reading in LineLengthReading
    }
    return SuspensionForecast(
        sway,
        yaw,
        slow,
        fast,
        derived("k_yaw", yaw_gyradius, "m", **yaw_inputs),
        derived("k_pitch", gyradius_from_periods, "m", **pitch_inputs),
        best,
        resonance_flags(yaw, slow),
    )
