"""Amplitude, phase and period along a record: what successive parts of it show of one oscillation.

Each part is fitted by itself, with the phase at its middle. The whole cycles between two middles
follow from the parts' periods, so that the phases count through from the first part to the last.
Where they cannot be told, as after a long gap, a new stretch begins, with a phase of its own.
"""

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from analysis.inertia.damped_fit import DampedFit, fit_damped
from hardware.description.arrays import FloatArray, IntArray
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity

FEWEST_PARTS = 4
MOST_PARTS = 16
FEWEST_SWINGS = 1.5  # in a part
STRAYED = 0.1  # relative difference from the whole record's period: another oscillation
SURE = 4.0  # standard uncertainties that a count of cycles stays clear of half a cycle more


@dataclass(frozen=True)
class LocalPeriods:
    """One oscillation in successive parts of a record.

    Attributes
    ----------
    time_s, amplitude
        Middle of each part and the amplitude there, shape ``(parts,)``.
    phase_rad, period_s
        Phase at the middle, counted through within a stretch, and period, shape ``(parts,)``.
    covariance
        Of (phase, 2 pi/period) by each part's own fit, in rad and rad/s, shape ``(parts, 2, 2)``.
    stretch
        Number of the stretch that each part belongs to, from 0, shape ``(parts,)``.
    flags
        ``cycles_not_counted`` for each stretch after the first.
    """

    time_s: FloatArray
    amplitude: FloatArray
    phase_rad: FloatArray
    period_s: FloatArray
    covariance: FloatArray
    stretch: IntArray
    flags: tuple[Flag, ...] = ()

    @property
    def omega_rad_s(self) -> FloatArray:
        """Angular frequency of each part, shape ``(parts,)``."""
        return np.asarray(2.0 * np.pi / self.period_s)

    @property
    def uncertainty_s(self) -> FloatArray:
        """Standard uncertainty of each part's period by its own fit, shape ``(parts,)``."""
        return np.asarray(np.sqrt(self.covariance[:, 1, 1]) * self.period_s / self.omega_rad_s)


@dataclass(frozen=True)
class _Part:
    time_s: float
    amplitude: float
    phase_rad: float  # from -pi to pi
    period_s: float
    covariance: FloatArray


