"""Which run to make next: the one that is expected to tell the leading answers apart.

A run tells two answers apart by what they predict differently there, each with its own parameters
known no better than the campaign knows them, and with the coefficients free as always: whether it
is an oscillation, one with a dead weight that takes up play, or a measurement of another kind. What
does not repeat (hum, a drift) shows in those of them that its effect names, by itself. "No gap",
something unknown, other coefficients and an odd run are answers too: each expects of further runs
what its own deviation leaves open. A run is worth the log odds that whichever answer is right gains
over all others together, for the tank time that it takes: a rival that it does not touch is left
standing, however far it throws the rest.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import islice, product
from operator import attrgetter
from typing import Final

import numpy as np

from analysis.gap.design.beside import Unnamed
from analysis.gap.design.forecast import next_place, planned, waited_s
from analysis.gap.design.information_gain import Leading
from analysis.gap.design.measurements import BESIDES, INJECTED_HZ, REST_S, measured_besides
from analysis.gap.design.valuation import Choice, Valuation, Valued
from analysis.gap.forward.free_numbers import Free
from analysis.gap.forward.problem import Problem
from analysis.gap.forward.simulator import Simulator
from analysis.gap.forward.tolerances import Tolerances
from analysis.gap.observe.components import GapRun
from analysis.gap.observe.regimes import describe
from analysis.gap.search.fit import Fit
from hardware.description.errors import PmmError
from hardware.description.oscillator import Range
from hardware.description.setpoint import Medium, SetPoint
from hardware.description.units import STANDARD_GRAVITY_M_S2
from sim.effects.campaign import CampaignRun
from sim.effects.effect import FurtherMeasurement
from sim.signals import FORCE_AFT, FORCE_FORE

OSCILLATION: Final = "oscillation"
_GENTLER: Final = 3  # one of so many kinds of run is looked at with smaller eccentricities too
_PRELOADED: Final = 6  # of the oscillations that can be made so, each with a dead weight
_ABOVE: Final = 1.25  # of a dead weight over the force that would lift it
_SAID: Final[Mapping[str, str]] = {
    FurtherMeasurement.REST: "a record at rest",
    FurtherMeasurement.CHECK_WEIGHT: "a check weight of {:g} N on the {} dynamometer",
    FurtherMeasurement.INJECTION: f"a sine of {{:g}} N at {INJECTED_HZ:g} Hz into all force "
    "amplifiers in place of the bridges",
}
_FREQUENCIES: Final = 3
_RADII: Final = 2


@dataclass(frozen=True)
class Choices:
    """What a rig can do next.

    Attributes
    ----------
    special
        What can be measured besides; ``PRELOAD`` is a weight on the model while it oscillates.
    runs
        The oscillations themselves, in place of steps between the limits; none for these steps.
    batch
        Runs that are made before anyone looks again: they are weighed together.
    """

    frequency_hz: Range
    eccentricity_m: Range
    strut_phase_rad: tuple[float, ...] = (0.0, math.pi / 2.0, math.pi)
    carriage_speed_m_s: tuple[float, ...] = (0.0,)
    media: tuple[Medium, ...] = (Medium.WATER, Medium.AIR)
    drift_rad: tuple[float, ...] = (0.0,)
    special: tuple[FurtherMeasurement, ...] = tuple(FurtherMeasurement)
    force_limit_n: float = math.inf
    runs: tuple[SetPoint, ...] = ()
    batch: int = 1


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
        Log odds that the right one of the leading answers is expected to gain, at most ``ENOUGH``;
        of the runs of a batch, those that it adds to the runs before it.
    between
        Those answers, by name, ``"no gap"`` among them.
    strut
        ``"aft"`` or ``"fore"``, whose dynamometer a check weight is put on.
    cost_s
        Tank time until the next run can begin.
    """

    kind: str
    set_point: SetPoint | None
    force_n: float
    gain: float
    between: tuple[str, ...] = ()
    strut: str = ""
    cost_s: float = math.nan

    def __str__(self) -> str:
        if self.set_point is not None:
            weight = f", with {dead_weight(self.force_n)}" if self.force_n else ""
            return describe(self.set_point) + weight
        return _SAID[self.kind].format(self.force_n, self.strut)


def dead_weight(force_n: float) -> str:
    """Say what takes up play, whichever plane the model moves in."""
    return f"a dead weight of {force_n:g} N on the model (on a cord where it moves sideways)"


