"""Exact motion in body axes from what the rig drives.

Two struts move at right angles to the rig; their line makes the angle ``a`` with it (ahead towards
across), the tangent or the sine of which is their difference over the spacing. The reference point
lies half the spacing off the pivot, on that line. In the rig's axes, with the carriage's speed, it
moves at ``V``; body axes are turned by ``a`` and by what the model is turned on its struts:

    u + i v = V exp(-i psi)        u' + i v' = (V' - i r V) exp(-i psi)

In the vertical plane the same holds with pitch = -a, bow up.
"""

from dataclasses import dataclass

import numpy as np

from analysis.kinematics.geometry import Geometry, Waves
from hardware.description.arrangement import DriftBy, Joint
from hardware.description.errors import DataError


@dataclass(frozen=True, eq=False)
class DrivenDisplacements:
    """Displacements that the rig drives: of the aft and fore strut, m; or of a turntable, m, rad.

    Arrays of shape ``(..., 2, instants)``: displacements about the positions that the drift sets,
    and their first and second derivatives.
    """

    value: Waves
    rate: Waves
    acceleration: Waves


@dataclass(frozen=True, eq=False)
class MotionWaves:
    """Motion of the model; waves over the instants.

    Attributes
    ----------
    line_rad
        Angle of the struts' line (the turntable) in the rig, ahead towards across.
    rotation_rad
        Of the model against the tank: yaw to starboard, or pitch, bow up.
    across_m
        Of the reference point, across the tank (down) from where it lies without motion or drift.
    velocity, rate
        Through the water, in body axes: ahead, across and turning (u, v, r or u, w, q) and their
        time derivatives, those with the carriage's speed steady, shape ``(..., 3, instants)``.
    """

    line_rad: Waves
    rotation_rad: Waves
    across_m: Waves
    velocity: Waves
    rate: Waves


def motion(geometry: Geometry, driven: DrivenDisplacements) -> MotionWaves:
    """Return the model's motion in body axes.

    Raises
    ------
    DataError
        If the struts are further apart across the rig than the attachments can reach.
    """
    line, turning, bending = _line(geometry, driven)
    across, velocity, acceleration = _reference_point(geometry, driven, line, turning, bending)
    rig = geometry.turned(DriftBy.RIG_TURNED)
    on_struts = geometry.turned(DriftBy.MODEL_TURNED)
    speed = geometry.speed_m_s + geometry.varies_m_s
    ahead = velocity[0] + speed * np.cos(rig)
    aside = velocity[1] - speed * np.sin(rig)
    cosine, sine = np.cos(line + on_struts), np.sin(line + on_struts)
    u, v = ahead * cosine + aside * sine, aside * cosine - ahead * sine
    u_rate = acceleration[0] * cosine + acceleration[1] * sine + turning * v
    v_rate = acceleration[1] * cosine - acceleration[0] * sine - turning * u
    side = geometry.side
    return MotionWaves(
        line,
        side * (line + on_struts + rig),
        across,
        np.stack((u, v, side * turning), axis=-2),
        np.stack((u_rate, v_rate, side * bending), axis=-2),
    )


def _line(geometry: Geometry, driven: DrivenDisplacements) -> tuple[Waves, Waves, Waves]:
    """Angle of the struts' line in the rig with its first and second derivative."""
    if geometry.has_table:
        set_to = geometry.turned(DriftBy.STRUTS_OFFSET)
        value, rate, acceleration = _ends(driven, 1)
        return geometry.side * value + set_to, geometry.side * rate, geometry.side * acceleration
    aft, fore = _ends(driven, 0), _ends(driven, 1)
    spacing = 2.0 * geometry.half_spacing_m
    slope, rate, bend = (
        (two - aft_part) / spacing for aft_part, two in zip(aft, fore, strict=True)
    )
    slope = slope + 2.0 * geometry.offset_m / spacing
    if geometry.arrangement.joint is Joint.SLIDES_ON_MODEL:
        square = 1.0 + slope**2
        return np.arctan(slope), rate / square, (bend - 2.0 * slope * rate**2 / square) / square
    largest = float(np.abs(slope.real).max())
    if not largest < 1.0:
        raise DataError(
            f"the struts' displacements differ by {largest:.3g} of their spacing (limit 1, where "
            "the model would stand across); check half_spacing_m and the displacements' units"
        )
    root = np.sqrt(1.0 - slope**2)
    return np.arcsin(slope), rate / root, (bend + slope * rate**2 / root**2) / root


def _reference_point(
    geometry: Geometry, driven: DrivenDisplacements, line: Waves, turning: Waves, bending: Waves
) -> tuple[Waves, tuple[Waves, Waves], tuple[Waves, Waves]]:
    """Its place across the rig, its velocity and its acceleration, ahead and across."""
    if geometry.has_table:
        place, rate, acceleration = _ends(driven, 0)
        still = np.zeros_like(rate)
        return _across_tank(geometry, still, place), (still, rate), (still, acceleration)
    reach = geometry.pivot_sign * geometry.half_spacing_m
    pivot = _ends(driven, 0 if geometry.pivot_sign > 0.0 else 1)
    ahead, aside = reach * np.cos(line), reach * np.sin(line)
    place = pivot[0] - geometry.pivot_sign * geometry.offset_m + aside
    return (
        _across_tank(geometry, ahead - reach, place),
        (-aside * turning, pivot[1] + ahead * turning),
        (
            -aside * bending - ahead * turning**2,
            pivot[2] + ahead * bending - aside * turning**2,
        ),
    )


def _across_tank(geometry: Geometry, ahead: Waves, across: Waves) -> Waves:
    rig = geometry.turned(DriftBy.RIG_TURNED)
    return np.asarray(ahead * np.sin(rig) + across * np.cos(rig))


def _ends(driven: DrivenDisplacements, index: int) -> tuple[Waves, Waves, Waves]:
    return (
        driven.value[..., index, :],
        driven.rate[..., index, :],
        driven.acceleration[..., index, :],
    )
