"""The whole diagnosis of a campaign: where, which, how far, unknown, next."""

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field, replace

from analysis.gap.components import GapRun, Part, Stack
from analysis.gap.fit import Fit, Problem
from analysis.gap.forward import Simulator
from analysis.gap.free import Free, columns, free_numbers
from analysis.gap.gaussian import Nuisances
from analysis.gap.hypotheses import Named, Odds, Weighed, weigh
from analysis.gap.leading import leading
from analysis.gap.noise import pooled
from analysis.gap.priors import Priors
from analysis.gap.propose import Choices, Proposal, proposals
from analysis.gap.regimes import Regime, regimes
from analysis.gap.verdict import (
    COEFFICIENTS,
    NONE,
    UNKNOWN,
    Probabilities,
    answer_of,
    coefficient_shift,
    equivalents,
    passed_on,
    probabilities,
    ranked,
    stage_probabilities,
)
from analysis.gap.whence import unknown_stages
from analysis.gap.where import Walk, walk
from analysis.gap.withheld import Predicted, Shrinkage, foretells, predict_withheld, shrinkage
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError
from sim.effects.a5_trigger_jitter import TriggerJitter
from sim.effects.effect import Effect
from sim.rig import SimulatedRig

SHIFTED = 3.0  # prior deviations by which a coefficient has to be off to be the answer
_NAMED = 0.01  # probability below which it does not matter whether a name foretells


@dataclass(frozen=True)
class Settings:
    """How a campaign is diagnosed.

    Attributes
    ----------
    catalogue
        Effects to consider, by name.
    on
        Effects that are known already and always on.
    withheld
        Regimes to judge by; found from the runs if empty.
    choices
        What the rig can do next; ``None`` proposes nothing.
    """

    catalogue: Mapping[str, type[Effect]]
    priors: Priors = field(default_factory=Priors)
    odds: Odds = field(default_factory=Odds)
    on: tuple[Effect, ...] = ()
    withheld: tuple[Regime, ...] = ()
    choices: Choices | None = None
    reference_channel: str | None = None


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
    shift
        Prior deviations by which each coefficient and setting moves.
    before, after
        Withheld runs predicted without and with the best hypothesis.
    not_foretold
        Answers that explain what they are fitted to, but do not predict withheld runs: they count
        as "unknown".
    """

    problem: Problem
    walk: Walk
    weighed: Weighed
    probabilities: Probabilities
    stages: Mapping[str, float]
    best: Named | None
    rival: Named | None
    classes: Mapping[str, tuple[tuple[str, float], ...]]
    shift: Mapping[str, float]
    before: tuple[Predicted, ...]
    after: tuple[Predicted, ...]
    shrinkage: Shrinkage | None
    rival_shrinkage: Shrinkage | None
    proposals: tuple[Proposal, ...]
    not_foretold: tuple[str, ...] = ()

    @property
    def cause(self) -> Fit | None:
        """What the answer names as the cause; ``None`` where it names none, or says "unknown"."""
        if self.best is None or self.probabilities.best == UNKNOWN:
            return None
        return self.best.fit


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
        At least three, observed by :func:`analysis.gap.observe.observe`.

    Raises
    ------
    DataError
        If there are fewer than three runs.
    ConfigurationError
        If the rig cannot run what was recorded.
    """
    if len(runs) < 3:
        raise DataError(f"{len(runs)} runs: a diagnosis needs 3 or more")
    free = free_numbers(rig, settings.priors)
    problem = problem_of(rig, runs, settings, free)
    progress("walking along the chain")
    walked = walk(problem)
    weighed = weigh(problem, settings.catalogue, executor, settings.odds, progress, free)
    found = _with_coefficients(probabilities(weighed), problem, free)
    done = _concluded(problem, walked, weighed, found, settings, free, progress)
    return refuted(done, _not_foretelling(done, settings), settings.catalogue)


def problem_of(
    rig: SimulatedRig, runs: Sequence[GapRun], settings: Settings, free: tuple[Free, ...]
) -> Problem:
    """Return what every hypothesis about a campaign is held against."""
    stack = Stack.of(pooled(runs, rig))
    on = (*settings.on, *_always(rig, stack, settings.priors))
    simulator = Simulator(rig, stack, on, settings.reference_channel)
    nuisances = Nuisances(columns(simulator, free, settings.priors))
    return Problem(simulator, nuisances, tuple(one.name for one in free))


