"""Which run to make next: the one that is expected to tell the leading answers apart.

A run tells two answers apart by what they predict differently there, each with its own parameters
known no better than the campaign knows them, and with the coefficients free as always: whether it
is an oscillation, one with a dead weight that takes up play, or a measurement of another kind. What
does not repeat (hum, a drift) shows in those of them that its effect names, by itself. A run is
worth the log odds that whichever answer is right gains over all others together: a rival that it
does not touch is left standing, however far it throws the rest.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import product
from typing import Final

import numpy as np
from numpy.typing import NDArray

from analysis.gap.components import GapRun, Part, Stack
from analysis.gap.fit import Fit, Problem
from analysis.gap.forecast import forecast, further, next_place, planned
from analysis.gap.free import Free
from analysis.gap.measurements import BESIDES, INJECTED_HZ, measured_besides
from analysis.gap.observe import FORCES
from analysis.gap.priors import Priors
from analysis.gap.regimes import describe
from hardware.description.errors import PmmError
from hardware.description.oscillator import Range
from hardware.description.setpoint import Medium, SetPoint
from sim.effects.campaign import CampaignRun
from sim.effects.effect import Measurement

FloatArray = NDArray[np.float64]

ENOUGH: Final = 20.0  # log odds beyond which more is worth no more
NO_GAP: Final = "no gap"
OSCILLATION: Final = "oscillation"
_PRELOADED: Final = 6  # of the best oscillations, each once more with a dead weight
_ABOVE: Final = 1.25  # of a dead weight over the force that would lift it
_SAID: Final[Mapping[str, str]] = {
    Measurement.REST: "a record at rest",
    Measurement.CHECK_WEIGHT: "a check weight of {:g} N on each dynamometer in turn",
    Measurement.INJECTION: f"a sine of {{:g}} N at {INJECTED_HZ:g} Hz into all force amplifiers in "
    "place of the bridges",
}
_HARMONIC: Final = (Part.IN_PHASE, Part.QUADRATURE)
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
        What can be measured besides; ``PRELOAD`` is a weight on the model while it oscillates.
    """

    frequency_hz: Range
    eccentricity_m: Range
    strut_phase_rad: tuple[float, ...] = (0.0, math.pi / 2.0, math.pi)
    carriage_speed_m_s: tuple[float, ...] = (0.0,)
    media: tuple[Medium, ...] = (Medium.WATER, Medium.AIR)
    special: tuple[Measurement, ...] = tuple(Measurement)
    force_limit_n: float = math.inf


@dataclass(frozen=True)
class Proposal:
    """A run, and what it is expected to be worth.

    Attributes
    ----------
    kind
        ``"oscillation"``, or a measurement besides.
    force_n
        Of an oscillation the dead weight on the model, 0 for none; the check weight; the amplitude
        of the sine.
    gain
        Log odds that the right one of the leading answers is expected to gain, at most ``ENOUGH``.
    between
        Those answers, by name, ``"no gap"`` among them.
    """

    kind: str
    set_point: SetPoint | None
    force_n: float
    gain: float
    between: tuple[str, ...] = ()

    def __str__(self) -> str:
        if self.set_point is not None:
            weight = f", with {self.force_n:g} N hung on the model" if self.force_n else ""
            return describe(self.set_point) + weight
        return _SAID[self.kind].format(self.force_n)


@dataclass(frozen=True, eq=False)
class _Choice:
    """Something to do next, and the records that it makes."""

    kind: str
    set_point: SetPoint | None
    force_n: float
    runs: tuple[GapRun, ...]


