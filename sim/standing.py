"""A rig whose shaft stands: what its gauges read where nothing moves.

A zero run is made so, and a diagnosis asks for it. It is an oscillation of no eccentricity whose
shaft does not turn; the period is only what its length is counted in.
"""

import math
from dataclasses import replace

import numpy as np

from hardware.description.oscillator import Range
from hardware.description.setpoint import SetPoint
from sim import signals
from sim.drive import DriveSettings
from sim.period import Period
from sim.periodic import SteadyState, steady_state
from sim.rig import SimulatedRig

_ORDERS = 2
_POINTS = 64
_TURN_HZ = 1.0  # of the period in which nothing happens
_MOTIONS = (
    (signals.DISPLACEMENT_AFT, signals.VELOCITY_AFT, signals.ACCELERATION_AFT),
    (signals.DISPLACEMENT_FORE, signals.VELOCITY_FORE, signals.ACCELERATION_FORE),
)


def standing(rig: SimulatedRig) -> SimulatedRig:
    """Return the rig with a drive that does not turn, at the struts' middle position.

    What the drive would do to a turning shaft, and how the linkage turns it into motion, does not
    matter any more; nor do the oscillator's limits. A joint's clearance lies at the side at which
    the gauges were tared.
    """
    anything = Range(0.0, math.inf)
    return replace(
        rig,
        oscillator=replace(rig.oscillator, frequency_hz=anything, eccentricity_m=anything),
        drive=DriveSettings(initial_angle_rad=0.0, speed_error=-1.0),
        mounting=replace(rig.mounting, joint=None),
    )


def standing_state(
    rig: SimulatedRig, set_point: SetPoint, stands_at_m: tuple[float, float] = (0.0, 0.0)
) -> SteadyState:
    """Return what every signal is where the struts stand: the means, all harmonics 0.

    Parameters
    ----------
    set_point
        Of eccentricity 0; carriage speed and medium count.
    stands_at_m
        Displacement of the aft and the fore strut.

    Raises
    ------
    ConfigurationError
        If an effect or the mechanism cannot be at this set-point.
    """
    turn = replace(set_point, frequency_hz=_TURN_HZ)
    period = Period(_TURN_HZ, _ORDERS, _POINTS)
    still = np.zeros(_ORDERS + 1, dtype=np.complex128)
    given = {one.name: still for motion in _MOTIONS for one in motion}
    for (displacement, *_), at_m in zip(_MOTIONS, stands_at_m, strict=True):
        given[displacement.name] = period.constant(at_m)
    turning = replace(standing(rig), drive=DriveSettings())  # a period needs a turn
    return steady_state(turning.chain(turn), period, given)
