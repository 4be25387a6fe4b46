"""Plausibility of a campaign's recordings: units and signs of its channels, without a simulator.

What is known beforehand is little and sure: the set-points, that a model's force is of the order of
its inertia's, that both struts move one rigid body, and that a model resists being moved.
"""

import math
from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np

from analysis.gauge_wiring import likely_wiring
from analysis.mistaken_units import mistaken, mistaken_units
from analysis.run_harmonics import RunHarmonics
from hardware.description.body import Body
from hardware.description.channels import (
    DISPLACEMENT_AFT,
    DISPLACEMENTS,
    FORCE_AFT,
    FORCES,
)
from hardware.description.flags import Flag, Severity
from hardware.description.oscillator import Plane
from hardware.description.setpoint import SetPoint

_NEAR: Final = 0.1  # of a unit's factor, in the logarithm
_STEADY: Final = 0.2  # spread of the logarithm from run to run that a wrong unit leaves
_PLAUSIBLE: Final = (0.02, 200.0)  # force over that of the model's own inertia
_TYPICAL: Final = (0.1, 50.0)
_OPPOSITE_RAD: Final = 2.6
_MOST: Final = 0.8  # of the runs
_FEW: Final = 2
_SIGN: Final = (
    "if the instrument is mounted so, write sign = -1 (or '-' before its column) for it in "
    "[columns.channels]"
)
_UNIT: Final = "say its unit in [columns.channels], as in 'F1:kN'"


def plausibility_flags(
    runs: Sequence[RunHarmonics],
    body: Body | None = None,
    half_spacing_m: float | None = None,
    plane: Plane = Plane.HORIZONTAL,
) -> tuple[Flag, ...]:
    """Return ``units_implausible``, ``sign_opposite``, ``gauges_exchanged`` of a campaign's runs.

    Parameters
    ----------
    runs
        Those whose set-point moves nothing are passed over; with fewer than two left nothing is
        said.
    body, half_spacing_m
        The model and the struts' distance from its midpoint; without them the forces' unit is
        judged from one gauge against the other only, and nothing is said of the gauges' signs.
    """
    runs = [run for run in runs if run.set_point.eccentricity_m > 0.0]
    if len(runs) < _FEW:
        return ()
    units = (*_of_displacements(runs), *_of_forces(runs, body, half_spacing_m))
    gauges = () if half_spacing_m is None else _of_gauges(runs, body, half_spacing_m, plane)
    return (*units, *_of_phase_unit(runs), *_of_strut_signs(runs), *gauges)


def _of_displacements(runs: Sequence[RunHarmonics]) -> Iterator[Flag]:
    for name in DISPLACEMENTS:
        amplitudes = [
            (abs(run.first[name]), run.set_point.eccentricity_m) for run in _runs_with(runs, name)
        ]
        ratio = _usual_ratio([measured / set_m for measured, set_m in amplitudes if set_m > 0.0])
        unit = mistaken(ratio, DISPLACEMENT_AFT.unit, _NEAR)
        if unit:
            yield _units(name, f"{ratio:.3g} times the set-points' eccentricity", unit)


def _of_forces(
    runs: Sequence[RunHarmonics], body: Body | None, half_spacing_m: float | None
) -> Iterator[Flag]:
    units: set[str] = set()
    for name in FORCES if body is not None else ():
        inertial = [
            _inertia_n(run.set_point, body, half_spacing_m) for run in _runs_with(runs, name)
        ]
        measured = [abs(run.first[name]) for run in _runs_with(runs, name)]
        ratio = _median([a / b for a, b in zip(measured, inertial, strict=True) if b > 0.0])
        if math.isfinite(ratio) and not _PLAUSIBLE[0] < ratio < _PLAUSIBLE[1]:
            units.add(name)
            yield _units(
                name, f"{ratio:.2g} times the force of the model's inertia", _likely_unit(ratio)
            )
    pairs = [run for run in runs if set(FORCES) <= set(run.first)]
    sizes = [tuple(abs(run.first[name]) for name in FORCES) for run in pairs]
    ratio = _usual_ratio([aft / fore for aft, fore in sizes if fore > 0.0])
    unit = mistaken(ratio, FORCE_AFT.unit, _NEAR)
    if unit and not units:
        ratio_words = f"{ratio:.3g} times {FORCES[1]} in all runs, on one rigid model"
        yield _units(FORCES[0], ratio_words, f"{unit}, or the reverse in {FORCES[1]}")


