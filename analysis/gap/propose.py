"""Which run to make next: the one that is expected to tell the leading answers apart.

An oscillation tells two answers apart by what they predict differently there, each with its own
parameters known no better than the campaign knows them, and with the coefficients free as always.
A measurement of another kind (at rest, with a check weight, with a signal in place of the bridges)
tells apart what it shows of an effect's stage by itself. A run is worth the log odds that whichever
answer is right gains over all others together: a rival that it does not touch is left standing,
however far it throws the rest.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Final

import numpy as np
from numpy.typing import NDArray

from analysis.gap.components import GapRun, Stack
from analysis.gap.fit import Fit, Problem
from analysis.gap.forecast import forecast, further, planned
from analysis.gap.free import Free
from analysis.gap.priors import Priors
from hardware.description.errors import PmmError
from hardware.description.oscillator import Range
from hardware.description.setpoint import Medium, SetPoint

FloatArray = NDArray[np.float64]

ENOUGH: Final = 20.0  # log odds beyond which more is worth no more
NO_GAP: Final = "no gap"
_FREQUENCIES: Final = 3
_RADII: Final = 2

Leading = Sequence[tuple[Fit | None, float]]
"""The leading answers with their probabilities; ``None`` for no gap."""


@dataclass(frozen=True)
class Choices:
    """What a rig can do next.

    Attributes
    ----------
    special
        Of :class:`sim.effects.effect.Measurement`.
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
        Log odds that the right one of the leading answers is expected to gain, at most ``ENOUGH``.
    between
        Those answers, by name, ``"no gap"`` among them.
    """

    kind: str
    set_point: SetPoint | None
    preload_n: float
    gain: float
    between: tuple[str, ...] = ()


def proposals(
    problem: Problem,
    leading: Leading,
    choices: Choices,
    free: Sequence[Free],
    priors: Priors,
) -> tuple[Proposal, ...]:
    """Return runs in the order of what they are worth."""
    found = [*_oscillations(problem, leading, choices, free, priors), *_special(leading, choices)]
    answers = tuple(NO_GAP if fit is None else " and ".join(fit.names) for fit, _ in leading)
    ranked = sorted(found, key=lambda one: -one.gain)
    return tuple(replace(one, between=answers) for one in ranked)


def _oscillations(
    problem: Problem,
    leading: Leading,
    choices: Choices,
    free: Sequence[Free],
    priors: Priors,
) -> Iterator[Proposal]:
    runs = [planned(problem, one, number) for number, one in enumerate(set_points(choices))]
    runs = [run for run in runs if _bearable(problem, run, choices)]
    if not runs:
        return
    there = further(problem, runs, free, priors)
    told = [forecast(problem, there, fit) for fit, _ in leading]
    shares = [share for _, share in leading]
    means, roots = [one.mean for one in told], [one.whole for one in told]
    for number, run in enumerate(runs):
        rows = there.simulator.stack.run == number
        odds = _apart(np.column_stack([one[rows] for one in means]), [one[rows] for one in roots])
        yield Proposal("oscillation", run.set_point, 0.0, gained(shares, odds))


def gained(shares: Sequence[float], odds: FloatArray) -> float:
    """Return the log odds that the right answer gains over all others, over which it may be.

    Parameters
    ----------
    shares
        How probable each answer is, shape ``(answers,)``; they need not sum to 1.
    odds
        Expected log odds between each two of the answers after a run, ``(answers, answers)``.
    """
    if len(shares) < 2:
        return 0.0
    others = np.asarray(shares) * (1.0 - np.eye(len(shares)))
    left = np.sum(others * np.exp(-np.minimum(odds, ENOUGH)), axis=1)
    return float(np.average(np.log(others.sum(axis=1) / left), weights=shares))


def _apart(means: FloatArray, roots: Sequence[FloatArray]) -> FloatArray:
    """Return the expected log odds between each two answers after a run, by symmetric divergence.

    Parameters
    ----------
    means
        What each answer predicts, shape ``(observations, answers)``.
    roots
        The root of its covariance without the noise, shape ``(observations, any)``.
    """
    squares = np.zeros((means.shape[1], means.shape[1]))
    for number, whole in enumerate(roots):
        root = whole[:, whole.any(axis=0)]  # frequency and noise are each run's own
        away = means - means[:, number, None]
        towards = np.linalg.solve(np.eye(root.shape[1]) + root.T @ root, root.T @ away)
        squares[number] = np.sum(away * (away - root @ towards), axis=0)
    return 0.25 * (squares + squares.T)


def set_points(choices: Choices) -> Iterator[SetPoint]:
    """Yield what a rig can do, in steps; in numbers of three digits, as people set them."""
    low, high = choices.frequency_hz.low, choices.frequency_hz.high
    frequencies = np.geomspace(max(low, high / 8.0), high, _FREQUENCIES)
    least, most = choices.eccentricity_m.low, choices.eccentricity_m.high
    radii = np.geomspace(max(least, most / 5.0), most, _RADII)
    for frequency, radius, phase, speed, medium in product(
        frequencies, radii, choices.strut_phase_rad, choices.carriage_speed_m_s, choices.media
    ):
        if medium is Medium.WATER or not speed:
            yield SetPoint(
                _settable(frequency, choices.frequency_hz),
                _settable(radius, choices.eccentricity_m),
                phase,
                speed,
                medium,
            )


def _settable(value: float, span: Range) -> float:
    return min(max(float(f"{value:.3g}"), span.low), span.high)


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


def _special(leading: Leading, choices: Choices) -> Iterator[Proposal]:
    shares = [share for _, share in leading]
    for kind in choices.special:
        told = [_tells(kind, fit) for fit, _ in leading]
        odds = [[ENOUGH * (one != other) for other in told] for one in told]
        yield Proposal(kind, None, 0.0, gained(shares, np.array(odds)))


def _tells(kind: str, fit: Fit | None) -> frozenset[str]:
    parts = () if fit is None else fit.candidates
    return frozenset(one.name for one in parts if kind in one.kind.shown_by)
