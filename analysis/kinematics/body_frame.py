"""Motion of the model through the water, and the struts' loads on it, in body axes."""

import numpy as np

from analysis.kinematics.geometry import Geometry, Waves
from analysis.kinematics.motion import Driven, motion
from analysis.kinematics.projection import loads

CHANNELS = ("translation", "rotation", "ahead", "across", "force", "moment", "surge_force")
UNITS = ("m", "rad", "m/s", "m/s", "N", "N m", "N")


def in_body_axes(geometry: Geometry, driven: Driven, readings: Waves) -> Waves:
    """Return motion and loads of the model about its reference point.

    The loads are as complete as the readings' harmonics are: a gauge's order left out is missed in
    its neighbours by the sine of the angle.

    Its rows are :data:`CHANNELS`, the last only with an X gauge: displacement across the tank and
    rotation against it, velocities through the water along and across the model, and the struts'
    loads on it, gross; shape ``(..., 6 or 7, instants)``.

    Parameters
    ----------
    readings
        Of the gauges aft, fore and X, N (of a turntable force, moment and X), shape
        ``(..., 3, instants)``; ``(..., 2, instants)`` without an X gauge.

    Raises
    ------
    DataError
        If the struts cannot reach, or an X gauge is missing that the other loads depend on.
    """
    moving = motion(geometry, driven)
    place = np.stack((moving.across_m, moving.rotation_rad), axis=-2)
    held = loads(geometry, moving.line_rad, readings)
    return np.concatenate((place, moving.velocity[..., :2, :], held), axis=-2)