def _inertia_n(set_point: SetPoint, body: Body | None, half_spacing_m: float | None) -> float:
    """Return the amplitude of force on one strut that the body's inertia alone takes."""
    if body is None:
        return 0.0
    translation = abs(math.cos(0.5 * set_point.strut_phase_rad))
    rotation = abs(math.sin(0.5 * set_point.strut_phase_rad))
    turning = body.inertia_kg_m2 / half_spacing_m**2 if half_spacing_m else body.mass_kg / 4.0
    effective_kg = 0.5 * math.hypot(body.mass_kg * translation, turning * rotation)
    return effective_kg * (2.0 * math.pi * set_point.frequency_hz) ** 2 * set_point.eccentricity_m


def _likely_unit(ratio: float) -> str:
    for factor, words in mistaken_units(FORCE_AFT.unit).items():
        if _TYPICAL[0] < ratio / factor < _TYPICAL[1]:
            return words
    return "no unit that is known"


def _of_phase_unit(runs: Sequence[RunHarmonics]) -> Iterator[Flag]:
    turned = [run for run in runs if abs(run.set_point.strut_phase_rad) > 2.0 * math.pi + 1e-9]
    if turned:
        phase_rad = turned[0].set_point.strut_phase_rad
        message = (
            f"units look wrong: run {turned[0].run} is told a strut phase of {phase_rad:g} rad, "
            "more than a turn; if it is in degrees, write strut_phase_deg"
        )
        yield Flag("units_implausible", Severity.WARNING, message)


def _of_strut_signs(runs: Sequence[RunHarmonics]) -> Iterator[Flag]:
    """Aft and fore displacement against the strut phase that was set."""
    aft, fore = DISPLACEMENTS
    pairs = [run for run in runs if {aft, fore} <= set(run.first)]
    turns = [
        _angle(run.first[fore], run.first[aft] * _unit_phasor(run.set_point.strut_phase_rad))
        for run in pairs
    ]
    if _in_most([abs(turn) > _OPPOSITE_RAD for turn in turns]):
        yield _opposite(fore, f"it moves against {aft} turned by the set-points' strut phase")


def _of_gauges(
    runs: Sequence[RunHarmonics], body: Body | None, half_spacing_m: float, plane: Plane
) -> Iterator[Flag]:
    """Signs and places of the gauges with which the model resists being set in motion."""
    wiring = likely_wiring(runs, body, half_spacing_m, plane)
    reason = "as it is, the model would hardly resist being set in motion, or would help it"
    for name in wiring.turned:
        yield _opposite(name, reason)
    if wiring.exchanged:
        aft, fore = FORCES
        message = (
            f"{aft} and {fore} seem exchanged: {reason}; exchange their columns in "
            "[columns.channels], or the displacements', on a rig the cables"
        )
        yield Flag("gauges_exchanged", Severity.WARNING, message)


def _unit_phasor(phase_rad: float) -> complex:
    return complex(math.cos(phase_rad), math.sin(phase_rad))


def _angle(phasor: complex, reference: complex) -> float:
    return float(np.angle(phasor * reference.conjugate()))


def _runs_with(runs: Sequence[RunHarmonics], name: str) -> list[RunHarmonics]:
    return [run for run in runs if name in run.first]


def _in_most(verdicts: Sequence[bool]) -> bool:
    return len(verdicts) >= _FEW and sum(verdicts) >= _MOST * len(verdicts)


def _median(values: Sequence[float]) -> float:
    return float(np.median(values)) if values else math.nan


def _usual_ratio(ratios: Sequence[float]) -> float:
    """Return the middle of ratios that are alike in all runs; NaN where they are not."""
    positive = [ratio for ratio in ratios if ratio > 0.0 and math.isfinite(ratio)]
    if len(positive) < _FEW or float(np.ptp(np.log(positive))) > _STEADY:
        return math.nan
    return _median(positive)


def _units(channel: str, apparent: str, meant: str) -> Flag:
    message = f"units look wrong: its first harmonic is {apparent}: {meant}? Then {_UNIT}"
    return Flag("units_implausible", Severity.WARNING, message, channel)


def _opposite(channel: str, reason: str) -> Flag:
    message = f"its sign is opposite to expectation: {reason}; {_SIGN}"
    return Flag("sign_opposite", Severity.WARNING, message, channel)