def _always(rig: SimulatedRig, stack: Stack, priors: Priors) -> tuple[Effect, ...]:
    """Return what every photocell has: pulses that scatter a little; an encoder's turns do not."""
    pulsed = any(one.part in (Part.PULSES, Part.PERIOD_SCATTER) for one in stack.components)
    if rig.photocell is None or not pulsed or not priors.pulse_scatter_rad:
        return ()
    return (TriggerJitter(priors.pulse_scatter_rad),)


def _with_coefficients(
    found: Probabilities, problem: Problem, free: Sequence[Free]
) -> Probabilities:
    """Say "coefficients" in place of "none" where they are what differs."""
    shift = coefficient_shift(problem, problem.residual)
    off = [abs(shift[one.name]) for one in free if one.is_coefficient]
    share = max(off, default=0.0) / SHIFTED
    moved = found.by_answer[NONE] * min(1.0, share**4 / (1.0 + share**4) if share else 0.0)
    answers = {**found.by_answer, NONE: found.by_answer[NONE] - moved, COEFFICIENTS: moved}
    return Probabilities(answers)


def refuted(
    done: Diagnosis, names: Sequence[str], catalogue: Mapping[str, type[Effect]]
) -> Diagnosis:
    """Return a diagnosis in which answers that foretell too little count as "unknown"."""
    if not names:
        return done
    found = passed_on(done.probabilities, names)
    unknown = unknown_stages(done.problem, done.walk, done.weighed, catalogue)
    return replace(
        done,
        probabilities=found,
        stages=stage_probabilities(found, catalogue, unknown),
        not_foretold=(*done.not_foretold, *names),
    )


def _not_foretelling(done: Diagnosis, settings: Settings) -> tuple[str, ...]:
    """Return the most probable names, down to the first that foretells regimes from the others."""
    shares, names = done.probabilities.by_answer, []
    withheld = settings.withheld or regimes(done.problem.simulator.stack.runs)
    for one in ranked(done.weighed, done.probabilities) if done.best is not None else ():
        known = done.after if one is done.best else None
        after = known or predict_withheld(done.problem, one.fit, withheld)
        if shares[answer_of(one.fit)] < _NAMED or foretells(done.before, after):
            break
        names.append(answer_of(one.fit))
    return tuple(names)


def _concluded(
    problem: Problem,
    walked: Walk,
    weighed: Weighed,
    found: Probabilities,
    settings: Settings,
    free: tuple[Free, ...],
    progress: Callable[[str], None],
) -> Diagnosis:
    fits = [one.fit for one in weighed.looked if one.fit is not None]
    ones = ranked(weighed, found)
    best = ones[0] if ones and _names(found) else None
    classes = {} if best is None else equivalents(problem, best.fit, fits)
    rival = _rival(best, ones, classes)
    withheld = settings.withheld or regimes(problem.simulator.stack.runs)
    before = predict_withheld(problem, None, withheld)
    after = before if best is None else predict_withheld(problem, best.fit, withheld)
    other = before if rival is None else predict_withheld(problem, rival.fit, withheld)
    named = best is not None and bool(before)
    progress("choosing the next run")
    return Diagnosis(
        problem,
        walked,
        weighed,
        found,
        stage_probabilities(
            found, settings.catalogue, unknown_stages(problem, walked, weighed, settings.catalogue)
        ),
        best,
        rival,
        classes,
        coefficient_shift(problem, _explained(problem, best)),
        before,
        after,
        shrinkage(before, after) if named else None,
        shrinkage(before, other) if named and rival is not None else None,
        _next(problem, weighed, found, settings, free),
    )


def _explained(problem: Problem, best: Named | None) -> FloatArray:
    return problem.residual if best is None else problem.residual - best.fit.signature


def _names(found: Probabilities) -> bool:
    """Tell whether naming an effect is right, be it beside "unknown"."""
    return found.best not in (NONE, COEFFICIENTS)


def _rival(
    best: Named | None,
    ones: Sequence[Named],
    classes: Mapping[str, tuple[tuple[str, float], ...]],
) -> Named | None:
    """Return the wrong-effect control: the next best of which none passes for the best's."""
    if best is None:
        return ones[0] if ones else None
    alike = {*best.fit.names, *(name for own in classes.values() for name, _ in own)}
    return next((one for one in ones if not set(one.fit.names) & alike), None)


def _next(
    problem: Problem,
    weighed: Weighed,
    found: Probabilities,
    settings: Settings,
    free: tuple[Free, ...],
) -> tuple[Proposal, ...]:
    if settings.choices is None:
        return ()
    ones = leading(weighed, found)
    return proposals(problem, ones, settings.choices, free, settings.priors)
