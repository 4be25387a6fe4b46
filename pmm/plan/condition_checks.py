"""The condition of each run by the numbers that ITTC 7.5-02-06-02 asks to be stated.

Angles and rates are those of the exact motion, not of small angles. A number is noted, or judged by
the limit that :mod:`pmm.plan.check_table` has for it.
"""

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Final, NamedTuple

import numpy as np

from analysis.kinematics.geometry import Geometry
from analysis.kinematics.motion import DrivenDisplacements, MotionWaves, motion
from analysis.water import Water, froude_number, reynolds_number
from hardware.description import kinds
from hardware.description.arrays import FloatArray
from hardware.description.carriage_path import CarriagePath
from hardware.description.lines import struts_over_turn
from hardware.description.oscillator import Plane
from hardware.description.units import STANDARD_GRAVITY_M_S2
from pmm.plan import check_table as table
from pmm.plan.check import Check
from pmm.plan.echoes import echo_limit
from pmm.plan.findings import PlanFinding, PlanVerdict
from pmm.plan.motion_peaks import frequencies_hz, omega_of
from pmm.plan.rig_file import RigFile
from pmm.plan.run_plan import RunPlan

_INSTANTS = 720
_NOTHING = 1e-9
_WORDS: Final = {
    Plane.HORIZONTAL: {"rotation": "yaw", "rate": "r"},
    Plane.VERTICAL: {"rotation": "pitch", "rate": "q"},
}
_REDUCED: Final = {
    kinds.Motion.SWAY: table.REDUCED_SWAY,
    kinds.Motion.YAW: table.REDUCED_YAW,
    kinds.Motion.YAW_DRIFT: table.REDUCED_YAW,
}


class _Condition(NamedTuple):
    """One number of a run, its limit (NaN without any), and the verdict on it."""

    check: Check
    value: float
    limit: float = math.nan
    verdict: PlanVerdict = PlanVerdict.NOTE


def condition_findings(
    run: RunPlan, rig: RigFile, water: Water | None = None
) -> Iterator[PlanFinding]:
    """Yield the numbers of a run in water that are not nothing."""
    if run.kind.in_air or not (run.oscillates or run.set_point.carriage_speed_m_s):
        return
    words = _WORDS[rig.oscillator.plane]
    made = motion_of(run, rig)
    for condition in (
        *_of_motion(run, made),
        *_of_speed(run, rig, water),
        *_of_waves(run, rig, made),
        *_of_depth(run, rig),
        *_of_room(rig, made),
    ):
        if abs(condition.value) < _NOTHING:
            continue
        check, quantity = condition.check, condition.check.quantity.format(**words)
        limit = (
            f"limit {condition.limit:.4g}" if math.isfinite(condition.limit) else "no limit stated"
        )
        text = f"{quantity} = {condition.value:.4g} ({limit}, {check.source})"
        if condition.verdict is not PlanVerdict.NOTE:
            text += f": {check.reason}"
        yield PlanFinding(
            condition.verdict,
            quantity,
            condition.value,
            condition.limit,
            run.name,
            text,
            check.source,
        )


def motion_of(run: RunPlan, rig: RigFile) -> MotionWaves:
    """Return a run's exact motion over one turn of the shaft, struts moving as sines."""
    point, omega = run.set_point, omega_of(run)
    place, slope, curvature = (
        omega**times * point.eccentricity_m * struts_over_turn(point.every_line, times, _INSTANTS)
        for times in range(3)
    )
    driven = DrivenDisplacements(place, slope, curvature)
    geometry, led = Geometry.of(rig.oscillator, point), CarriagePath.of(rig.oscillator, point)
    if led is not None:
        varies = led.over_turn(instants=place.shape[-1]) - point.carriage_speed_m_s
        geometry = replace(geometry, varies_m_s=varies)
    return motion(geometry, driven)


def _of_motion(run: RunPlan, made: MotionWaves) -> Iterator[_Condition]:
    if run.oscillates:
        yield _Condition(table.ROTATION, math.degrees(float(np.abs(made.rotation_rad).max())))
    if run.set_point.carriage_speed_m_s:
        beta = np.arctan2(made.velocity[1], made.velocity[0])
        yield _Condition(table.ANGLE_TO_FLOW, math.degrees(float(np.abs(beta).max())))


