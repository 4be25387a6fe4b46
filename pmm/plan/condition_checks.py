"""The condition of each run by the numbers that ITTC 7.5-02-06-02 asks to be stated.

Angles and rates are those of the exact motion, not of small angles. A number is noted; beyond a
limit that the tank itself sets it refuses the plan or warns.
"""

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from analysis.kinematics.geometry import Geometry
from analysis.kinematics.motion import Driven, Motion, motion
from hardware.description.oscillator import Plane
from hardware.description.units import STANDARD_GRAVITY_M_S2
from pmm.plan.findings import Finding, Verdict
from pmm.plan.motion_peaks import omega_of
from pmm.plan.rig_file import RigFile
from pmm.plan.run_plan import RunPlan

_INSTANTS = 720
_NOTHING = 1e-9
_ASKED = "ITTC 7.5-02-06-02 asks for it"


class _Condition(NamedTuple):
    """One number of a run, its limit (NaN without any), what lies beyond it, and why."""

    quantity: str
    value: float
    reason: str
    limit: float = math.nan
    beyond: Verdict = Verdict.NOTE


def condition_findings(run: RunPlan, rig: RigFile) -> Iterator[Finding]:
    """Yield the numbers of a run in water that are not nothing."""
    if run.kind.in_air or not (run.oscillates or run.set_point.carriage_speed_m_s):
        return
    for one in (*_of_motion(run, rig), *_of_tank(run, rig)):
        if abs(one.value) < _NOTHING:
            continue
        limited = f" (limit {one.limit:.4g})" if math.isfinite(one.limit) else ""
        text = f"{one.quantity} = {one.value:.4g}{limited}: {one.reason}"
        if one.value >= one.limit:
            yield Finding(one.beyond, one.quantity, one.value, one.limit, run.name, text)
        else:  # nothing is exceeded: the largest number is the worst one
            yield Finding(Verdict.NOTE, one.quantity, one.value, math.nan, run.name, text)


def motion_of(run: RunPlan, rig: RigFile) -> Motion:
    """Return a run's exact motion over one turn of the shaft, struts moving as sines."""
    point, omega = run.set_point, omega_of(run)
    angle = np.linspace(0.0, 2.0 * math.pi, _INSTANTS, endpoint=False)
    struts = np.stack((angle, angle + point.strut_phase_rad))
    wave, slope = point.eccentricity_m * np.sin(struts), point.eccentricity_m * np.cos(struts)
    driven = Driven(wave, omega * slope, -(omega**2) * wave)
    oscillator = rig.oscillator
    geometry = Geometry(
        oscillator.plane,
        oscillator.half_spacing_m,
        speed_m_s=point.carriage_speed_m_s,
        drift_rad=run.drift_rad,
    )
    return motion(geometry, driven)


def _of_motion(run: RunPlan, rig: RigFile) -> Iterator[_Condition]:
    made, speed = motion_of(run, rig), run.set_point.carriage_speed_m_s
    turned = "yaw" if rig.oscillator.plane is Plane.HORIZONTAL else "pitch"
    if run.oscillates:
        largest = math.degrees(float(np.abs(made.rotation_rad).max()))
        yield _Condition(f"largest {turned} [deg]", largest, f"{_ASKED}; drift is part of it")
    if not speed:
        return
    ahead, across, turning = made.velocity
    beta = math.degrees(float(np.abs(np.arctan2(across, ahead)).max()))
    yield _Condition("largest angle to the flow [deg]", beta, f"{_ASKED} (drift angle beta)")
    length = None if rig.model is None else rig.model.length_m
    if length is None:
        return
    rate = float(np.abs(turning).max()) * length / speed
    letter = "r" if turned == "yaw" else "q"
    yield _Condition(f"{letter}' = {letter} L / U", rate, f"{_ASKED}; it spans the ship's turns")
    gravity = STANDARD_GRAVITY_M_S2 if rig.tank is None else rig.tank.gravity_m_s2
    slow = omega_of(run) * math.sqrt(length / gravity)
    yield _Condition("w sqrt(L / g)", slow, f"{_ASKED}; the smaller, the less waves it makes")


def _of_tank(run: RunPlan, rig: RigFile) -> Iterator[_Condition]:
    tank, speed = rig.tank, run.set_point.carriage_speed_m_s
    if tank is None:
        return
    if tank.depth_m is not None:
        froude = speed / math.sqrt(tank.gravity_m_s2 * tank.depth_m)
        reason = "at 1 a wave travels with the model: tow slower"
        yield _Condition("depth Froude number", froude, reason, 1.0, Verdict.WARN)
    length = None if rig.model is None else rig.model.length_m
    if length is None or rig.oscillator.plane is not Plane.HORIZONTAL:
        return
    made = motion_of(run, rig)
    swung = np.abs(made.across_m) + length / 2.0 * np.abs(np.sin(made.rotation_rad))
    reason = "half the tank's width is the wall; the model's beam comes on top"
    half = tank.width_m / 2.0
    yield _Condition("reach to the side [m]", float(swung.max()), reason, half, Verdict.REFUSE)
