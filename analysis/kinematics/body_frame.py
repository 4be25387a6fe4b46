"""Motion of the model through the water, and the struts' loads on it, in body axes."""

import numpy as np

from analysis.kinematics.geometry import Geometry, Waves
from analysis.kinematics.motion import DrivenDisplacements, motion
from analysis.kinematics.projection import loads

CHANNELS = ("translation", "rotation", "ahead", "across", "force", "moment", "surge_force")
UNITS = ("m", "rad", "m/s", "m/s", "N", "N m", "N")
ROLL_MOMENT, HEEL = "roll_moment", "heel"
HEELED = (*CHANNELS, ROLL_MOMENT, HEEL)
"""The channels of a model that heels: the struts' moment on it in roll, and its angle."""
UNIT_OF = dict(zip(HEELED, (*UNITS, "N m", "rad"), strict=True))
LOADS = ("force", "moment", "surge_force", ROLL_MOMENT)


def in_body_axes(
    geometry: Geometry, driven: DrivenDisplacements, readings: Waves, roll: Waves | None = None
) -> Waves:
    """Return motion and loads of the model about its reference point.

    The loads are as complete as the readings' harmonics are: a gauge's order left out is missed in
    its neighbours by the sine of the angle.

    Its rows are :data:`HEELED`, those that there is a gauge for: displacement across the tank and
    rotation against it, velocities through the water along and across the model, and the struts'
    loads on it, gross, in axes that do not heel; shape ``(..., 6 to 9, instants)``.

    Parameters
    ----------
    readings
        Of the gauges aft, fore and X, N (of a turntable force, moment and X), shape
        ``(..., 3, instants)``; ``(..., 2, instants)`` without an X gauge.
    roll
        Moment in roll where there is a gauge for it, and heel, shape ``(..., 1 or 2, instants)``;
        ``None`` for a model that does not heel. A gauge that heels reads the cosine of a force, no
        vertical force passing it.

    Raises
    ------
    DataError
        If the struts cannot reach, or an X gauge is missing that the other loads depend on.
    """
    moving = motion(geometry, driven)
    if roll is not None and geometry.gauges_heel:
        upright = np.ones_like(readings)
        upright[..., :2, :] = 1.0 / np.cos(roll[..., -1:, :])
        readings = readings * upright
    place = np.stack((moving.across_m, moving.rotation_rad), axis=-2)
    held = loads(geometry, moving.line_rad, readings)
    rows = (place, moving.velocity[..., :2, :], held, *(() if roll is None else (roll,)))
    return np.concatenate(rows, axis=-2)
