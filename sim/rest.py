"""A rig at rest: readings of its gauges with a standing shaft.

A zero run is made so, and a diagnosis asks for it. It is an oscillation of no eccentricity whose
shaft does not turn; the period is only what its length is counted in. What is done to a standing
rig, check weights that are put on and taken off or a sine in place of the bridges, has a period of
its own.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from hardware.description.arrays import ComplexArray
from hardware.description.oscillator import Range
from hardware.description.setpoint import SetPoint
from sim import signals
from sim.drive.prescribed_drive import DriveSettings
from sim.periodic import SteadyState, steady_state
from sim.rig import SimulatedRig
from sim.solve.period import Period

_ORDERS = 2
_POINTS = 64
_TURN_HZ = 1.0  # of the period in which nothing happens
_SLOW_HZ = 1e-3  # weights are put on and taken off so slowly that no filter shows


@dataclass(frozen=True)
class Excitation:
    """An excitation of the rig at rest, over a period of its own.

    Attributes
    ----------
    forces_n
        By signal, its mean and first harmonic, ``x(t) = Re sum X_n exp(i n w t)``.
    in_place
        Whether they take the place of what is there; else they come on top.
    """

    forces_n: tuple[tuple[str, complex, complex], ...]
    frequency_hz: float
    in_place: bool

    def of(self, spectra: Mapping[str, ComplexArray]) -> dict[str, ComplexArray]:
        """Return the signals' harmonics, where ``spectra`` are those without it."""
        harmonics = {}
        for name, mean, first in self.forces_n:
            spectrum = np.zeros(_ORDERS + 1, dtype=np.complex128)
            spectrum[:2] = mean, first
            harmonics[name] = spectrum if self.in_place else spectra[name] + spectrum
        return harmonics


def check_weight(weight_n: float, fore: bool = False) -> Excitation:
    """Return a check weight that is put on one strut's dynamometer, and taken off again."""
    name = (signals.FORCE_FORE if fore else signals.FORCE_AFT).name
    return Excitation(((name, 0.5 * weight_n, -0.5 * weight_n),), _SLOW_HZ, in_place=False)


def injection(force_n: float, frequency_hz: float) -> Excitation:
    """Return a sine that is fed into both force amplifiers in place of the bridges."""
    names = (signals.DYNAMOMETER_FORCE_AFT.name, signals.DYNAMOMETER_FORCE_FORE.name)
    forces = tuple((name, 0j, -1j * force_n) for name in names)
    return Excitation(forces, frequency_hz, in_place=True)


def rig_at_rest(rig: SimulatedRig) -> SimulatedRig:
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


def state_at_rest(
    rig: SimulatedRig,
    set_point: SetPoint,
    stands_at_m: tuple[float, float] = (0.0, 0.0),
    applied: Excitation | None = None,
) -> SteadyState:
    """Return all signals of the rig at rest: the means, all harmonics 0.

    Parameters
    ----------
    set_point
        Of eccentricity 0; carriage speed and medium count.
    stands_at_m
        Displacement of the aft and the fore strut.
    applied
        What is done to the rig, whose harmonics the signals then have.

    Raises
    ------
    ConfigurationError
        If an effect or the mechanism cannot be at this set-point.
    """
    turn_hz = _TURN_HZ if applied is None else applied.frequency_hz
    turn = replace(set_point, frequency_hz=turn_hz)
    period = Period(turn_hz, _ORDERS, _POINTS)
    still = np.zeros(_ORDERS + 1, dtype=np.complex128)
    spectra = {signal.name: still for motion in signals.STRUT_MOTIONS for signal in motion}
    for (displacement, *_), at_m in zip(signals.STRUT_MOTIONS, stands_at_m, strict=True):
        spectra[displacement.name] = period.constant(at_m)
    turning = replace(rig_at_rest(rig), drive=DriveSettings())  # a period needs a turn
    chain = turning.chain(turn)
    alone = steady_state(chain, period, spectra)
    return (
        alone
        if applied is None
        else steady_state(chain, period, spectra | applied.of(alone.spectra))
    )
