"""Strut displacements to body motion and back, strut forces to body loads and back: pure pairs.

All directions are linear, so they serve displacements, velocities, accelerations, forces and
complex phasors alike, single values or arrays. The two pairs are dual: the power of the struts is
that of the loads in the motion.
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


def to_loads(aft: T, fore: T, half_spacing_m: float, plane: Plane) -> tuple[T, T]:
    """Turn strut forces into the load on the model.

    Parameters
    ----------
    aft, fore
        Forces of the struts on the model at ``x = -l`` and ``x = +l``, in newtons: positive down
        (vertical) or to starboard (horizontal).
    half_spacing_m
        The distance ``l``.

    Returns
    -------
    force, moment
        Their sum in N, and the moment about the midpoint in N m: bow up, or bow to starboard.
    """
    difference = aft - fore if plane is Plane.VERTICAL else fore - aft
    return aft + fore, difference * half_spacing_m


def to_strut_forces(force: T, moment: T, half_spacing_m: float, plane: Plane) -> tuple[T, T]:
    """Turn force and moment about the midpoint into strut forces ``(aft, fore)``: the inverse."""
    couple = moment / half_spacing_m
    if plane is Plane.VERTICAL:
        return (force + couple) / 2.0, (force - couple) / 2.0
    return (force - couple) / 2.0, (force + couple) / 2.0
