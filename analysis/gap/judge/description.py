"""What a remainder looks like, for people: no cause, only its form.

The part of the measured forces that is not explained is put together again as a force over the
period of each run, and held against the strut's displacement, velocity and acceleration: which of
them it follows, how it grows with frequency and amplitude, whether it is there in air, and which
few terms of a library carry it (:mod:`analysis.gap.judge.sparse_law`).
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from analysis.gap.forward.problem import Problem
from analysis.gap.judge.sparse_law import FORM, Law, sparse_law
from analysis.gap.observe.components import Part, Stack
from analysis.gap.search.polynomial import motion, scaled_motion
from hardware.description.arrays import BoolArray, FloatArray
from hardware.description.channels import FORCES
from hardware.description.setpoint import Medium, SetPoint

_BINS: Final = 12
_CLEAR: Final = 2.0  # sigma, root mean square, below which there is nothing to describe


@dataclass(frozen=True, eq=False)
class ForceMap:
    """The remainder over displacement and velocity, with no form assumed.

    Attributes
    ----------
    displacement, velocity
        Middles of the cells, over the largest of the campaign, shape ``(cells,)`` each.
    force_n
        Mean force there, shape ``(velocity, displacement)``; NaN where no run came.
    """

    channel: str
    displacement: FloatArray
    velocity: FloatArray
    force_n: FloatArray


@dataclass(frozen=True)
class Description:
    """The form of a remainder.

    Attributes
    ----------
    follows
        For each of displacement, velocity and acceleration the share of the force's square that a
        single-valued curve over it carries.
    orders
        Share of each harmonic order, the mean as 0.
    frequency_power, amplitude_power
        Exponents of the remainder's size; NaN where the campaign does not vary it.
    air_over_water
        Its size in air over that in water at the same settings; NaN without both.
    """

    follows: Mapping[str, float]
    orders: Mapping[int, float]
    frequency_power: float
    amplitude_power: float
    air_over_water: float
    law: Law
    maps: tuple[ForceMap, ...]


def describe(problem: Problem, residual: FloatArray) -> Description | None:
    """Describe a remainder; ``None`` where it is within what the uncertainty lets expect.

    Parameters
    ----------
    residual
        What is not explained, in sigma, shape ``(observations,)``; the free coefficients have not
        been taken out yet.
    """
    # What changes smoothly over the runs would take a part of any law.
    settings = problem.nuisances.settings
    remainder = residual - settings.columns @ settings.fitted(residual)
    stack = problem.simulator.stack
    rows = np.array(
        [
            component.channel in FORCES
            and component.order <= _highest(stack)
            and component.part in FORM
            for component in stack.components
        ]
    )
    if not rows.any() or math.sqrt(float(np.mean(remainder[rows] ** 2))) < _CLEAR:
        return None
    channels = [
        name for name in FORCES if name in {component.channel for component in stack.components}
    ]
    shown = _visible_remainder(stack, remainder, rows)
    sizes = np.array([_size(stack, shown, run) for run in range(len(stack.runs))])
    return Description(
        _dependence(stack, remainder, channels),
        _orders(stack, remainder, rows),
        _power(stack, sizes, frequency=True),
        _power(stack, sizes, frequency=False),
        _medium(stack, sizes),
        sparse_law(problem, residual),
        tuple(_map(stack, remainder, channel) for channel in channels),
    )


def _highest(stack: Stack) -> int:
    return max(component.order for component in stack.components if component.part in FORM)


def _orders(stack: Stack, remainder: FloatArray, rows: BoolArray) -> dict[int, float]:
    total = float(np.sum(remainder[rows] ** 2))
    order = np.array([component.order for component in stack.components])
    return {
        int(n): float(np.sum(remainder[rows & (order == n)] ** 2)) / total
        for n in np.unique(order[rows])
    }


def _visible_remainder(stack: Stack, remainder: FloatArray, rows: BoolArray) -> FloatArray:
    """Return the remainder without first harmonics, if the others show it.

    The free coefficients take their part of the first harmonics, and leave another dependence on
    frequency, amplitude and medium than what is there has.
    """
    higher = rows & np.array([component.order != 1 for component in stack.components])
    clear = higher.any() and math.sqrt(float(np.mean(remainder[higher] ** 2))) > _CLEAR
    return np.where(higher, remainder, 0.0) if clear else remainder


def force_over_period(stack: Stack, remainder: FloatArray, run: int, channel: str) -> FloatArray:
    """Return the remainder of a run as a force over its period, in N, shape ``(points,)``."""
    count = len(motion(stack.runs[run], channel)[0])
    spectrum = np.zeros(count // 2 + 1, dtype=np.complex128)
    for at in np.flatnonzero(stack.run == run):
        component, value = stack.components[at], float(remainder[at] * stack.uncertainty[at])
        if component.channel != channel or component.part not in FORM:
            continue
        if component.part is Part.MEAN:
            spectrum[0] += value
        else:
            spectrum[component.order] += (
                0.5 * value * (1.0 if component.part is Part.QUADRATURE else -1j)
            )
    return np.fft.irfft(spectrum, count) * count


def _size(stack: Stack, remainder: FloatArray, run: int) -> float:
    forces = [force_over_period(stack, remainder, run, channel) for channel in FORCES]
    return math.sqrt(sum(float(np.mean(force**2)) for force in forces))


def _power(stack: Stack, sizes: FloatArray, *, frequency: bool) -> float:
    """Return the exponent of the size over groups of runs that are alike in all else."""
    groups: dict[tuple[float, ...], list[tuple[float, float]]] = {}
    for run, size in zip(stack.runs, sizes, strict=True):
        if not run.turns:
            continue
        at = run.set_point
        pair = (at.frequency_hz, at.eccentricity_m)
        varied, fixed = pair if frequency else pair[::-1]
        air = float(at.medium is Medium.AIR)
        key = (fixed, at.strut_phase_rad, at.carriage_speed_m_s, air, at.drift_rad)
        groups.setdefault(key, []).append((math.log(varied), math.log(max(size, 1e-12))))
    square = product = 0.0
    for pairs in groups.values():
        x, y = np.array(pairs).T
        square += float(np.sum((x - x.mean()) ** 2))
        product += float(np.sum((x - x.mean()) * (y - y.mean())))
    return product / square if square > 1e-9 else math.nan


def _medium(stack: Stack, sizes: FloatArray) -> float:
    air = np.array([run.set_point.medium is Medium.AIR for run in stack.runs])
    if air.all() or not air.any():
        return math.nan
    pairs = []
    for at in np.flatnonzero(air):
        point = stack.runs[at].set_point
        alike = [n for n in np.flatnonzero(~air) if _same_motion(stack, int(n), point)]
        pairs += [math.log(max(sizes[at], 1e-12) / max(sizes[n], 1e-12)) for n in alike]
    return math.exp(float(np.mean(pairs))) if pairs else math.nan


def _same_motion(stack: Stack, run: int, set_point: SetPoint) -> bool:
    at = stack.runs[run].set_point
    keys = ("frequency_hz", "eccentricity_m", "strut_phase_rad")
    return all(math.isclose(getattr(at, key), getattr(set_point, key)) for key in keys)


def _dependence(stack: Stack, remainder: FloatArray, channels: Sequence[str]) -> dict[str, float]:
    shares = {}
    for at, name in enumerate(("displacement", "velocity", "acceleration")):
        carried = total = 0.0
        for channel in channels:
            place = np.concatenate([run_motion[at] for run_motion in scaled_motion(stack, channel)])
            force = _forces(stack, remainder, channel)
            cells = np.clip(((place + 1.0) / 2.0 * _BINS).astype(int), 0, _BINS - 1)
            sums = np.bincount(cells, force, _BINS)
            counts = np.bincount(cells, minlength=_BINS)
            carried += float(np.sum(sums**2 / np.maximum(counts, 1)))
            total += float(np.sum(force**2))
        shares[name] = carried / total if total > 0.0 else 0.0
    return shares


def _forces(stack: Stack, remainder: FloatArray, channel: str) -> FloatArray:
    runs = range(len(stack.runs))
    return np.concatenate([force_over_period(stack, remainder, run, channel) for run in runs])


def _map(stack: Stack, remainder: FloatArray, channel: str) -> ForceMap:
    moved = scaled_motion(stack, channel)
    edges = np.linspace(-1.0, 1.0, _BINS + 1)
    x, v = (np.concatenate([run_motion[at] for run_motion in moved]) for at in (0, 1))
    force = _forces(stack, remainder, channel)
    bins = (edges, edges)
    sums = np.histogram2d(v, x, bins, weights=force)[0]
    counts = np.histogram2d(v, x, bins)[0]
    mean = np.where(counts > 0, sums / np.maximum(counts, 1), np.nan)
    middle = 0.5 * (edges[1:] + edges[:-1])
    return ForceMap(channel, middle, middle, mean)
