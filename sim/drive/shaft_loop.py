"""Shaft and linkages at one instant: what the compiled march of model and drive needs of them."""

import math
from typing import NamedTuple

import numpy as np

from hardware.description.arrays import FloatArray
from sim.mechanism.linkage import Mechanism
from sim.solve.compilation import compile_loop


class Linkages(NamedTuple):
    """Both struts' linkages.

    Attributes
    ----------
    rows
        Aft and fore, shape ``(2, 5)``: eccentricity and phase of the crank as it is; length of a
        rod, 0 for a yoke; what its guide misses the crank's centre by; what is taken off its reach.
    """

    rows: FloatArray


class ShaftLoop(NamedTuple):
    """The drive, ready to march.

    Attributes
    ----------
    driven
        False where the struts' motion is given, so that nothing here counts.
    step
        What a sample leaves of the n states, shape ``(n, n)``.
    by_inputs
        What the load torque and the gear's return add, oldest sample first, shape ``(4, n, 2)``.
    to_outputs, by_torque
        From states and from this sample's inputs (by way of the state too) to the outputs, shapes
        ``(n, 4)`` and ``(2, 4)``.
    at_once
        From this sample's inputs alone, where the state is known already.
    told
        Angle, speed, acceleration that the drive is told, ``(samples, 3)``.
    states, torques
        At the three samples before the first and, once solved, at each: ``(samples + 3, n)`` and
        ``(samples + 3, 1)``, or 2 with a gear that has a clearance.
    motion
        Filled in: angle, speed, acceleration and both levers, ``(samples, 5)``.
    numbers
        Inertia of the shaft, and of the model as far as it is solved as the shaft's; viscous and
        Coulomb friction of each strut's guides.
    cogging
        Order, torque and phase, one a row.
    gap
        As of the gauges' joints, N m and rad.
    """

    driven: bool
    step: FloatArray
    by_inputs: FloatArray
    to_outputs: FloatArray
    by_torque: FloatArray
    at_once: FloatArray
    told: FloatArray
    states: FloatArray
    torques: FloatArray
    motion: FloatArray
    numbers: FloatArray
    cogging: FloatArray
    gap: FloatArray


def linkages_of(mechanism: Mechanism) -> Linkages:
    """Return the linkages of a mechanism whose joints have no play."""
    rows = []
    rod = mechanism.rod_length_m
    for setting, phase_rad in mechanism.struts:
        eccentricity = mechanism.eccentricity_m + setting.eccentricity_error_m
        offset = setting.rod_offset_m
        rows.append(
            (
                eccentricity / math.cos(setting.slot_tilt_rad),
                phase_rad + setting.phase_error_rad + setting.slot_tilt_rad,
                rod or 0.0,
                offset,
                math.copysign(math.sqrt(rod**2 - offset**2), rod) if rod else 0.0,
            )
        )
    return Linkages(np.array(rows))


@compile_loop
def strut_motion(links: FloatArray, work: FloatArray, struts: FloatArray, into: int) -> None:
    """Fill in row ``into`` of the struts' motion, and the levers, from the shaft's motion.

    Parameters
    ----------
    work
        Row 2: angle, speed and acceleration of the shaft; the levers go behind them.
    """
    for i in range(2):
        e = links[i, 0]
        angle, speed = work[2, 0] + links[i, 1], work[2, 1]
        sine, cosine = math.sin(angle), math.cos(angle)
        place, slope, curvature = e * sine, e * cosine, -e * sine
        if links[i, 2] != 0.0:
            beside = e * cosine + links[i, 3]
            rod = math.copysign(math.sqrt(links[i, 2] ** 2 - beside**2), links[i, 2])
            rod_slope = e * sine * beside / rod
            place += rod - links[i, 4]
            slope += rod_slope
            curvature += (e * (cosine * beside - e * sine**2) - rod_slope**2) / rod
        struts[into, i] = place
        struts[into, 2 + i] = slope * speed
        struts[into, 4 + i] = curvature * speed**2 + slope * work[2, 2]
        work[2, 3 + i] = slope
