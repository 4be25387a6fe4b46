"""The loads of a run in still air taken off those of the same motion in water."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

import numpy as np

from analysis.coefficients.alike import SAME_ANGLE_RAD, SAME_FREQUENCY
from analysis.coefficients.body_axes import GAUGES, SURGE_GAUGE
from analysis.coefficients.body_cycle import DRY_TAKEN_OFF, SURGE_FORCE, BodyCycle, at_order
from analysis.coefficients.phasors import real_form
from analysis.kinematics.body_frame import LOADS
from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.errors import ConfigurationError
from hardware.description.flags import Flag, Severity
from hardware.description.oscillator import Plane
from hardware.description.setpoint import Medium

_SAME_MOTION: Final = 1e-2
_SAME_SIZE: Final = 0.1


def without_dry(wet: BodyCycle, dry: BodyCycle) -> BodyCycle:
    """Return a cycle less the loads of a run in still air with the same motion.

    They are scaled by the ratio of the motions, to the power of each harmonic, and by the square of
    that of the frequencies; each harmonic is turned by its own multiple of the angle between the
    two. Means, in which the model's centripetal loads are, are taken off where both runs had zeros
    taken off; in the vertical plane that of X alone, as the weight's is in the others. What is not
    known of the gauges acts on the difference.

    Raises
    ------
    ConfigurationError
        If the dry run is not one: in water, another frequency or motion, another drift or heel; or
        at a trim, where the model's weight swings in the loads and no water bears it.
    """
    _check(wet, dry)
    ratio = _ratio(wet, dry)
    known = wet.mean_known and dry.mean_known
    factors = {
        n: (wet.frequency_hz / dry.frequency_hz) ** 2
        * abs(ratio) ** (n or 2)  # a mean goes with the square of the motion
        * np.exp(1j * n * np.angle(ratio))
        for n in range(0 if known else 1, min(wet.orders, dry.orders) + 1)
    }  # fmt: skip
    scale = _scale(wet, dry, factors)
    taken = dry.phasors.mapped(scale, wet.phasors.names, wet.phasors.units)
    flag = Flag(DRY_TAKEN_OFF, Severity.NOTE, f"the loads of dry run {dry.name} were taken off")
    return replace(
        wet,
        phasors=wet.phasors.minus(taken),
        readings=_readings(wet, dry, factors),
        sensitivity=_sensitivity(wet, dry, scale),
        flags=(*wet.flags, flag),
    )


def _has_all(order: int, wet: BodyCycle) -> bool:
    """Whether all loads are taken off at an order; of the vertical means it is that of X alone."""
    return order > 0 or wet.plane is Plane.HORIZONTAL


def _scale(wet: BodyCycle, dry: BodyCycle, factors: dict[int, complex]) -> ComplexArray:
    scale = np.zeros((len(wet.phasors.names), len(dry.phasors.names)), dtype=np.complex128)
    both = [name for name in LOADS if name in wet.channels and name in dry.channels]
    for n, factor in factors.items():
        for name in both if _has_all(n, wet) else {SURGE_FORCE} & {*both}:
            place = wet.phasors.index(at_order(name, n))
            scale[place, dry.phasors.index(at_order(name, n))] = factor
    return scale


def _readings(wet: BodyCycle, dry: BodyCycle, factors: dict[int, complex]) -> ComplexArray:
    """Return what the gauges read, less the dry run's; displacements stay."""
    readings = wet.readings.copy()
    for n, factor in factors.items() if len(readings) and len(dry.readings) else ():
        gauges = slice(GAUGES if _has_all(n, wet) else SURGE_GAUGE, dry.readings.shape[1])
        readings[n, gauges] -= factor * dry.readings[n, gauges]
    return readings


def _sensitivity(wet: BodyCycle, dry: BodyCycle, scale: ComplexArray) -> FloatArray:
    if not len(wet.sensitivity) or not len(dry.sensitivity):
        return wet.sensitivity
    return np.asarray(wet.sensitivity - real_form(scale) @ dry.sensitivity)


def _ratio(wet: BodyCycle, dry: BodyCycle) -> complex:
    """Return by how much the wet run moved more.

    Raises
    ------
    ConfigurationError
        If the two motions are not alike.
    """
    wet_motion, motion = wet.at_struts, dry.at_struts
    ratio = complex(np.vdot(motion, wet_motion) / np.vdot(motion, motion))
    deviation = np.abs(wet_motion - ratio * motion).max() / np.abs(wet_motion).max()
    if deviation > _SAME_MOTION or abs(abs(ratio) - 1.0) > _SAME_SIZE:
        raise ConfigurationError(
            f"{wet.name}: dry run {dry.name} moved {abs(ratio):.3g} times as far with "
            f"{100 * deviation:.2g} % in another motion (limits {1.0 - _SAME_SIZE:g} to "
            f"{1.0 + _SAME_SIZE:g} and {100 * _SAME_MOTION:g} %); run it with the same set-point"
        )
    return ratio


def _check(wet: BodyCycle, dry: BodyCycle) -> None:
    faults = (*_other_runs(wet, dry), *_other_angles(wet, dry))
    if faults:
        raise ConfigurationError(
            f"{wet.name}: {dry.name} cannot be its dry run: {'; '.join(faults)}"
        )


def _other_runs(wet: BodyCycle, dry: BodyCycle) -> Iterator[str]:
    if dry.medium is not Medium.AIR:
        yield "it was run in water"
    if wet.body is not None or dry.body is not None:
        yield "the body's inertia is taken off as well"
    if dry.plane is not wet.plane:
        yield "its plane is another"
    if abs(dry.frequency_hz / wet.frequency_hz - 1.0) > SAME_FREQUENCY:
        yield f"it ran at {dry.frequency_hz:g} Hz, not {wet.frequency_hz:g} Hz"


def _other_angles(wet: BodyCycle, dry: BodyCycle) -> Iterator[str]:
    angles = {
        "drift": (wet.drift_rad, dry.drift_rad),
        "heel": (wet.heel_rad, dry.heel_rad),
    }
    for word, (own, other) in angles.items():
        if abs(own - other) > SAME_ANGLE_RAD:
            yield f"its {word} is {other:g} rad, not {own:g} rad"
    if wet.plane is Plane.VERTICAL and abs(wet.drift_rad) > SAME_ANGLE_RAD:
        yield (
            "at a trim the model's weight swings in its loads, which the water bears of one that "
            "floats; give the inertia ([model])"
        )
