"""First harmonics against the simulation's: another unit, another sign, a run that went wrong.

Each run's first harmonics are held against the nominal simulation, and their ratio against that of
the other runs: a simulation whose coefficients are far off is off in all runs, a file in other
units only in its own.
"""

import cmath
import math
from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np

from analysis.gap.observe.components import GapRun, Part, Stack
from analysis.gap.quality.finding import SAY_UNIT, UNIT_NEAR, Doubt
from analysis.mistaken_units import mistaken
from hardware.description.arrays import FloatArray
from hardware.description.channels import DISPLACEMENT_AFT, DISPLACEMENTS, FORCE_AFT
from hardware.description.setpoint import Medium
from sim.rig import SimulatedRig

_ODD: Final = math.log(1.8)  # a ratio that no gap of a working rig reaches in one run alone
_ALIKE: Final = 0.15  # spread of the other runs' ratios up to which one that is odd stands out
_TURNED_RAD: Final = 1.0
_SIGN_RAD: Final = 2.6
_NOTHING: Final = math.log(1e-6)  # of what is simulated: rounding
_HEARD: Final = 4.0  # times its uncertainty: less is none of the motion's
_FEW: Final = 3
_SMALL: Final = 0.1  # of the terms of a force: a prediction below it is a difference of large ones
_TOLERATED: Final = 0.25  # of those terms: what tolerances of added mass and damping make of them


def of_first_harmonics(
    rig: SimulatedRig, stack: Stack, nominal: FloatArray, channel: str
) -> Iterator[Doubt]:
    """Yield doubts of a strut's displacement or of a force.

    Parameters
    ----------
    nominal
        The simulation's components, shape ``(observations,)``.
    """
    ratio_pairs = _ratios(rig, stack, nominal, channel)
    if len(ratio_pairs) < _FEW:
        return
    ratios = {name: ratio for name, (ratio, _) in ratio_pairs.items()}
    sizes = {name: math.log(max(abs(ratio), 1e-12)) for name, ratio in ratios.items()}
    usual = float(np.median(list(sizes.values())))
    unit = (DISPLACEMENT_AFT if channel in DISPLACEMENTS else FORCE_AFT).unit
    turns = _middle_turn(list(ratios.values()))
    common = _common_fault(usual, cmath.phase(turns), mistaken(math.exp(usual), unit, UNIT_NEAR))
    if common:
        yield Doubt("", channel, common)
        return
    for name, ratio in ratios.items():
        other_sizes = [size for other_name, size in sizes.items() if other_name != name]
        relative = ratio / turns / math.exp(usual)
        meant = mistaken(math.exp(sizes[name] - usual), unit, UNIT_NEAR)
        reason = _reason(sizes[name] - usual, cmath.phase(relative), _spread(other_sizes), meant)
        if reason and abs(relative - 1.0) > ratio_pairs[name][1]:
            yield Doubt(name, channel, reason)


def _common_fault(size: float, turn_rad: float, meant: str) -> str:
    """Return what is wrong with the usual ratio, and so with all runs; empty if nothing is."""
    if size < _NOTHING:
        return "it does not move in most runs: leave it out of the columns"
    if meant:
        said = f"{math.exp(size):.3g} times what is simulated, in all runs: {meant}?"
        return f"{said} Then {SAY_UNIT}"
    if abs(turn_rad) > _SIGN_RAD and abs(size) < _ODD:
        said = "its sign is the opposite of what is simulated, in all runs"
        return f"{said}: the column's, or a photocell half a turn off?"
    return ""


def _reason(size: float, turn_rad: float, spread: float, meant: str) -> str:
    """Return what is wrong with a ratio, against that of the other runs; empty if nothing is."""
    if size < _NOTHING:
        return "it does not move"
    said = f"{math.exp(size):.3g} times as large as the other runs let expect"
    if meant and spread < 2.0 * _ALIKE:
        return f"{said}: {meant}?"
    if abs(turn_rad) > _SIGN_RAD and abs(size) < _ODD:
        return "its sign is the opposite of the other runs'"
    if spread < _ALIKE and abs(size) > _ODD:
        return said
    if spread < _ALIKE and abs(turn_rad) > _TURNED_RAD:
        return f"turned by {math.degrees(turn_rad):.0f} degrees against the other runs"
    return ""


def _spread(values: Sequence[float]) -> float:
    middle = np.median(values)
    return 1.48 * float(np.median(np.abs(np.asarray(values) - middle)))


def _middle_turn(ratios: Sequence[complex]) -> complex:
    """Return the unit phasor about which most ratios lie; one that is opposite does not count."""
    unit = np.array([ratio / abs(ratio) for ratio in ratios if ratio] or [1.0 + 0.0j])
    return complex(unit[np.argmin([np.median(np.abs(unit - phasor)) for phasor in unit])])


def _ratios(
    rig: SimulatedRig, stack: Stack, nominal: FloatArray, channel: str
) -> dict[str, tuple[complex, float]]:
    """Return measured over simulated first harmonic by run, where both say something.

    Beside each stands by how much it may be off where the terms of which the force is the
    difference are off by their usual tolerance.
    """
    ratios = {}
    for number, run in enumerate(stack.runs):
        simulated = complex(*_first(stack, nominal, number, channel))
        measured = complex(*_first(stack, stack.values, number, channel))
        noise = math.hypot(*_first(stack, stack.uncertainty, number, channel))
        if abs(measured) < _HEARD * noise < 0.1 * abs(simulated):
            measured = 0.0j  # what is left is noise
        if np.isfinite([simulated, measured]).all() and abs(simulated) > _least(rig, run, channel):
            slack = (
                0.0 if channel in DISPLACEMENTS else _TOLERATED * _terms(rig, run) / abs(simulated)
            )
            ratios[run.name] = measured / simulated, slack
    return ratios


def _first(stack: Stack, values: FloatArray, run: int, channel: str) -> tuple[float, float]:
    parts = {Part.IN_PHASE: math.nan, Part.QUADRATURE: math.nan}
    for at in np.flatnonzero(stack.run == run):
        component = stack.components[at]
        if component.channel == channel and component.order == 1:
            parts[component.part] = float(values[at])
    return parts[Part.IN_PHASE], parts[Part.QUADRATURE]


def _least(rig: SimulatedRig, run: GapRun, channel: str) -> float:
    if channel in DISPLACEMENTS:
        return 0.1 * run.set_point.eccentricity_m
    return _SMALL * _terms(rig, run)


def _terms(rig: SimulatedRig, run: GapRun) -> float:
    """Return about what inertia and restoring ask of a strut, one added to the other."""
    omega = 2.0 * math.pi * run.set_point.frequency_hz
    wet = float(run.set_point.medium is Medium.WATER)
    mass_kg = rig.body.mass_kg + wet * abs(rig.water.added_mass[0][0])
    stiffness_n_m = wet * abs(rig.water.restoring[0][0])
    return 0.5 * (mass_kg * omega**2 + stiffness_n_m) * run.set_point.eccentricity_m
