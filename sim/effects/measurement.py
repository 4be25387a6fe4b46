"""Common parts of the measurement's effects: changed gauges, converters, recorded harmonics.

No effect itself.
"""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from hardware.description.arrays import ComplexArray
from sim.acquisition.channels import Digitiser
from sim.effects.effect import Signature
from sim.effects.situation import RECORDED_FORCES, Situation, at_struts
from sim.gauges.dynamometer import Dynamometer
from sim.rig import SimulatedRig

HIGHEST = 3  # order that a signature names
MOST = 12  # order up to which the nominal force is known

Pair = tuple[float, float]


def with_gauges(
    rig: SimulatedRig, change: Callable[[Dynamometer, int], Dynamometer]
) -> SimulatedRig:
    """Return the rig with both gauges changed; ``change`` is given 0 for aft and 1 for fore."""
    old = rig.dynamometers
    return replace(rig, dynamometers=replace(old, aft=change(old.aft, 0), fore=change(old.fore, 1)))


def with_force_channels(
    rig: SimulatedRig, change: Callable[[Digitiser, int], Digitiser]
) -> SimulatedRig:
    """Return the rig with the channels of both forces changed, where it records them."""
    old = rig.acquisition
    aft = None if old.force_aft is None else change(old.force_aft, 0)
    fore = None if old.force_fore is None else change(old.force_fore, 1)
    return replace(rig, acquisition=replace(old, force_aft=aft, force_fore=fore))


def settled_more(settling_s: float, as_far_s: float) -> float:
    """Return by how much faster what settles has to begin, to be as far after a time.

    That is ``t/(T (1 - exp(-t/T)))``, T its time constant.
    """
    return -as_far_s / (settling_s * math.expm1(-as_far_s / settling_s))


def delayed_rig(rig: SimulatedRig, delay_s: float) -> SimulatedRig:
    """Return the rig with all its channels and the photocell's pulses later by as much."""
    if not delay_s:
        return rig
    channels = {
        line.channel.name: replace(line.digitiser, delay_s=line.digitiser.delay_s + delay_s)
        for line in rig.acquisition.lines
    }
    cell = rig.photocell
    if cell is not None:
        cell = replace(cell, latency_s=cell.latency_s + delay_s)
    return replace(rig, acquisition=replace(rig.acquisition, **channels), photocell=cell)


def of_forces(
    situation: Situation, change: Callable[[int, ComplexArray], ComplexArray]
) -> Signature:
    """Return a signature of the recorded forces, orders 0 to 3.

    ``change`` is given an order and the nominal phasors of both struts.
    """
    changes: dict[tuple[str, int], complex] = {}
    for order in range(HIGHEST + 1):
        changes |= at_struts(change(order, situation.force(order)), order, RECORDED_FORCES)
    return changes


def of_waves(situation: Situation, change: Callable[[str, int], complex]) -> Signature:
    """Return a signature of every recorded force and displacement: ``change(name, order)``."""
    return {
        (name, order): change(name, order)
        for name in situation.recorded_waves
        for order in range(HIGHEST + 1)
    }


def squared_forces(situation: Situation) -> ComplexArray:
    """Return the harmonics of each strut's force squared, shape ``(orders + 1, 2)``.

    With F = sum H_n exp(i n th) in two-sided form the square is a convolution; for a force with one
    harmonic it leaves ``|H|^2/2`` as the mean and -i H^2/2 at the second order.
    """
    forces = np.array([situation.force(order) for order in range(MOST + 1)])
    columns = [_square(forces[:, strut]) for strut in range(2)]
    return np.column_stack(columns)


def _square(phasors: ComplexArray) -> ComplexArray:
    mean, waves = phasors[:1].real, -1j * phasors[1:] / 2.0
    both_sides = np.concatenate([np.conj(waves[::-1]), mean, waves])
    product = np.convolve(both_sides, both_sides)[2 * (phasors.size - 1) :][: phasors.size]
    harmonics: ComplexArray = 2j * product
    harmonics[0] = product[0].real
    return harmonics
