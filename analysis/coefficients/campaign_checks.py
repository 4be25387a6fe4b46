"""Consistency between runs: one quantity determined in two ways, common uncertainty cancelled."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from analysis.coefficients.body_cycle import LOADS, MOTIONS, BodyCycle, at_order
from analysis.coefficients.campaign_nonlinear import SINGLE_RUN, STATIC_DRIFT
from analysis.coefficients.campaign_records import (
    HIGHER_ORDER,
    LINEAR,
    ZERO_FREQUENCY,
    CoefficientEntry,
    ConsistencyCheck,
)
from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.coefficients.zero_frequency import at_zero_frequency
from analysis.ideal_rig import mass_matrix, weight_matrix
from analysis.uncertainty.values import UncertainValues, stacked
from hardware.description.oscillator import Plane
from hardware.description.words import joined

TWO_TESTS = "two tests"
STATIC = "static drift"
SINGLE = "single and multiple runs"
RESTORING = "restoring"

_PURE = 1e-2
_NAMED = 2  # runs that a check names


def consistency(
    coefficients: CampaignCoefficients, cycles: Sequence[BodyCycle]
) -> tuple[ConsistencyCheck, ...]:
    """Return all checks that the campaign allows."""
    pairs = [*_two_tests(coefficients), *_static(coefficients), *_single_runs(coefficients)]
    value_pairs = [_pair(coefficients, *pair) for pair in pairs] + restoring_pairs(cycles)
    return consistency_checks(value_pairs, coefficients.level)


@dataclass(frozen=True, eq=False)
class Pair:
    """One quantity determined in two ways, to be compared: texts, and both values."""

    kind: str
    name: str
    unit: str
    texts: tuple[str, str]
    estimates: UncertainValues


def consistency_checks(pairs: Sequence[Pair], level: float) -> tuple[ConsistencyCheck, ...]:
    """Compare the first value of each pair with the second.

    The intervals are so wide that with the probability ``level`` no check of a good campaign fails:
    of sixty at 95 % each, three would. Values without an interval are not compared.
    """
    pairs = [pair for pair in pairs if np.isfinite(pair.estimates.standard_uncertainty).all()]
    each = 1.0 - (1.0 - level) / max(len(pairs), 1)
    return tuple(_check(pair, each) for pair in pairs)


def _two_tests(coefficients: CampaignCoefficients) -> Iterator[tuple[str, int, int]]:
    """Linear coefficients at one frequency and speed, of neighbouring amplitudes.

    Where the load was found to be curved they differ by nature: there each run is held against the
    fit of all (:func:`_single_runs`).
    """
    names = dict.fromkeys((entry.name, entry.speed_m_s) for entry in coefficients.entries)
    for name, speed in names:
        if coefficients.is_nonlinear(name, speed):
            continue
        rows = coefficients.rows(name, method=LINEAR, speed_m_s=speed)
        for first, second in pairwise(rows):
            entry, neighbour = coefficients.entries[first], coefficients.entries[second]
            if abs(entry.frequency_hz - neighbour.frequency_hz) <= 5e-3 * entry.frequency_hz:
                yield TWO_TESTS, first, second


def _static(coefficients: CampaignCoefficients) -> Iterator[tuple[str, int, int]]:
    """Static drift against zero frequency, or else against the slowest run."""
    for row in coefficients.rows(method=STATIC_DRIFT):
        entry = coefficients.entries[row]
        dynamic = [
            k
            for method in (ZERO_FREQUENCY, HIGHER_ORDER, LINEAR)
            for k in coefficients.rows(entry.name, method=method, speed_m_s=entry.speed_m_s)
        ]
        if dynamic:
            yield STATIC, row, dynamic[0]


def _single_runs(coefficients: CampaignCoefficients) -> Iterator[tuple[str, int, int]]:
    """Each run alone against all runs together."""
    by_run: dict[tuple[str, str], list[int]] = {}
    for k in coefficients.rows(method=HIGHER_ORDER):
        joint_entry = coefficients.entries[k]
        for run in joint_entry.runs if len(joint_entry.runs) > 1 else ():
            by_run.setdefault((joint_entry.name, run), []).append(k)
    for row in coefficients.rows(method=SINGLE_RUN):
        entry = coefficients.entries[row]
        for k in by_run.get((entry.name, entry.runs[0]), ()):
            yield SINGLE, row, k


def _pair(coefficients: CampaignCoefficients, kind: str, first: int, second: int) -> Pair:
    entry, second_entry = coefficients.entries[first], coefficients.entries[second]
    values = coefficients.uncertain.select([first, second])
    texts = (_entry_text(entry), _entry_text(second_entry))
    return Pair(kind, entry.name, entry.unit, texts, values)


def _check(pair: Pair, level: float) -> ConsistencyCheck:
    """Compare the first of two values with the second."""
    name, unit, texts, values = pair.name, pair.unit, pair.texts, pair.estimates
    difference = values.mapped(np.array([[1.0, -1.0]]))
    change, spread = float(difference.values[0]), float(difference.standard_uncertainty[0])
    freedom = float(difference.degrees_of_freedom[0])
    half = float(difference.half_width(level)[0])
    size = float(np.abs(values.values).max())
    agrees = abs(change) <= half + 1e-9 * size
    words = "agree" if agrees else "DIFFER by more than their interval"
    message = (
        f"{name} from {texts[0]} is {values.values[0]:.5g}, from {texts[1]} {values.values[1]:.5g} "
        f"{unit}: they {words} ({change:.3g} +- {half:.3g})"
    )
    return ConsistencyCheck(
        pair.kind,
        name,
        unit,
        *texts,
        float(values.values[0]),
        float(values.values[1]),
        change,
        spread,
        freedom,
        agrees,
        message,
    )


def _entry_text(entry: CoefficientEntry) -> str:
    return f"{entry.method} at {entry.frequency_hz:.4g} Hz ({joined(entry.runs, _NAMED)})"


def restoring_pairs(cycles: Sequence[BodyCycle]) -> list[Pair]:
    """Return the measured restoring beside the hydrostatic one, from pure motions at rest.

    The load over the motion is ``C + G - omega^2 (M + A) + i omega B``; the model's part is taken
    off, and of what is left the restoring is told from a memory of the water. At forward speed
    incidence adds damping to it, so only runs at rest serve; two frequencies or more are needed.
    """
    if cycles[0].plane is not Plane.VERTICAL:
        return []
    pairs = []
    for column in (0, 1):
        pure = [cycle for cycle in cycles if _serves(cycle, column)]
        if len({round(cycle.frequency_hz, 4) for cycle in pure}) < 2:
            continue
        pairs += [_restoring(pure, row, column) for row in (0, 1)]
    return pairs


def _serves(cycle: BodyCycle, column: int) -> bool:
    if cycle.frequency_hz == 0.0 or cycle.speed_m_s != 0.0 or cycle.body is None:
        return False
    size = np.abs(cycle.at_struts)
    return bool(size[1 - column] <= _PURE * size[column])


def _restoring(cycles: Sequence[BodyCycle], row: int, column: int) -> Pair:
    name = f"C{'35'[row]}{'35'[column]}"
    hertz = np.array([cycle.frequency_hz for cycle in cycles])
    omega = 2.0 * math.pi * hertz
    stiffness = stacked([_stiffness(cycle, row, column) for cycle in cycles])
    loads = stiffness.scaled(np.stack((-(omega**-2), 1.0 / omega), axis=1).ravel())
    kinds = np.tile((True, False), len(cycles))
    slow = at_zero_frequency(name, np.repeat(hertz, 2), kinds, loads, restoring=True)
    hydrostatic = UncertainValues(np.array([float(cycles[0].restoring[row, column])]))
    values = stacked([slow.select([2]), hydrostatic])
    texts = (f"the load in phase of {len(cycles)} runs", "hydrostatics")
    return Pair(RESTORING, name, ("N/m", "N", "N m")[row + column], texts, values)


def _stiffness(cycle: BodyCycle, row: int, column: int) -> UncertainValues:
    """Load in phase with the motion and ahead of it, over it, less the model's inertia and weight.

    What the other motion asks for by hydrostatics is taken off: pitch by struts that slide heaves
    the midpoint a little.
    """
    names = (MOTIONS[column], MOTIONS[1 - column], LOADS[row])
    chosen = cycle.phasors.select([at_order(name, 1) for name in names])
    motion, cross_motion, load = chosen.values
    cross_stiffness = cycle.restoring[row, 1 - column]
    ratio = (load - cross_stiffness * cross_motion) / motion
    body = cycle.body
    assert body is not None  # noqa: S101 - _serves saw to it
    square = (2.0 * math.pi * cycle.frequency_hz) ** 2
    weight = weight_matrix(body, cycle.plane, cycle.medium)
    taken = weight - square * mass_matrix(body, cycle.plane)
    value = np.array([ratio.real - taken[row, column], ratio.imag])
    slope = np.array([-ratio / motion, -cross_stiffness / motion, 1.0 / motion])
    parts = np.stack((slope, 1j * slope), axis=1).ravel()  # of real and imaginary parts
    rows = np.stack((parts.real, parts.imag))
    return UncertainValues(value, chosen.real.mapped(rows).contributions)
