"""Repeated runs: what repeating adds to the scatter, and which runs are outliers.

Runs with the same motion are brought to one motion (loads over motion, both are measured) and their
loads compared. What they differ by beyond their own scatter is a source of its own, relative to the
load, pooled over all kinds of the campaign: it stays where no period tells of it.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from analysis.coefficients.alike import SAME_ANGLE_RAD, SAME_FREQUENCY, is_same_speed
from analysis.coefficients.body_cycle import LOADS, BodyCycle, at_order
from analysis.coefficients.campaign_records import Outlier
from analysis.coefficients.phasors import Phasors, from_interleaved, parts_of
from analysis.uncertainty.freedom import effective_freedom, student_factor
from analysis.uncertainty.values import Contribution, UncertainValues
from hardware.description.arrays import ComplexArray, FloatArray

_SAME_MOTION = 2e-2
_CHANCE = 0.01  # that any run of a good campaign is named


@dataclass(frozen=True, eq=False)
class RepeatedMotion:
    """Repeats of one motion.

    Attributes
    ----------
    loads
        Of each run for the first one's motion, shape ``(runs, 2)``.
    variance
        Of each part (in phase, quadrature) by the runs' own scatter, shape ``(runs, 2)``.
    size
        Largest part of each load, that errors of the run are relative to, shape ``(2,)``.
    freedom
        Effective, of the runs' mean variance of each load, shape ``(2,)``.
    """

    runs: tuple[str, ...]
    loads: ComplexArray
    variance: FloatArray
    size: FloatArray
    freedom: FloatArray


@dataclass(frozen=True, eq=False)
class Repeatability:
    """Scatter between repeated runs, beyond the scatter within them.

    Attributes
    ----------
    relative
        Standard deviation between runs beyond their scatter, over the load's size, ``(2,)``.
    degrees_of_freedom
        Repeats less kinds; 0 without any repeat.
    """

    relative: FloatArray
    degrees_of_freedom: float
    kinds: tuple[RepeatedMotion, ...]


def repeatability(cycles: Sequence[BodyCycle]) -> Repeatability:
    """Return the scatter of force and moment between repeated runs, beyond that within them."""
    kinds = tuple(_kind(group) for group in _groups(cycles) if len(group) > 1)
    freedom = sum(len(kind.runs) - 1 for kind in kinds)
    if not freedom:
        return Repeatability(np.zeros(2), 0.0, kinds)
    between = sum(_squares(kind.loads) / kind.size**2 for kind in kinds) / (2.0 * freedom)
    weights = [len(kind.runs) - 1 for kind in kinds]
    within = sum(
        w * kind.variance.mean(axis=0) / kind.size**2
        for w, kind in zip(weights, kinds, strict=True)
    )
    excess = np.maximum(np.asarray(between) - np.asarray(within) / freedom, 0.0)
    return Repeatability(np.sqrt(excess), float(freedom), kinds)


def with_repeats(cycle: BodyCycle, repeating: Repeatability) -> BodyCycle:
    """Return the cycle with the scatter between repeats as one more source of uncertainty."""
    if not (repeating.relative > 0.0).any():
        return cycle
    places = [cycle.phasors.index(at_order(name, 1)) for name in LOADS]
    spread = np.repeat(repeating.relative * _size(cycle), 2)
    rows = np.array(parts_of(places))
    label = f"repeats: {cycle.name}"
    source = Contribution(label, repeating.degrees_of_freedom, rows, np.diag(spread))
    real = cycle.phasors.real
    wider = replace(real, contributions=(*real.contributions, source))
    return replace(cycle, phasors=replace(cycle.phasors, real=wider))


def outliers(repeating: Repeatability) -> tuple[Outlier, ...]:
    """Return the runs that differ from three or more others of the same motion.

    Each is held against the others' mean; the scale is the larger of the runs' own scatter and of
    the scatter between all other repeats. The limit is Student's, so wide that a good campaign
    names any run once in a hundred.
    """
    tests = 4 * sum(len(kind.runs) for kind in repeating.kinds if len(kind.runs) > 2)
    named = []
    for kind in repeating.kinds:
        for k in range(len(kind.runs) if len(kind.runs) > 2 else 0):
            for row, load in enumerate(LOADS):
                ratio, freedom = _distance(repeating.kinds, kind, k, row)
                limit = _limit(freedom, tests)
                if ratio > limit:
                    named.append(_outlier(kind, k, load, ratio, limit))
    return tuple(named)


def _outlier(kind: RepeatedMotion, k: int, load: str, ratio: float, limit: float) -> Outlier:
    partners = tuple(run for run in kind.runs if run != kind.runs[k])
    message = (
        f"{kind.runs[k]}: its {load} stands {ratio:.3g} standard uncertainties from the mean of "
        f"{', '.join(partners)} (limit {limit:.3g}); look at its record, and leave it out if there "
        "is a reason"
    )
    return Outlier(kind.runs[k], partners, load, ratio, limit, message)


def _distance(
    kinds: Sequence[RepeatedMotion], kind: RepeatedMotion, k: int, row: int
) -> tuple[float, float]:
    """Distance of one run from the others' mean over its scale, and that scale's freedom."""
    partner_loads = np.delete(kind.loads[:, row], k)
    deviation = kind.loads[k, row] - partner_loads.mean()
    squares, freedom = 0.0, 0.0
    for kind_of_motion in kinds:
        loads = (
            np.delete(kind_of_motion.loads, k, axis=0)
            if kind_of_motion is kind
            else kind_of_motion.loads
        )
        squares += float(_squares(loads)[row]) * (kind.size[row] / kind_of_motion.size[row]) ** 2
        freedom += 2.0 * (len(loads) - 1)
    between = squares / freedom
    within = float(kind.variance[:, row].mean())
    widest = max(between, within)
    scale = math.sqrt(widest * (1.0 + 1.0 / len(partner_loads))) + 1e-12 * float(kind.size[row])
    largest = max(abs(deviation.real), abs(deviation.imag))
    return largest / scale, freedom if between >= within else float(kind.freedom[row])


def _limit(freedom: float, tests: int) -> float:
    return float(student_factor(freedom, 1.0 - _CHANCE / tests))


def _groups(cycles: Sequence[BodyCycle]) -> list[list[BodyCycle]]:
    groups: list[list[BodyCycle]] = []
    for cycle in (cycle for cycle in cycles if cycle.frequency_hz > 0.0):
        for group in groups:
            if _is_same_motion(group[0], cycle):
                group.append(cycle)
                break
        else:
            groups.append([cycle])
    return groups


def _ratio(first: BodyCycle, second: BodyCycle) -> complex:
    first_motion, second_motion = first.at_struts, second.at_struts
    return complex(np.vdot(first_motion, second_motion) / np.vdot(first_motion, first_motion))


def _is_same_motion(first: BodyCycle, second: BodyCycle) -> bool:
    if abs(second.frequency_hz - first.frequency_hz) > SAME_FREQUENCY * first.frequency_hz:
        return False
    if not is_same_speed(first.speed_m_s, second.speed_m_s):
        return False
    for angle in ("drift_rad", "heel_rad", "rudder_rad"):
        if abs(getattr(second, angle) - getattr(first, angle)) > SAME_ANGLE_RAD:
            return False
    ratio = _ratio(first, second)
    deviation = np.abs(second.at_struts - ratio * first.at_struts).max()
    same_size = abs(abs(ratio) - 1.0) < _SAME_MOTION
    return bool(same_size and deviation < _SAME_MOTION * np.abs(first.at_struts).max())


def _size(cycle: BodyCycle) -> FloatArray:
    """Largest part of each load at the fundamental: measured, or what is taken off."""
    return np.asarray(np.maximum(np.abs(cycle.loads), cycle.load_magnitudes.max(axis=0)) + 1e-300)


def _kind(cycles: Sequence[BodyCycle]) -> RepeatedMotion:
    # Of the water: a body that was taken off makes no run another one.
    of_water = [_loads(cycle.hull.phasors) for cycle in cycles]
    loads = np.stack(
        [
            from_interleaved(own.values) / _ratio(cycles[0], cycle)
            for own, cycle in zip(of_water, cycles, strict=True)
        ]
    )
    loads_of_cycles = [_loads(cycle.phasors) for cycle in cycles]
    variance = np.maximum(_variance(loads_of_cycles), _variance(of_water))
    freedoms = np.stack(
        [
            cycle_loads.degrees_of_freedom.reshape(2, 2).min(axis=1)
            for cycle_loads in loads_of_cycles
        ]
    )
    freedom = effective_freedom(variance, freedoms)
    names = tuple(cycle.name for cycle in cycles)
    return RepeatedMotion(names, loads, variance, _size(cycles[0]), freedom)


def _loads(phasors: Phasors) -> UncertainValues:
    """Return both loads at the fundamental."""
    return phasors.select([at_order(name, 1) for name in LOADS]).real


def _variance(loads: Sequence[UncertainValues]) -> FloatArray:
    """Of both loads of each run, the mean of their two parts, shape ``(runs, 2)``."""
    parts = np.stack([run_loads.standard_uncertainty**2 for run_loads in loads])
    return np.asarray(parts.reshape(-1, 2, 2).mean(axis=2))


def _squares(loads: ComplexArray) -> FloatArray:
    return np.asarray((np.abs(loads - loads.mean(axis=0)) ** 2).sum(axis=0))