def proposals(
    problem: Problem,
    leading: Leading,
    choices: Choices,
    free: Sequence[Free],
    priors: Priors,
) -> tuple[Proposal, ...]:
    """Return runs in the order of what they are worth."""
    place = next_place(problem)
    weighed = partial(_weighed, problem, leading, free=free, priors=priors)
    found = sorted(weighed(tuple(_oscillations(problem, choices, place))), key=_least)
    plays = any(one.kind.taken_up for fit, _ in leading if fit for one in fit.candidates)
    if plays and Measurement.PRELOAD in choices.special:
        bare = [one for one, _ in found[:_PRELOADED]]
        found += weighed(tuple(_preloaded(problem, bare, choices)))
    found += weighed(tuple(_measurements(problem, choices, place)))
    answers = tuple(NO_GAP if fit is None else " and ".join(fit.names) for fit, _ in leading)
    return tuple(
        Proposal(one.kind, one.set_point, one.force_n, worth, answers)
        for one, worth in sorted(found, key=_least)
    )


def _least(one: "tuple[_Choice, float]") -> float:
    return -one[1]


def _oscillations(problem: Problem, choices: Choices, place: CampaignRun) -> Iterator[_Choice]:
    for number, point in enumerate(set_points(choices)):
        run = planned(problem, point, number, place)
        if _largest_force_n(problem, [run]) < choices.force_limit_n:
            yield _Choice(OSCILLATION, point, 0.0, (run,))


def _preloaded(problem: Problem, turning: Sequence[_Choice], choices: Choices) -> Iterator[_Choice]:
    """Yield oscillations with a weight on the model that no force of theirs lifts."""
    for one in turning:
        largest_n = _largest_force_n(problem, one.runs)
        weight_n = _readable(2.0 * _ABOVE * largest_n)  # both struts carry it
        if largest_n + 0.5 * weight_n < choices.force_limit_n:
            runs = tuple(replace(run, preload_n=weight_n) for run in one.runs)
            yield replace(one, force_n=weight_n, runs=runs)


def _measurements(problem: Problem, choices: Choices, place: CampaignRun) -> Iterator[_Choice]:
    force_n = _readable(_largest_force_n(problem, problem.simulator.stack.turning))
    for kind in BESIDES:
        if kind in choices.special:
            size_n = 0.0 if kind is Measurement.REST else force_n
            yield _Choice(kind, None, size_n, measured_besides(problem, kind, place, size_n))


def _readable(force_n: float) -> float:
    return float(f"{force_n:.2g}")


def _weighed(
    problem: Problem,
    leading: Leading,
    some: Sequence[_Choice],
    free: Sequence[Free],
    priors: Priors,
) -> Iterator[tuple[_Choice, float]]:
    """Yield each choice with what it is worth."""
    runs = [run for one in some for run in one.runs]
    if not runs:
        return
    there = further(problem, runs, free, priors)
    told = [forecast(problem, there, fit) for fit, _ in leading]
    shares = [share for _, share in leading]
    whose = np.repeat(np.arange(len(some)), [len(one.runs) for one in some])
    for number, one in enumerate(some):
        rows = whose[there.simulator.stack.run] == number
        means = np.column_stack([forecasted.mean[rows] for forecasted in told])
        odds = _apart(means, [forecasted.whole[rows] for forecasted in told])
        yield one, gained(shares, odds + _by_themselves(one.kind, leading))


def _by_themselves(kind: str, leading: Leading) -> FloatArray:
    """Return the odds between answers by what does not repeat and shows in a measurement."""
    told = [
        {one.name for one in (() if fit is None else fit.candidates) if kind in one.kind.shown_by}
        for fit, _ in leading
    ]
    return np.array([[ENOUGH * (one != other) for other in told] for one in told])


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


def _largest_force_n(problem: Problem, runs: Sequence[GapRun]) -> float:
    """Return the largest first harmonic of a strut's force, as the rig is believed to be.

    Infinite where it cannot be simulated.
    """
    simulator = replace(problem.simulator, stack=Stack.of(runs))
    try:
        values = simulator.steady(())
    except PmmError:
        return math.inf
    forces = [
        abs(float(value))
        for one, value in zip(simulator.stack.components, values, strict=True)
        if one.channel in FORCES and one.order == 1 and one.part in _HARMONIC
    ]
    return math.sqrt(2.0) * max(forces, default=0.0)
