"""The linkages at one instant: what the compiled march of model and drive needs of them."""

import math

import numpy as np

from hardware.description.arrays import FloatArray
from sim.mechanism.linkage import Mechanism
from sim.solve.compilation import compile_loop


def linkages_of(mechanism: Mechanism) -> FloatArray:
    """Return the linkages of a mechanism whose joints have no play.

    Aft and fore, shape ``(2, 5)``: eccentricity and phase of the crank as it is; length of a rod, 0
    for a yoke; what its guide misses the crank's centre by; what is taken off its reach.
    """
    rows = []
    rod = mechanism.rod_length_m
    for setting, phase_rad in mechanism.struts:
        eccentricity = setting.eccentricity_m(mechanism.eccentricity_m)
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
    return np.array(rows)


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
