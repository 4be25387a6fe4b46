"""What an oscillation with propeller and rudder has at the two instants of its fastest turn.

There the rate of turn stands still for a moment: propeller and rudder work as on a circle of that
rate. Loads of the hull, its inertia among them, are those of every run with the same motion.
"""

import math
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from analysis.coefficients.body_axes import at_order
from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.phasors import Phasors
from analysis.coefficients.strut_phasors import reading_phasors
from analysis.recording import Recording
from analysis.resolver.analysis import analyse
from hardware.description.errors import DataError
from pmm.coefficients.tasks import Task

HARMONICS: Final = 12
"""Of every channel: the normal force has a corner where the inflow changes sides. On a simulated
KVLCC2 eight move gamma_R by two standard uncertainties, twelve and twenty-four agree in a third."""
_SWAYS: Final = 0.05  # turns less than this, per half the spacing and per translation
_LOADS: Final = ("surge_force", "force", "moment")
SIDES: Final = {"starboard": 1.0, "port": -1.0}


@dataclass(frozen=True)
class Instant:
    """One of the two.

    Attributes
    ----------
    side
        To which the model turns.
    motion
        u, v (m/s) and r (rad/s) of the midpoint through the water.
    loads, loads_u
        X, Y (N) and N (N m) on the model, inertia among them, and their standard uncertainties.
    gauges, gauges_u
        Of each channel that was asked for.
    """

    side: str
    motion: tuple[float, float, float]
    loads: tuple[float, ...]
    loads_u: tuple[float, ...]
    gauges: tuple[float, ...]
    gauges_u: tuple[float, ...]


def only_sways(task: Task) -> bool:
    """Tell whether a run oscillates and has no turn in it that would tell anything."""
    half = 0.5 * task.set_point.strut_phase_rad
    return task.kind.oscillates and abs(math.sin(half)) < _SWAYS * abs(math.cos(half))


def instants(
    task: Task, recording: Recording, cycle: BodyCycle, gauges: tuple[str, ...]
) -> list[Instant]:
    """Return both instants of a run.

    Raises
    ------
    DataError
        If the means are not those of the water, or the gauges' harmonics cannot be told.
    """
    if not cycle.mean_known:
        raise DataError(
            f"{cycle.name}: no zero run is named, and the means of the struts' forces are needed; "
            "name one as zero_before or zero_after, or say tared = true in the campaign file"
        )
    turning = cycle.phasors[at_order("rotation", 1)]
    settings = replace(task.settings, channels=gauges, harmonics=cycle.orders)
    reading = analyse(recording, task.choice, settings).readings[0]
    read = reading_phasors(reading, gauges, cycle.orders)
    # Im[(S + iC) e^(i theta)] turns fastest where its derivative, Re, is greatest: theta = -arg.
    first = -math.atan2(turning.imag, turning.real)
    return [
        _instant(side, cycle, read, gauges, first + (0.0 if sign > 0.0 else math.pi))
        for side, sign in SIDES.items()
    ]


def _instant(
    side: str, cycle: BodyCycle, read: Phasors, gauges: tuple[str, ...], angle_rad: float
) -> Instant:
    omega = 2.0 * math.pi * cycle.frequency_hz
    ahead, across, rotation = (
        np.array([cycle.phasors[at_order(name, n)] for n in range(cycle.orders + 1)])
        for name in ("ahead", "across", "rotation")
    )
    turn = np.exp(1j * angle_rad * np.arange(cycle.orders + 1))
    rate = 1j * omega * np.arange(cycle.orders + 1) * rotation
    u, v = (
        float(velocity[0].real + (velocity[1:] * turn[1:]).imag.sum())
        for velocity in (ahead, across)
    )
    motion = (u, v, float((rate * turn).imag.sum()))
    loads, loads_u = _at(cycle.phasors, _LOADS, angle_rad)
    readings, readings_u = _at(read, gauges, angle_rad)
    return Instant(side, motion, tuple(-load for load in loads), loads_u, readings, readings_u)


def _at(
    phasors: Phasors, names: tuple[str, ...], angle_rad: float
) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Return some channels at a phase, and their standard uncertainties."""
    slope = np.zeros((len(names), 2 * len(phasors.names)))
    for row, name in enumerate(names):
        for place, label in enumerate(phasors.names):
            channel, _, order = label.rpartition(" ")
            if channel == name:
                n = int(order)
                slope[row, 2 * place] = math.sin(n * angle_rad) if n else 1.0
                slope[row, 2 * place + 1] = math.cos(n * angle_rad) if n else 0.0
    levels = phasors.real.mapped(slope)
    return tuple(levels.values.tolist()), tuple(levels.standard_uncertainty.tolist())