def local_periods(
    time_s: FloatArray,
    values: FloatArray,
    fit: DampedFit,
    *,
    mode: int = 0,
    parts: int | None = None,
    where: str = "record",
) -> LocalPeriods:
    """Cut a record into parts and fit each; parts that show another oscillation are left out.

    Parameters
    ----------
    fit
        The whole record's fit; its other modes are taken off first.
    parts
        How many; by default as many as leave three periods in each, 4 to 16.

    Raises
    ------
    DataError
        If the record has not six periods (too few swings), or under four parts are left.
    """
    period = fit.modes[mode].period_s
    swings = (time_s[-1] - time_s[0]) / period
    count = parts or int(np.clip(swings // 3, FEWEST_PARTS, MOST_PARTS))
    if swings / count < FEWEST_SWINGS:
        raise DataError(
            f"{where}: too few swings: {swings:.3g} of {period:.3g} s are usable, at "
            f"least {FEWEST_SWINGS * count:g} are needed to see how the period changes with the "
            "amplitude; record longer or release from further out"
        )
    rest = values - _other_modes(fit, mode, time_s)
    edges = np.linspace(time_s[0], time_s[-1], count + 1)
    fitted = [_part(time_s, rest, low, high, period) for low, high in pairwise(edges)]
    periods = [part for part in fitted if part is not None]
    if len(periods) < FEWEST_PARTS:
        raise DataError(
            f"{where}: {len(periods)} of {count} parts show the oscillation of {period:.4g} "
            f"s; at least {FEWEST_PARTS} are needed: a record with fewer gaps, or less of other "
            "motions"
        )
    return _counted_through(periods, where)


def _other_modes(fit: DampedFit, mode: int, time_s: FloatArray) -> FloatArray:
    total = np.zeros(time_s.shape)
    t = time_s - fit.start_s
    for k, neighbour in enumerate(fit.modes):
        if k != mode:
            angle = 2.0 * np.pi * t / neighbour.period_s + neighbour.phase_rad
            total += neighbour.amplitude * np.exp(-neighbour.decay_1_s * t) * np.cos(angle)
    return total


def _part(
    time_s: FloatArray, values: FloatArray, low: float, high: float, period_s: float
) -> _Part | None:
    """Fit one part; None where too much is missing or another oscillation is found."""
    inside = (time_s >= low) & (time_s <= high)
    if np.isfinite(values[inside]).mean() < 0.5:
        return None
    part_fit = fit_damped(time_s[inside], values[inside], start_periods_s=(period_s,))
    mode = part_fit.modes[0]
    if not part_fit.converged or abs(mode.period_s / period_s - 1.0) > STRAYED:
        return None
    middle = 0.5 * (low + high)
    t, omega = middle - part_fit.start_s, 2.0 * math.pi / mode.period_s
    # derivative of (phase at the middle, omega) by (period, phase at the start)
    turn = np.array([[-omega * t / mode.period_s, 1.0], [-omega / mode.period_s, 0.0]])
    covariance = turn @ part_fit.covariance[np.ix_([0, 3], [0, 3])] @ turn.T
    return _Part(
        middle,
        mode.amplitude * math.exp(-mode.decay_1_s * t),
        math.remainder(mode.phase_rad + omega * t, 2.0 * math.pi),
        mode.period_s,
        covariance,
    )


def _counted_through(parts: list[_Part], where: str) -> LocalPeriods:
    """Count the cycles from part to part; begin a new stretch where the count is not sure."""
    phases, stretches, flags = [parts[0].phase_rad], [0], []
    for last, part in pairwise(parts):
        expected = phases[-1] + _advance(last, part)
        phase_error = math.remainder(part.phase_rad - expected, 2.0 * math.pi)
        sure = abs(phase_error) + _reach(last, part) < math.pi
        phases.append(expected + phase_error)
        stretches.append(stretches[-1] + (not sure))
        if not sure:
            flags.append(_not_counted(last, part, where))
    return LocalPeriods(
        time_s=np.array([part.time_s for part in parts]),
        amplitude=np.array([part.amplitude for part in parts]),
        phase_rad=np.array(phases),
        period_s=np.array([part.period_s for part in parts]),
        covariance=np.array([part.covariance for part in parts]),
        stretch=np.array(stretches),
        flags=tuple(flags),
    )


def _not_counted(last: _Part, part: _Part, where: str) -> Flag:
    message = (
        f"{where}: the cycles of {part.period_s:.4g} s between {last.time_s:.4g} and "
        f"{part.time_s:.4g} s cannot be counted (gap, noise, or a period that changes much); what "
        "lies before and after is joined by its periods only, which widens the uncertainty"
    )
    return Flag("cycles_not_counted", Severity.NOTE, message)


def _advance(last: _Part, part: _Part) -> float:
    """Return the phase from one middle to the next by the mean of both frequencies, rad."""
    return math.pi * (part.time_s - last.time_s) * (1.0 / last.period_s + 1.0 / part.period_s)


def _reach(last: _Part, part: _Part) -> float:
    """Return how far off that phase may be, rad.

    A frequency that changes in one sense lies between those of both ends; to it come four standard
    uncertainties of the phase expected less the one that is seen.
    """
    half = 0.5 * (part.time_s - last.time_s)
    between = 2.0 * math.pi * half * abs(1.0 / last.period_s - 1.0 / part.period_s)
    forward, backward = np.array([1.0, half]), np.array([1.0, -half])
    variance = forward @ last.covariance @ forward + backward @ part.covariance @ backward
    return between + SURE * math.sqrt(float(variance))
