"""Conversion between gauge readings and the struts' loads on the model in body axes.

Readings are those of the aft, the fore and the X gauge (of a turntable: force, moment and X); loads
are force, moment and surge force about the reference point. Both are of the struts on the model.
At a given angle of the struts' line one is a matrix times the other, which is all there is to it.
"""

import numpy as np

from analysis.kinematics.geometry import Geometry, Waves
from hardware.description.arrangement import DriftBy, Joint
from hardware.description.errors import DataError

ROWS = ("force", "moment", "surge force")


def loads(geometry: Geometry, line_rad: Waves, readings: Waves) -> Waves:
    """Return the struts' loads on the model.

    They have the shape of the readings, :data:`ROWS`; without an X gauge there is no surge force.

    Parameters
    ----------
    line_rad
        :attr:`analysis.kinematics.motion.MotionWaves.line_rad`, shape ``(..., instants)``.
    readings
        Shape ``(..., 3, instants)``, or ``(..., 2, instants)`` without an X gauge.

    Raises
    ------
    DataError
        If there is no X gauge although the others' loads depend on it.
    """
    matrix = load_matrix(geometry, line_rad)
    if readings.shape[-2] == 2:
        check_surge_spared(geometry)
        matrix = matrix[..., :2, :2]
    return np.asarray(np.einsum("...trc,...ct->...rt", matrix, readings))


def readings(geometry: Geometry, line_rad: Waves, loads: Waves) -> Waves:
    """Return the gauge readings of loads, both of shape ``(..., 3, instants)``: the inverse."""
    inverse = np.linalg.inv(load_matrix(geometry, line_rad))
    return np.asarray(np.einsum("...trc,...ct->...rt", inverse, loads))


def check_surge_spared(geometry: Geometry) -> None:
    """Refuse readings without an X gauge where force and moment depend on it.

    Raises
    ------
    DataError
        If the gauges stay with the rig, or the model is turned on its struts.
    """
    cause = None
    if not geometry.gauges_turn:
        cause = 'gauges = "rig": the gauges across read a part of the force along the model'
    elif np.any(np.real(geometry.turned(DriftBy.MODEL_TURNED)) != 0.0):
        cause = 'drift_by = "model_turned": the force across is partly one along the struts\' line'
    if cause is not None:
        raise DataError(f"force_x is missing, and with {cause}; record force_x as well")


def load_matrix(geometry: Geometry, line_rad: Waves) -> Waves:
    """Return the matrices that turn readings into loads, shape ``(..., instants, 3, 3)``."""
    along, across, moment = (
        _table(geometry, line_rad) if geometry.has_table else _struts(geometry, line_rad)
    )
    turn = np.asarray(geometry.turned(DriftBy.MODEL_TURNED))[..., None]
    cosine, sine = np.cos(turn), np.sin(turn)
    rows = (across * cosine - along * sine, geometry.side * moment, along * cosine + across * sine)
    return np.stack(rows, axis=-2)


def _struts(geometry: Geometry, line: Waves) -> tuple[Waves, Waves, Waves]:
    """Forces along and across the struts' line and the moment, by aft, fore and X reading."""
    aft, fore, x = np.moveaxis(np.broadcast_to(np.eye(3), (*line.shape, 3, 3)), -2, 0)
    pivot, slide = (aft, fore) if geometry.pivot_sign > 0.0 else (fore, aft)
    cosine, sine = np.cos(line)[..., None], np.sin(line)[..., None]
    turns = geometry.gauges_turn
    held_along, held = (
        (x, pivot)
        if turns
        else (
            x * cosine + pivot * sine,
            pivot * cosine - x * sine,
        )
    )
    half = np.asarray(geometry.half_spacing_m)[..., None]
    if geometry.arrangement.joint is Joint.SLIDES_ON_MODEL:
        pushed_along, pushed = 0.0 * slide, slide if turns else slide / cosine
        lever = 2.0 * half / cosine - half
    else:
        push = slide / cosine if turns else slide
        pushed_along, pushed, lever = push * sine, push * cosine, half
    moment = geometry.pivot_sign * (pushed * lever - held * half)
    return held_along + pushed_along, held + pushed, moment


def _table(geometry: Geometry, line: Waves) -> tuple[Waves, Waves, Waves]:
    """Forces along and across the turntable and its moment, by the three readings."""
    force, moment, x = np.moveaxis(np.broadcast_to(np.eye(3), (*line.shape, 3, 3)), -2, 0)
    if not geometry.gauges_turn:
        cosine, sine = np.cos(line)[..., None], np.sin(line)[..., None]
        force, x = force * cosine - x * sine, x * cosine + force * sine
    return x, force, geometry.side * moment
