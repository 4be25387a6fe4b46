"""A campaign's folder examined: what can be used, the diagnosis, and its controls."""

import math
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np

from analysis.gap.components import GapRun, Stack
from analysis.gap.description import Description, describe
from analysis.gap.diagnose import Diagnosis, diagnose
from analysis.gap.fit import Fit, Problem, at
from analysis.gap.forward import Simulator
from analysis.gap.free import Free, columns, free_numbers
from analysis.gap.gaussian import Nuisances
from analysis.gap.noise import pooled
from analysis.gap.polynomial import polynomial
from analysis.gap.priors import Priors
from analysis.gap.recentre import Recentred, repeating_only
from analysis.gap.regimes import Regime, chosen_regime, regimes
from analysis.gap.verdict import NONE, answer_of
from analysis.gap.withheld import Predicted, gap_of, predict_withheld
from pmm.campaign import Campaign
from pmm.gap.own_effects import chosen_effects, try_own
from pmm.gap.prepare import Prepared, Progress, prepare, shares_of
from sim.effects.effect import Effect

_LIKELIEST: Final = 6  # answers that are asked to foretell


@dataclass(frozen=True)
class Options:
    """How a campaign is examined.

    Attributes
    ----------
    effects
        Names to restrict the catalogue to, and Python files that extend it.
    without
        Names to take out of the catalogue.
    sensors
        Channels to use; all if empty.
    hold_out
        Runs that nobody looks at until the end, as :func:`pmm.gap.hold_out.held_out_runs` says.
    """

    effects: tuple[str, ...] = ()
    without: tuple[str, ...] = ()
    sensors: tuple[str, ...] = ()
    hold_out: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Judged:
    """Withheld runs, predicted by each answer from the same fitting runs.

    Attributes
    ----------
    plain, cured, rival, free_form
        Without an effect, with the best answer, with the wrong-effect control (the second best) and
        with the free polynomial; empty where there is none.
    by_answer
        The gap that each of the likeliest answers leaves of them all, in u, noise taken off.
    chosen
        Whether the user chose the runs, so that nothing was fitted to them.
    """

    plain: tuple[Predicted, ...]
    cured: tuple[Predicted, ...]
    rival: tuple[Predicted, ...]
    free_form: tuple[Predicted, ...]
    by_answer: Mapping[str, float]
    chosen: bool


@dataclass(frozen=True, eq=False)
class Examined:
    """Everything about a campaign."""

    ready: Prepared
    free: tuple[Free, ...]
    diagnosis: Diagnosis
    judged: Judged
    description: Description | None
    catalogue: Mapping[str, type[Effect]]

    @property
    def campaign(self) -> Campaign:
        """The campaign as its file describes it."""
        return self.ready.campaign

    @property
    def left_out(self) -> Mapping[str, str]:
        """Runs that were not used, by name, with the reason."""
        return self.ready.left_out

    @property
    def held_out(self) -> tuple[str, ...]:
        """Names of the runs that the user withheld, and that could be used."""
        return tuple(run.name for run in self.ready.withheld)

    @property
    def recentred(self) -> Recentred:
        """The rig about which the diagnosis went on."""
        return self.ready.there

    @property
    def shares(self) -> Mapping[str, float]:
        """Probabilities of the answers, most probable first."""
        found = shares_of(self.diagnosis, self.recentred)
        return dict(sorted(found.items(), key=lambda pair: -pair[1]))


def examine(
    folder: Path,
    options: Options = Options(),
    executor: Executor | None = None,
    progress: Progress = lambda _: None,
) -> Examined:
    """Examine a campaign.

    Raises
    ------
    ConfigurationError
        If the campaign, the case, an option or an effect of the user's own is wrong.
    DataError
        If fewer than three runs can be used, or a channel is in other units in all of them.
    """
    known, more = chosen_effects(options.effects, options.without)
    ready = prepare(folder, known, more, options.sensors, options.hold_out, progress)
    there, priors = ready.there, ready.case.priors
    try_own(more, there.rig, ready.fitted)
    found = diagnose(there.rig, ready.fitted, ready.settings, executor, progress)
    progress("predicting withheld runs")
    free = free_numbers(there.rig, priors)
    judgement = _judged(found, ready.fitted, ready.withheld, free, priors)
    described = describe(found.problem, found.left)
    return Examined(ready, free, found, judgement, described, known)


