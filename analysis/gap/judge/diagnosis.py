"""The whole diagnosis of a campaign: where, which, how far, unknown, next."""

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field

from analysis.gap.design.proposals import Choices, Proposal, proposals
from analysis.gap.forward.free_numbers import Free, free_numbers, tolerated
from analysis.gap.forward.noise import pooled
from analysis.gap.forward.problem import Problem
from analysis.gap.forward.simulator import Simulator
from analysis.gap.forward.tolerances import Tolerances
from analysis.gap.inference.answers import COEFFICIENTS, NONE, Answers, effects_in
from analysis.gap.judge.leading import leading
from analysis.gap.judge.verdict import equivalents, stage_probabilities
from analysis.gap.judge.withheld import Predicted, Shrinkage, predict_withheld, shrinkage
from analysis.gap.locate.walk import Walk, walk
from analysis.gap.observe.components import GapRun, Part, Stack
from analysis.gap.observe.regimes import Regime, regimes
from analysis.gap.search.fit import Fit
from analysis.gap.search.hypotheses import weigh
from analysis.gap.search.weighed import WeighedHypotheses
from hardware.description.errors import DataError
from sim.effects.a5_trigger_jitter import TriggerJitter
from sim.effects.effect import Effect
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class Settings:
    """How a campaign is diagnosed.

    Attributes
    ----------
    catalogue
        Effects to consider, by name.
    active_effects
        Effects that are known already and always on.
    withheld
        Regimes to judge by; found from the runs if empty.
    choices
        What the rig can do next; ``None`` proposes nothing.
    moved
        By how many tolerances the rig was moved from what is stated, by name.
    free
        What is left free, about what is stated; if empty, about the rig that is given.
    """

    catalogue: Mapping[str, type[Effect]]
    tolerances: Tolerances = field(default_factory=Tolerances)
    active_effects: tuple[Effect, ...] = ()
    withheld: tuple[Regime, ...] = ()
    choices: Choices | None = None
    reference_channel: str | None = None
    moved: Mapping[str, float] = field(default_factory=dict)
    free: tuple[Free, ...] = ()


@dataclass(frozen=True, eq=False)
class Diagnosis:
    """Everything that was found.

    Attributes
    ----------
    best
        The most probable named hypothesis; ``None`` where the answer names no effect.
    rival
        The next best one of another class: the control of the withheld runs.
    classes
        What these runs cannot tell from each effect of ``best``, beside the other if there are two,
        with sigma left.
    before, after
        Withheld runs predicted without and with the best hypothesis.
    """

    walk: Walk
    weighed: WeighedHypotheses[Problem]
    stages: Mapping[str, float]
    best: Fit | None
    rival: Fit | None
    classes: Mapping[str, tuple[tuple[str, float], ...]]
    before: tuple[Predicted, ...]
    after: tuple[Predicted, ...]
    shrinkage: Shrinkage | None
    proposals: tuple[Proposal, ...]

    @property
    def problem(self) -> Problem:
        """What was diagnosed."""
        return self.weighed.problem

    @property
    def answers(self) -> Answers:
        """How probable each answer is."""
        return self.weighed.answers

    @property
    def cause(self) -> Fit | None:
        """What the answer names as the cause; ``None`` where it names none."""
        return self.best if effects_in(self.answers.best) else None


def diagnose(
    rig: SimulatedRig,
    runs: Sequence[GapRun],
    settings: Settings,
    executor: Executor | None = None,
    progress: Callable[[str], None] = lambda _: None,
) -> Diagnosis:
    """Diagnose a campaign.

    Parameters
    ----------
    rig
        As the simulation believes it to be.
    runs
        At least three, observed by :func:`analysis.gap.observe.observation.observe`.

    Raises
    ------
    DataError
        If there are fewer than three runs.
    ConfigurationError
        If the rig cannot run what was recorded.
    """
    if len(runs) < 3:
        raise DataError(f"{len(runs)} runs: a diagnosis needs 3 or more")
    free = settings.free or free_numbers(rig, settings.tolerances)
    problem = problem_of(rig, runs, settings, free)
    progress("walking along the chain")
    walked = walk(problem)
    weighed = weigh(problem, settings.catalogue, executor, progress, free)
    return _conclude(walked, weighed, settings, free, progress)


def problem_of(
    rig: SimulatedRig, runs: Sequence[GapRun], settings: Settings, free: tuple[Free, ...]
) -> Problem:
    """Return what every hypothesis about a campaign is held against."""
    stack = Stack.of(pooled(runs, rig, settings.tolerances))
    on = (*settings.active_effects, *_always_on(rig, stack, settings.tolerances))
    simulator = Simulator(rig, stack, on, settings.reference_channel)
    nuisances = tolerated(simulator, free, settings.tolerances)
    return Problem(simulator, nuisances, moved=settings.moved)


def _always_on(rig: SimulatedRig, stack: Stack, tolerances: Tolerances) -> tuple[Effect, ...]:
    """Return what every photocell has: pulses that scatter a little; an encoder's turns do not."""
    pulsed = any(
        component.part in (Part.PULSES, Part.PERIOD_SCATTER) for component in stack.components
    )
    if rig.photocell is None or not pulsed or not tolerances.pulse_scatter_rad:
        return ()
    return (TriggerJitter(tolerances.pulse_scatter_rad),)


def _conclude(
    walked: Walk,
    weighed: WeighedHypotheses[Problem],
    settings: Settings,
    free: tuple[Free, ...],
    progress: Callable[[str], None],
) -> Diagnosis:
    problem, ranked = weighed.problem, weighed.ranked
    calm = weighed.answers.best in (NONE, COEFFICIENTS)
    best = None if calm or not ranked else ranked[0]
    classes = {} if best is None else equivalents(problem, best, weighed.singles)
    rival = _rival(best, ranked, classes)
    withheld = settings.withheld or regimes(problem.simulator.stack.runs)
    before = predict_withheld(problem, None, withheld)
    after = before if best is None else predict_withheld(problem, best, withheld)
    progress("choosing the next run")
    return Diagnosis(
        walked,
        weighed,
        stage_probabilities(weighed.answers, settings.catalogue),
        best,
        rival,
        classes,
        before,
        after,
        shrinkage(before, after) if best is not None and before else None,
        _proposals(weighed, settings, free),
    )


def _rival(
    best: Fit | None,
    ranked: Sequence[Fit],
    classes: Mapping[str, tuple[tuple[str, float], ...]],
) -> Fit | None:
    """Return the wrong-effect control: the next best of which none passes for the best's."""
    if best is None:
        return ranked[0] if ranked else None
    alike = {*best.names, *(name for members in classes.values() for name, _ in members)}
    return next((fit for fit in ranked if not set(fit.names) & alike), None)


def _proposals(
    weighed: WeighedHypotheses[Problem], settings: Settings, free: tuple[Free, ...]
) -> tuple[Proposal, ...]:
    if settings.choices is None:
        return ()
    return proposals(weighed.problem, leading(weighed), settings.choices, free, settings.tolerances)
