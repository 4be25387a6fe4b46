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

    The results are translation, rotation: heave in metres (down) and pitch in radians (bow up), or
    sway in metres (to starboard) and yaw in radians (bow to starboard).

    Parameters
    ----------
    aft, fore
        Displacements of the struts at ``x = -l`` and ``x = +l``, in metres: positive down
        (vertical) or to starboard (horizontal).
    half_spacing_m
        The distance ``l``.
    """
    difference = aft - fore if plane is Plane.VERTICAL else fore - aft
    return (aft + fore) / 2.0, difference / (2.0 * half_spacing_m)


def to_strut_forces(force: T, moment: T, half_spacing_m: float, plane: Plane) -> tuple[T, T]:
    """Turn a load on the model into the forces of the struts on it.

    The results are aft, fore: forces at ``x = -l`` and ``x = +l`` in N, positive as the force.

    Parameters
    ----------
    force, moment
        Force in N, positive down (vertical) or to starboard (horizontal), and moment about the
        midpoint in N m, bow up or bow to starboard.
    half_spacing_m
        The distance ``l``.
    """
    couple = moment / half_spacing_m
    if plane is Plane.VERTICAL:
        return (force + couple) / 2.0, (force - couple) / 2.0
    return (force - couple) / 2.0, (force + couple) / 2.0