def _judged(
    found: Diagnosis,
    fitted: Sequence[GapRun],
    withheld: Sequence[GapRun],
    free: Sequence[Free],
    priors: Priors,
) -> Judged:
    if not withheld:
        every = regimes(found.problem.simulator.stack.runs)
        fits = [None if one is None else one.fit for one in (found.best, found.rival)]
        by_answer = _left_by(_likeliest(found), found.problem, every)
        free_form = polynomial(found.problem)
        return _predicted(found.problem, fits, every, free_form, by_answer, chosen=False)
    joint = _joint(found.problem, fitted, withheld, free, priors)
    regime = chosen_regime(joint.simulator.stack.runs, [run.name for run in withheld])
    ones = [Regime("run", joint.simulator.stack.runs[at_].name, (at_,)) for at_ in regime.runs]
    kept = ~np.isin(joint.simulator.stack.run, regime.runs)
    leading = [None if one is None else one.fit for one in (found.best, found.rival)]
    asked = _likeliest(found) | {answer_of(one): one for one in leading if one is not None}
    there = {name: at(joint, one.candidates, one.units) for name, one in asked.items()}
    fits = [None if one is None else there[answer_of(one)] for one in leading]
    by_answer = _left_by(there, joint, [regime])
    whole = _predicted(joint, fits, [regime], polynomial(joint, kept), by_answer, chosen=True)
    return _by_run(whole, joint, ones)


def _likeliest(found: Diagnosis) -> dict[str, Fit]:
    """Return the likeliest named answers."""
    shares = found.probabilities.by_answer
    fits = {answer_of(one.fit): one.fit for one in (*found.weighed.singles, *found.weighed.pairs)}
    return {name: fits[name] for name in sorted(fits, key=lambda one: -shares[one])[:_LIKELIEST]}


def _left_by(
    fits: Mapping[str, Fit], problem: Problem, withheld: Sequence[Regime]
) -> dict[str, float]:
    """Return the gap that each answer leaves of what is withheld; NaN where nothing is."""
    found = {}
    for name, fit in {NONE: None, **fits}.items():
        left = [one.left for one in predict_withheld(problem, fit, withheld)]
        found[name] = gap_of(np.concatenate(left)) if left else math.nan
    return found


def _joint(
    problem: Problem,
    fitted: Sequence[GapRun],
    withheld: Sequence[GapRun],
    free: Sequence[Free],
    priors: Priors,
) -> Problem:
    """Return the problem over fitting and withheld runs, of what repeats with the shaft."""
    runs = [repeating_only(run) for run in pooled([*fitted, *withheld], problem.simulator.rig)]
    old = problem.simulator
    simulator = Simulator(old.rig, Stack.of(runs), old.on, old.reference_channel)
    return Problem(simulator, Nuisances(columns(simulator, free, priors)), problem.free)


def _predicted(
    problem: Problem,
    fits: Sequence[Fit | None],
    withheld: Sequence[Regime],
    control: Fit,
    by_answer: Mapping[str, float],
    *,
    chosen: bool,
) -> Judged:
    best, rival = fits
    return Judged(
        predict_withheld(problem, None, withheld),
        () if best is None else predict_withheld(problem, best, withheld),
        () if rival is None else predict_withheld(problem, rival, withheld),
        predict_withheld(problem, control, withheld),
        by_answer,
        chosen,
    )


def _by_run(whole: Judged, problem: Problem, runs: Sequence[Regime]) -> Judged:
    """Take the withheld runs apart, each with what the fitting runs predict of it."""

    def apart(found: tuple[Predicted, ...]) -> tuple[Predicted, ...]:
        return tuple(
            replace(one, regime=run, rows=own, left=one.left[own[one.rows]])
            for one in found
            for run in runs
            for own in [one.rows & np.isin(problem.simulator.stack.run, run.runs)]
        )

    return Judged(
        apart(whole.plain),
        apart(whole.cured),
        apart(whole.rival),
        apart(whole.free_form),
        whole.by_answer,
        whole.chosen,
    )
