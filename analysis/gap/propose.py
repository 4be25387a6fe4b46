"""Which run to make next: the one that is expected to tell the leading answers apart.

An oscillation is worth what the leading answers predict differently there, each with its own
parameters known no better than the campaign knows them, and with the coefficients free as always.
A measurement of another kind (at rest, with a check weight, with a signal in place of the bridges)
is worth what it shows of an effect's stage by itself.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, product
from typing import Final

import numpy as np
from numpy.typing import NDArray

from analysis.gap.components import GapRun, Stack
from analysis.gap.fit import Fit, Problem
from analysis.gap.forecast import Forecast, forecast, further, planned
from analysis.gap.free import Free
from analysis.gap.priors import Priors
from hardware.description.errors import PmmError
from hardware.description.oscillator import Range
from hardware.description.setpoint import Medium, SetPoint

FloatArray = NDArray[np.float64]

ENOUGH: Final = 40.0  # log odds beyond which more is worth no more
_FREQUENCIES: Final = 3
_RADII: Final = 2


@dataclass(frozen=True)
class Choices:
    """What a rig can do next.

    Attributes
    ----------
    special
        Of ``"rest"``, ``"check-weight"``, ``"injection"`` and ``"preload"``.
    """

    frequency_hz: Range
    eccentricity_m: Range
    strut_phase_rad: tuple[float, ...] = (0.0, math.pi / 2.0, math.pi)
    carriage_speed_m_s: tuple[float, ...] = (0.0,)
    media: tuple[Medium, ...] = (Medium.WATER, Medium.AIR)
    special: tuple[str, ...] = ("rest", "check-weight", "injection")
    force_limit_n: float = math.inf


@dataclass(frozen=True)
class Proposal:
    """A run, and what it is expected to be worth.

    Attributes
    ----------
    kind
        ``"oscillation"`` or one of the special ones.
    gain
        Expected log odds between the leading answers that it adds, at most ``ENOUGH``.
    """

    kind: str
    set_point: SetPoint | None
    preload_n: float
    gain: float
    reason: str


# What a special measurement shows by itself, whatever the effect's size.
_SHOWN: Final[Mapping[str, frozenset[str]]] = {
    "rest": frozenset({"zero-offset", "zero-drift", "hum", "residual-waves", "temperature"}),
    "check-weight": frozenset(
        {"gain-error", "cross-talk", "quadratic-gauge", "gauge-hysteresis", "saturation"}
    ),
    "injection": frozenset({"amplifier-lag", "channel-skew", "hum", "saturation"}),
    "preload": frozenset({"joint-play", "gear-backlash", "inertia-play"}),
}


def proposals(
    problem: Problem,
    leading: Sequence[tuple[Fit | None, float]],
    choices: Choices,
    free: Sequence[Free],
    priors: Priors,
) -> tuple[Proposal, ...]:
    """Return runs in the order of what they are worth.

    Parameters
    ----------
    leading
        The leading answers with their probabilities; ``None`` for no gap.
    """
    found = [*_oscillations(problem, leading, choices, free, priors), *_special(leading, choices)]
    return tuple(sorted(found, key=lambda one: -one.gain))


def _oscillations(
    problem: Problem,
    leading: Sequence[tuple[Fit | None, float]],
    choices: Choices,
    free: Sequence[Free],
    priors: Priors,
) -> Iterator[Proposal]:
    runs = [planned(problem, one, number) for number, one in enumerate(_set_points(choices))]
    runs = [run for run in runs if _bearable(problem, run, choices)]
    if not runs:
        return
    there = further(problem, runs, free, priors)
    told = [forecast(problem, there, fit) for fit, _ in leading]
    for number, run in enumerate(runs):
        rows = there.simulator.stack.run == number
        gain = sum(
            leading[i][1] * leading[j][1] * min(_apart(told[i], told[j], rows), ENOUGH)
            for i, j in combinations(range(len(leading)), 2)
        )
        share = sum(a[1] * b[1] for a, b in combinations(leading, 2))
        yield Proposal("oscillation", run.set_point, 0.0, gain / max(share, 1e-12), "")


def _apart(one: Forecast, other: Forecast, rows: NDArray[np.bool_]) -> float:
    """Return the expected log odds between two answers after a run, by symmetric divergence."""
    difference = one.mean[rows] - other.mean[rows]
    total = 0.0
    for side in (one, other):
        root = side.whole[rows]
        root = root[:, root.any(axis=0)]  # frequency and noise are each run's own
        left = difference - root @ np.linalg.solve(
            np.eye(root.shape[1]) + root.T @ root, root.T @ difference
        )
        total += 0.25 * float(difference @ left)
    return total


def _set_points(choices: Choices) -> Iterator[SetPoint]:
    low, high = choices.frequency_hz.low, choices.frequency_hz.high
    frequencies = np.geomspace(max(low, high / 8.0), high, _FREQUENCIES)
    least, most = choices.eccentricity_m.low, choices.eccentricity_m.high
    radii = np.geomspace(max(least, most / 5.0), most, _RADII)
    for frequency, radius, phase, speed, medium in product(
        frequencies, radii, choices.strut_phase_rad, choices.carriage_speed_m_s, choices.media
    ):
        if medium is Medium.WATER or not speed:
            yield SetPoint(float(frequency), float(radius), phase, speed, medium)


def _bearable(problem: Problem, run: GapRun, choices: Choices) -> bool:
    """Tell whether the struts can carry a run, by the nominal simulation."""
    if math.isinf(choices.force_limit_n):
        return True
    simulator = replace(problem.simulator, stack=Stack.of([run]))
    try:
        values = simulator.steady(())
    except PmmError:
        return False
    forces = [
        abs(value)
        for one, value in zip(run.observed.components, values, strict=True)
        if one.channel.startswith("force") and one.order == 1
    ]
    return math.sqrt(2.0) * max(forces, default=0.0) < choices.force_limit_n


def _special(leading: Sequence[tuple[Fit | None, float]], choices: Choices) -> Iterator[Proposal]:
    share = sum(a[1] * b[1] for a, b in combinations(leading, 2))
    for kind in choices.special:
        told = [_tells(kind, fit) for fit, _ in leading]
        gain = sum(
            leading[i][1] * leading[j][1] * ENOUGH * 0.5 * (told[i] != told[j])
            for i, j in combinations(range(len(leading)), 2)
        )
        yield Proposal(kind, None, 0.0, gain / max(share, 1e-12), "")


def _tells(kind: str, fit: Fit | None) -> frozenset[str]:
    names = frozenset(() if fit is None else fit.names)
    return names & _SHOWN.get(kind, frozenset())
