"""What the operator is asked for to set a drift (trim) angle."""

import math

from analysis.kinematics.geometry import Geometry
from hardware.description.arrangement import DriftBy
from hardware.description.oscillator import Plane


def drift_prompt(geometry: Geometry) -> str:
    """Return what an operator does to set the drift (trim) angle as the rig's ``drift_by`` says."""
    angle = _angle(geometry)
    match geometry.arrangement.drift_by:
        case DriftBy.RIG_TURNED:
            return f"turn the whole oscillator on the carriage: {angle}"
        case DriftBy.MODEL_TURNED:
            return f"turn the model on its struts: {angle}; the oscillator stays straight"
        case DriftBy.STRUTS_OFFSET if geometry.has_table:
            return f"set the turntable's mean angle: {angle}"
        case DriftBy.STRUTS_OFFSET:
            return f"set the struts' mean positions apart: {_apart(geometry)}, for {angle}"


def _angle(geometry: Geometry) -> str:
    angle = float(geometry.drift_rad)
    if not angle:
        return "straight (0 rad)"
    to = ("up", "down") if geometry.plane is Plane.VERTICAL else ("to starboard", "to port")
    return f"{abs(angle):.4f} rad ({math.degrees(abs(angle)):.2f} deg), bow {to[angle < 0.0]}"


def _apart(geometry: Geometry) -> str:
    offset = float(geometry.offset_m)
    to = ("down", "up") if geometry.plane is Plane.VERTICAL else ("to starboard", "to port")
    fore, aft = to if offset >= 0.0 else to[::-1]
    return f"fore {1e3 * abs(offset):.2f} mm {fore}, aft as much {aft}"
