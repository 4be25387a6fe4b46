"""What a gravity-referenced inclinometer reads when it is carried along.

At radius r above (positive) or below the pivot it feels the tangential acceleration too, and reads
``alpha (1 - omega^2 r/g)``.
"""

import math

from analysis.inertia.elementary_functions import Value
from hardware.description.errors import ConfigurationError
from hardware.description.flags import Flag, Severity

LARGEST_LOSS = 0.1


def reading_factor(period_s: Value, radius_m: Value, gravity_m_s2: Value) -> Value:
    """Reading over true angle, ``1 - omega^2 r/g``.

    Parameters
    ----------
    radius_m
        Distance of the instrument from the pivot on the side of the centre of gravity: below the
        pivot positive.
    """
    omega = 2.0 * math.pi / period_s
    return 1.0 - omega * omega * radius_m / gravity_m_s2


def true_angle(reading_rad: Value, factor: float) -> Value:
    """Return the angle behind a reading.

    Raises
    ------
    ConfigurationError
        If the factor is within 0.2 of zero: the reading holds no angle.
    """
    if abs(factor) < 0.2:
        raise ConfigurationError(
            f"the inclinometer reads {factor:.2g} of the angle there (at least 0.2 is needed); "
            "mount it nearer to the pivot, or use motion capture"
        )
    return reading_rad / factor


def reading_flags(factor: float) -> tuple[Flag, ...]:
    """Flag a place where the instrument misreads by more than a tenth."""
    if abs(factor - 1.0) <= LARGEST_LOSS:
        return ()
    message = (
        f"carried along, the inclinometer reads {factor:.2g} of the angle (its period stands, its "
        "amplitude does not); mount it at the pivot, or use motion capture"
    )
    return (Flag("inclinometer_misreads", Severity.WARNING, message),)
