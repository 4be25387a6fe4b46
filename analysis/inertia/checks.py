"""Checks of a record of a free oscillation before anything is fitted to it."""

import math

import numpy as np

from analysis.inertia.lengthening import Powers, longer
from analysis.inertia.local_periods import LocalPeriods
from analysis.inertia.series import SWINGING_UNITS, Series, UsablePart
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity
from hardware.description.units import STANDARD_GRAVITY_M_S2

FEWEST_SWINGS = 3.0
FEW_SWINGS = 10.0
LARGEST_ANGLE_RAD = 0.7  # 40 degrees: nobody releases a pendulum for inertia from further out
SWAY_TOLERANCE = 0.03


def check_record(part: UsablePart) -> tuple[Flag, ...]:
    """Check number of swings and size of an oscillation; its sampling was when it was found.

    The flag is ``few_swings``, under ten.

    Raises
    ------
    DataError
        Under three swings, and for angles that only degrees can be.
    """
    check_angle(part.series.where, part.series.unit, part.first_amplitude)
    return check_swings(part)


def check_swings(part: UsablePart) -> tuple[Flag, ...]:
    """Refuse under three swings (raises DataError); flag under ten."""
    series = part.series
    swings = series.values.size / series.sample_rate_hz / part.period_s
    if swings < FEWEST_SWINGS:
        raise DataError(
            f"{series.where}: too few swings: {swings:.2g} of {part.period_s:.3g} s are usable, at "
            f"least {FEWEST_SWINGS:g} are needed; record longer or release from further out"
        )
    if swings >= FEW_SWINGS:
        return ()
    message = (
        f"{series.where}: {swings:.2g} swings of {part.period_s:.3g} s are usable; ten or more "
        "make a period that repeats"
    )
    return (Flag("few_swings", Severity.WARNING, message, series.channel),)


def check_angle(where: str, unit: str, amplitude: float) -> None:
    """Refuse an angle in radians that can only be in degrees.

    Raises
    ------
    DataError
        If the amplitude of a channel in ``rad`` is above 0.7.
    """
    if unit == "rad" and amplitude > LARGEST_ANGLE_RAD:
        raise DataError(
            f"{where}: an amplitude of {amplitude:.3g} rad is {math.degrees(amplitude):.0f} deg "
            f"(limit {LARGEST_ANGLE_RAD:g} rad): it seems to be degrees given as radians; state "
            'the unit "deg" in the column map'
        )


def check_amplitude_effect(where: str, local: LocalPeriods, known: Powers) -> tuple[Flag, ...]:
    """Flag angles whose period does not lengthen with amplitude as geometry makes it.

    Where the record's angles promise a change ten times what can be seen, and under a third of it
    is there, the angles are too large: degrees given as radians, or a wrong scale.

    Parameters
    ----------
    local
        Successive parts of the record, amplitudes in rad.
    """
    amplitude_rad, period_s = local.amplitude, local.period_s
    promised = longer(known, amplitude_rad)
    weight = 1.0 / local.uncertainty_s**2
    centred = promised - np.average(promised, weights=weight)
    spread = float(weight @ centred**2)
    if not spread > 0.0:
        return ()
    base = float(period_s.min())
    slope = float((weight * centred) @ period_s) / spread / base
    doubt = 1.0 / math.sqrt(spread) / base
    if 10.0 * doubt > 1.0 or slope > 1.0 / 3.0:
        return ()
    message = (
        f"{where}: amplitudes of {amplitude_rad.max():.2g} to {amplitude_rad.min():.2g} rad should "
        f"lengthen the period by {100 * float(np.ptp(promised)):.2g} %, and {100 * slope:.0f} % of "
        "that is seen; the angle's unit or scale seems wrong (degrees given as radians?)"
    )
    return (Flag("angle_scale", Severity.WARNING, message),)


def check_sway_axis(
    where: str,
    period_s: float,
    line_length_m: float,
    gravity_m_s2: float = STANDARD_GRAVITY_M_S2,
) -> None:
    """Refuse a sway record whose period is not that of the lines: ``2 pi sqrt(l/g)``.

    Raises
    ------
    DataError
        If it is off by more than 3 %: another axis (yaw for sway) or another length.
    """
    expected = 2.0 * math.pi * math.sqrt(line_length_m / gravity_m_s2)
    deviation = period_s / expected - 1.0
    if abs(deviation) > SWAY_TOLERANCE:
        raise DataError(
            f"{where}: a period of {period_s:.4g} s is {100 * deviation:+.1f} % from the "
            f"{expected:.4g} s of sway on lines of {line_length_m:.4g} m (limit "
            f"{100 * SWAY_TOLERANCE:g} %): a record of the wrong axis (yaw for sway?), or a wrong "
            "line length"
        )


def check_yaw_axis(
    where: str,
    period_s: float,
    line_length_m: float,
    gravity_m_s2: float = STANDARD_GRAVITY_M_S2,
) -> tuple[Flag, ...]:
    """Flag a yaw record whose period is that of sway, within 0.5 %.

    It may be true, where the half spacing happens to equal the gyradius; more often the channel
    shows sway.
    """
    sway = 2.0 * math.pi * math.sqrt(line_length_m / gravity_m_s2)
    if abs(period_s / sway - 1.0) > 0.005:
        return ()
    message = (
        f"{where}: the yaw period {period_s:.4g} s is that of sway on lines of "
        f"{line_length_m:.4g} m ({sway:.4g} s): a record of the wrong axis (sway for yaw), unless "
        "the half spacing equals the gyradius; change the spacing to tell"
    )
    return (Flag("period_is_sway", Severity.WARNING, message),)


def strongest_axis(chosen: Series, series: tuple[Series, ...]) -> tuple[Flag, ...]:
    """Flag a channel beside which another of the same unit swings more at the same time.

    For records with several axes (a phone's three rates): the wanted axis is the strongest one.
    What has no unit is not compared: metres of travel say nothing of degrees of roll.
    """
    if chosen.unit not in SWINGING_UNITS:
        return ()
    swing = float(np.nanstd(chosen.values))
    stronger = [
        rival
        for rival in series
        if rival.unit == chosen.unit
        and rival.channel != chosen.channel
        and float(np.nanstd(rival.values)) > swing
    ]
    if not stronger:
        return ()
    best = max(stronger, key=lambda rival: float(np.nanstd(rival.values)))
    message = (
        f"{chosen.where}: {best.channel} swings {float(np.nanstd(best.values)) / swing:.2g} times "
        "as much; is this the right axis?"
    )
    return (Flag("weaker_axis", Severity.WARNING, message, chosen.channel),)
