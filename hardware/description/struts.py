"""Strut displacements to body motion and back: a pure pair.

Both directions are linear, so they serve displacements, velocities, accelerations and complex
phasors alike, single values or arrays.
"""

from typing import TypeVar

import numpy as np

from hardware.description.oscillator import Plane

T = TypeVar("T", float, complex, np.ndarray)


def to_motion(aft: T, fore: T, half_spacing_m: float, plane: Plane) -> tuple[T, T]:
    """Turn strut displacements into the motion of the midpoint.

    Parameters
    ----------
    aft, fore
        Displacements of the struts at ``x = -l`` and ``x = +l``, in metres: positive down
        (vertical) or to starboard (horizontal).
    half_spacing_m
        The distance ``l``.

    Returns
    -------
    translation, rotation
        Heave in metres (down) and pitch in radians (bow up), or sway in metres (to starboard) and
        yaw in radians (bow to starboard).
    """
    difference = aft - fore if plane is Plane.VERTICAL else fore - aft
    return (aft + fore) / 2.0, difference / (2.0 * half_spacing_m)


def to_struts(translation: T, rotation: T, half_spacing_m: float, plane: Plane) -> tuple[T, T]:
    """Turn the midpoint's motion into strut displacements ``(aft, fore)``: the inverse."""
    lever = half_spacing_m * rotation
    if plane is Plane.VERTICAL:
        return translation + lever, translation - lever
    return translation - lever, translation + lever