def _of_speed(run: RunPlan, rig: RigFile, water: Water | None) -> Iterator[_Condition]:
    speed, model = run.set_point.carriage_speed_m_s, rig.model
    if not speed or model is None or model.length_m is None:
        return
    yield _Condition(table.FROUDE, froude_number(speed, model.length_m, _gravity(rig)))
    if water is not None:
        yield _Condition(table.REYNOLDS, reynolds_number(speed, model.length_m, water))


def _gravity(rig: RigFile) -> float:
    return STANDARD_GRAVITY_M_S2 if rig.tank is None else rig.tank.gravity_m_s2


def _of_waves(run: RunPlan, rig: RigFile, made: MotionWaves) -> Iterator[_Condition]:
    """Yield what goes with the frequency, of many lines at the one that is worst for each."""
    speed = run.set_point.carriage_speed_m_s
    if not speed:
        return
    gravity, omegas = _gravity(rig), 2.0 * math.pi * np.array(frequencies_hz(run))
    taus, highest = omegas * speed / gravity, float(omegas.max())
    yield _tau(taus, rig.oscillator.plane)
    if rig.model is None or rig.model.length_m is None:
        return
    length = rig.model.length_m
    turning = np.abs(made.velocity[2] + run.set_point.turn_rate_rad_s).max()
    yield _Condition(table.TURNING, float(turning) * length / speed)
    yield _Condition(table.WAVE_FREQUENCY, highest * math.sqrt(length / gravity))
    check = _REDUCED.get(run.motion, table.REDUCED)
    yield _below(check, highest * length / speed, check.numbers[-1] if check.numbers else math.nan)
    if rig.tank is not None and rig.oscillator.plane is Plane.VERTICAL:
        limit, tau = echo_limit(rig.tank.width_m / length), float(taus.min())
        if tau < limit:  # never below NaN: a tank broader or narrower than the ITTC's table
            yield _Condition(table.ECHO, tau, limit)


def _tau(taus: FloatArray, plane: Plane) -> _Condition:
    """Slow manoeuvring tests stay below 1/4; faster tests of seakeeping are on either side."""
    critical, clearance = table.TAU_SWAY.numbers
    if plane is Plane.HORIZONTAL:
        return _below(table.TAU_SWAY, float(taus.max()), critical - clearance)
    tau = float(taus[np.abs(taus - critical).argmin()])
    near = abs(tau - critical) < clearance
    return _Condition(
        table.TAU_HEAVE, tau, critical, PlanVerdict.WARN if near else PlanVerdict.NOTE
    )


def _of_depth(run: RunPlan, rig: RigFile) -> Iterator[_Condition]:
    tank, model, speed = rig.tank, rig.model, run.set_point.carriage_speed_m_s
    if tank is None or tank.depth_m is None:
        return
    froude = froude_number(speed, tank.depth_m, tank.gravity_m_s2)
    yield _below(table.DEPTH_FROUDE, froude, table.DEPTH_FROUDE.numbers[0])
    if model is None or model.draught_m is None:
        return
    yield _Condition(table.DEPTH, tank.depth_m / model.draught_m, table.DEPTH.numbers[0])
    if speed and model.beam_m is not None:
        blockage = model.beam_m * model.draught_m / (tank.width_m * tank.depth_m)
        yield _below(table.BLOCKAGE, blockage, table.BLOCKAGE.numbers[0])


def _of_room(rig: RigFile, made: MotionWaves) -> Iterator[_Condition]:
    tank, model = rig.tank, rig.model
    if tank is None or model is None or model.length_m is None:
        return
    ends = model.length_m / 2.0 * np.abs(np.sin(made.rotation_rad))
    if rig.oscillator.plane is Plane.HORIZONTAL:
        sides = (model.beam_m or 0.0) / 2.0 * np.cos(made.rotation_rad)
        reach = float((np.abs(made.across_m) + ends + sides).max())
        yield _below(table.REACH, reach, tank.width_m / 2.0, PlanVerdict.REFUSE)
    elif tank.depth_m is not None and model.draught_m is not None:
        reach = float((made.across_m + ends).max()) + model.draught_m
        yield _below(table.KEEL, reach, tank.depth_m, PlanVerdict.REFUSE)


def _below(
    check: Check, value: float, limit: float, beyond: PlanVerdict = PlanVerdict.WARN
) -> _Condition:
    return _Condition(check, value, limit, beyond if value >= limit else PlanVerdict.NOTE)