def proposals(
    problem: Problem,
    leading: Leading,
    choices: Choices,
    free: Sequence[Free],
    tolerances: Tolerances,
) -> tuple[Proposal, ...]:
    """Return runs in the order of what they are worth."""
    place, valuation = next_place(problem), Valuation(problem, leading, free, tolerances)
    first, gentler = _by_size(tuple(_oscillations(problem, choices, place)))
    ranked = sorted(valuation.each(first), key=attrgetter("order"))
    # A gentler motion tells more than another kind of run only where the larger one tells much.
    best = {_kind_of(valued.choice) for valued in ranked[: -(-len(ranked) // _GENTLER)]}
    ranked += valuation.each([choice for choice in gentler if _kind_of(choice) in best])
    ranked.sort(key=attrgetter("order"))
    remaining = [choice for choice in gentler if _kind_of(choice) not in best]
    plays = any(
        candidate.kind.taken_up
        for answer, _ in leading
        if isinstance(answer, Fit)
        for candidate in answer.candidates
    )
    if plays and FurtherMeasurement.PRELOAD in choices.special:
        # the larger ones may throw a weight off
        bare = [*(valued.choice for valued in ranked), *remaining]
        pressed = _preloaded_choices(problem.simulator, bare, choices)
        ranked += valuation.each(tuple(islice(pressed, _PRELOADED)))
    ranked += valuation.each(tuple(_measurements(problem, choices, place)))
    between = tuple(_name(answer) for answer, _ in leading)
    return tuple(
        _proposal(valued, between)
        for valued in valuation.batch(sorted(ranked, key=attrgetter("order")), choices.batch)
    )


def _proposal(valued: Valued, between: tuple[str, ...]) -> Proposal:
    choice, gain = valued.choice, valued.worth.gain
    return Proposal(
        choice.kind, choice.set_point, choice.force_n, gain, between, choice.strut, choice.cost_s
    )


def _name(answer: Fit | Unnamed) -> str:
    return " and ".join(answer.names) if isinstance(answer, Fit) else answer.name


def _oscillations(problem: Problem, choices: Choices, place: CampaignRun) -> Iterator[Choice]:
    between_s = waited_s(problem)
    for number, point in enumerate(set_points(choices)):
        run = planned(problem, point, number, place)
        if _largest_force_n(problem.simulator, [run]) < choices.force_limit_n:
            cost_s = between_s + run.periods / point.frequency_hz
            yield Choice(OSCILLATION, point, 0.0, run, cost_s)


def _kind_of(choice: Choice) -> SetPoint | None:
    """Return what runs of other eccentricities have in common."""
    return None if choice.set_point is None else replace(choice.set_point, eccentricity_m=0.0)


def _by_size(choices: Sequence[Choice]) -> tuple[list[Choice], list[Choice]]:
    """Return the run of the largest eccentricity of each kind, and the others."""
    largest: dict[SetPoint | None, Choice] = {}
    for choice in sorted(choices, key=lambda choice: choice.run.set_point.eccentricity_m):
        largest[_kind_of(choice)] = choice
    first = list(largest.values())
    return first, [choice for choice in choices if choice not in first]


def _preloaded_choices(
    simulator: Simulator, turning: Sequence[Choice], choices: Choices
) -> Iterator[Choice]:
    """Yield oscillations with a weight on the model that keeps both struts pressed one way.

    Each strut carries half of it, and half of what its mass takes to be moved along.
    """
    for choice in turning:
        largest_n = _largest_force_n(simulator, [choice.run])
        swing = _swing(choice.run.set_point)
        weight_n = _pressing_n(largest_n, swing)
        if weight_n > 0.0 and largest_n + 0.5 * weight_n * (1.0 + swing) < choices.force_limit_n:
            yield replace(choice, force_n=weight_n, run=replace(choice.run, preload_n=weight_n))


def _swing(point: SetPoint) -> float:
    """Return the struts' largest acceleration over that of gravity."""
    omega_rad_s = 2.0 * math.pi * point.frequency_hz
    return omega_rad_s**2 * point.eccentricity_m / STANDARD_GRAVITY_M_S2


def _pressing_n(largest_n: float, swing: float) -> float:
    """Return the weight W of which W/2 less its own inertia is more than the struts' force.

    Infinite where the weight itself would be thrown off, or its cord go slack.
    """
    if swing >= 1.0:
        return math.inf
    least_n = 2.0 * _ABOVE * largest_n / (1.0 - swing)
    weight_n = _readable(least_n)
    return weight_n if weight_n >= least_n else _readable(1.05 * least_n)


def _measurements(problem: Problem, choices: Choices, place: CampaignRun) -> Iterator[Choice]:
    force_n = _readable(_largest_force_n(problem.simulator, problem.simulator.stack.turning))
    cost_s = waited_s(problem) + REST_S
    for kind, strut in BESIDES:
        if kind in choices.special:
            size_n = 0.0 if kind is FurtherMeasurement.REST else force_n
            run = measured_besides(problem, kind, place, size_n, strut)
            if run is not None:
                yield Choice(kind, None, size_n, run, cost_s, strut)


def _readable(force_n: float) -> float:
    return float(f"{force_n:.2g}")


def set_points(choices: Choices) -> Iterator[SetPoint]:
    """Yield what a rig can do: its runs, or steps in numbers of three digits, as people set."""
    if choices.runs:
        yield from choices.runs
        return
    frequencies = _steps(choices.frequency_hz, _FREQUENCIES, 8.0)
    radii = _steps(choices.eccentricity_m, _RADII, 5.0)
    speeds, phases = choices.carriage_speed_m_s, choices.strut_phase_rad
    for frequency, radius, phase, speed, medium, drift in product(
        frequencies, radii, phases, speeds, choices.media, choices.drift_rad
    ):
        if (medium is Medium.WATER or not speed) and (speed or not drift):
            yield SetPoint(frequency, radius, phase, speed, medium, drift)


def _steps(span: Range, count: int, ratio: float) -> tuple[float, ...]:
    """Return equal ratios down from the largest, each once: a rig may have one frequency only."""
    values = np.geomspace(max(span.low, span.high / ratio), span.high, count)
    return tuple(dict.fromkeys(_settable(float(value), span) for value in values))


def _settable(value: float, span: Range) -> float:
    return min(max(float(f"{value:.3g}"), span.low), span.high)


def _largest_force_n(simulator: Simulator, runs: Sequence[GapRun]) -> float:
    """Return the largest first harmonic of either strut's force, as the rig is believed to be.

    Both struts count, whichever of them is recorded. Infinite where it cannot be simulated.
    """
    try:
        return max((_force_n(simulator, run) for run in runs), default=0.0)
    except PmmError:
        return math.inf


def _force_n(simulator: Simulator, run: GapRun) -> float:
    spectra = simulator.state(run, simulator.active_effects).spectra
    return max(abs(complex(spectra[force.name][1])) for force in (FORCE_AFT, FORCE_FORE))
