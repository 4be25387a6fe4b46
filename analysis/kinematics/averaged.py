"""A run's averaged cycle in body axes, from the harmonics of what was measured."""

from dataclasses import dataclass

from analysis.kinematics.cycle import driven, waves
from analysis.kinematics.geometry import Geometry, Waves
from analysis.kinematics.motion import Motion, motion
from analysis.kinematics.projection import loads

DISPLACED = 2
"""Channels of displacements; those of the gauges follow."""


@dataclass(frozen=True, eq=False)
class BodyCycle:
    """The model over a cycle, waves over the instants.

    Attributes
    ----------
    loads
        Of the struts on the model, gross: force, moment and, with an X gauge, surge force; shape
        ``(..., 2 or 3, instants)``.
    """

    motion: Motion
    loads: Waves


def in_body_axes(
    geometry: Geometry, parts: Waves, omega: Waves | float, *, gauges: int = 3
) -> BodyCycle:
    """Return motion and loads of the model over the averaged cycle.

    The loads are as complete as the readings' harmonics are: a gauge's order left out is missed in
    its neighbours by the sine of the angle. A fit that turns its terms into readings
    (:func:`analysis.kinematics.projection.readings`) misses nothing.

    Parameters
    ----------
    parts
        Interleaved harmonics of the channels, order by order: the displacements of aft and fore
        strut, m, and what the gauges aft, fore and X read, N (of a turntable sway or heave, m, and
        its angle, rad; force, moment and X). Shape ``(..., 2 * (2 + gauges) * (orders + 1))``.
    omega
        Angular frequency, shape ``(...)``, rad/s.
    gauges
        3, or 2 without an X gauge.

    Raises
    ------
    DataError
        If the struts cannot reach, or an X gauge is missing that the other loads depend on.
    """
    channels = DISPLACED + gauges
    shaped = parts.reshape(*parts.shape[:-1], -1, channels, 2)
    moved = shaped[..., :DISPLACED, :].reshape(*parts.shape[:-1], -1)
    read = shaped[..., DISPLACED:, :].reshape(*parts.shape[:-1], -1)
    found = motion(geometry, driven(moved, omega))
    return BodyCycle(found, loads(geometry, found.line_rad, waves(read, gauges)))
