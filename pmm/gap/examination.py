"""A campaign's folder examined: what can be used, the diagnosis, and its controls."""

import math
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Final

import numpy as np

from analysis.gap.forward.free_numbers import Free, tolerated
from analysis.gap.forward.noise import pooled
from analysis.gap.forward.problem import Problem
from analysis.gap.forward.simulator import Simulator
from analysis.gap.forward.tolerances import Tolerances
from analysis.gap.inference.answers import NONE
from analysis.gap.judge.description import Description, describe
from analysis.gap.judge.diagnosis import Diagnosis, diagnose
from analysis.gap.judge.marginal import Marginal, marginals
from analysis.gap.judge.withheld import Predicted, gap_of, predict_withheld, shrinkage
from analysis.gap.observe.components import GapRun, Stack
from analysis.gap.observe.regimes import Regime, chosen_regime, regimes
from analysis.gap.quality.recentring import Recentred, repeating_only
from analysis.gap.search.fit import Fit, linearised_at
from analysis.gap.search.polynomial import polynomial
from hardware.description.arrays import FloatArray
from hardware.description.setpoint import SetPoint
from pmm.campaign.campaign import Campaign
from pmm.gap.conclusion import EFFECT, Conclusion, Weighing, verdict_of
from pmm.gap.own_effects import chosen_effects, try_own
from pmm.gap.preparation import PreparedCampaign, Progress, prepare
from pmm.gap.steps import remains, walk_rows
from sim.effects.catalogue import catalogue
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
    runs
        What may be proposed, in place of what case or oscillator says; none for that.
    """

    effects: tuple[str, ...] = ()
    without: tuple[str, ...] = ()
    sensors: tuple[str, ...] = ()
    hold_out: tuple[str, ...] = ()
    runs: tuple[SetPoint, ...] = ()


@dataclass(frozen=True, eq=False)
class WithheldPredictions:
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
    """Everything about a campaign.

    Attributes
    ----------
    effects
        Those that are not out of the question, whatever else is there too.
    """

    ready: PreparedCampaign
    free: tuple[Free, ...]
    diagnosis: Diagnosis
    judged: WithheldPredictions
    effects: tuple[Marginal, ...]
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
        return self.ready.recentred

    @property
    def shares(self) -> Mapping[str, float]:
        """Probabilities of the answers, most probable first."""
        return dict(sorted(self.diagnosis.answers.by_answer.items(), key=lambda pair: -pair[1]))

    @cached_property
    def conclusion(self) -> Conclusion:
        """What all of it comes to: whoever says something of this campaign says it from here."""
        problem, weighing = self.diagnosis.problem, self._weighing()
        steps, verdict = walk_rows(self.diagnosis.walk), verdict_of(weighing)
        residual = problem.residual - self._explained(verdict)
        return Conclusion(verdict, weighing, steps, tuple(remains(problem, residual)))

    @property
    def cause(self) -> Fit | None:
        """The effect that the answer names, as fitted; ``None`` where it names none."""
        return self.diagnosis.cause

    @property
    def remainder(self) -> FloatArray:
        """What the answer leaves of the whitened difference, shape ``(observations,)``."""
        return self.diagnosis.problem.residual - self._explained(self.conclusion.verdict)

    @cached_property
    def description(self) -> Description | None:
        """The form of what is left, if it is more than noise."""
        return describe(self.diagnosis.problem, self.remainder)

    def _explained(self, verdict: str) -> FloatArray:
        best = self.diagnosis.best
        if best is None or verdict != EFFECT:
            return np.zeros_like(self.diagnosis.problem.residual)
        return best.signature

    def _weighing(self) -> Weighing:
        diagnosis, judged = self.diagnosis, self.judged
        best = "" if diagnosis.best is None else diagnosis.best.answer
        is_foretold, odd = bool(judged.plain and judged.cured), diagnosis.answers.odd_runs
        return Weighing(
            self.shares,
            best,
            {
                effect: tuple(sorted(name for name, _ in twins))
                for effect, twins in diagnosis.classes.items()
            },
            {kind.name: kind.title for kind in self.catalogue.values()},
            shrinkage(judged.plain, judged.cured).share if is_foretold else math.nan,
            max(diagnosis.stages, key=lambda name: diagnosis.stages[name], default=""),
            max(odd, key=lambda name: odd[name], default=""),
            None if catalogue().keys() <= self.catalogue.keys() else len(self.catalogue),
        )


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
    kinds, more = chosen_effects(options.effects, options.without)
    ready = prepare(folder, kinds, more, options.sensors, options.hold_out, progress)
    if options.runs and ready.settings.choices is not None:
        choices = replace(ready.settings.choices, runs=options.runs)
        ready = replace(ready, settings=replace(ready.settings, choices=choices))
    recentred, tolerances = ready.recentred, ready.case.tolerances
    try_own(more, recentred.rig, ready.fitted)
    diagnosis = diagnose(recentred.rig, ready.fitted, ready.settings, executor, progress)
    progress("predicting withheld runs")
    free = recentred.free
    judgement = _judged(diagnosis, ready.fitted, ready.withheld, free, tolerances)
    return Examined(ready, free, diagnosis, judgement, marginals(diagnosis), kinds)


def _judged(
    diagnosis: Diagnosis,
    fitted: Sequence[GapRun],
    withheld: Sequence[GapRun],
    free: Sequence[Free],
    tolerances: Tolerances,
) -> WithheldPredictions:
    asked: dict[str, Fit | None] = {NONE: None, **_likeliest(diagnosis)}
    if not withheld:
        problem = diagnosis.problem
        all_regimes = regimes(problem.simulator.stack.runs)
        return _foretold(diagnosis, problem, asked, all_regimes, polynomial(problem), chosen=False)
    joint = _joint(diagnosis.problem, fitted, withheld, free, tolerances)
    regime = chosen_regime(joint.simulator.stack.runs, [run.name for run in withheld])
    run_regimes = [
        Regime("run", joint.simulator.stack.runs[at_].name, (at_,)) for at_ in regime.runs
    ]
    fitted_rows = ~np.isin(joint.simulator.stack.run, regime.runs)
    fits = {
        name: None if fit is None else linearised_at(joint, fit.candidates, fit.units)
        for name, fit in asked.items()
    }
    judgement = _foretold(
        diagnosis, joint, fits, [regime], polynomial(joint, fitted_rows), chosen=True
    )
    return _by_run(judgement, joint, run_regimes)


def _likeliest(diagnosis: Diagnosis) -> dict[str, Fit]:
    """Return the likeliest named answers, and the control."""
    likeliest = diagnosis.weighed.ranked[:_LIKELIEST]
    fits = (*likeliest, *(fit for fit in (diagnosis.best, diagnosis.rival) if fit is not None))
    return {fit.answer: fit for fit in fits}


def _joint(
    problem: Problem,
    fitted: Sequence[GapRun],
    withheld: Sequence[GapRun],
    free: Sequence[Free],
    tolerances: Tolerances,
) -> Problem:
    """Return the problem over fitting and withheld runs, of what repeats with the shaft."""
    runs = [
        repeating_only(run)
        for run in pooled([*fitted, *withheld], problem.simulator.rig, tolerances)
    ]
    old = problem.simulator
    simulator = Simulator(old.rig, Stack.of(runs), old.active_effects, old.reference_channel)
    return Problem(simulator, tolerated(simulator, free, tolerances))


def _foretold(
    diagnosis: Diagnosis,
    problem: Problem,
    asked: Mapping[str, Fit | None],
    withheld: Sequence[Regime],
    control: Fit,
    *,
    chosen: bool,
) -> WithheldPredictions:
    """Ask answers, by name, for what is withheld."""
    predictions = {name: predict_withheld(problem, fit, withheld) for name, fit in asked.items()}
    best, rival = (
        () if fit is None else predictions[fit.answer] for fit in (diagnosis.best, diagnosis.rival)
    )
    free_form = predict_withheld(problem, control, withheld)
    by_answer = {name: _gap(predicted) for name, predicted in predictions.items()}
    return WithheldPredictions(predictions[NONE], best, rival, free_form, by_answer, chosen)


def _gap(predicted: Sequence[Predicted]) -> float:
    """Return the gap over all that was foretold; NaN where nothing was."""
    residuals = [prediction.remainder for prediction in predicted]
    return gap_of(np.concatenate(residuals)) if residuals else math.nan


def _by_run(
    judged: WithheldPredictions, problem: Problem, runs: Sequence[Regime]
) -> WithheldPredictions:
    """Take the withheld runs apart, each with what the fitting runs predict of it."""

    def split_by_run(predictions: tuple[Predicted, ...]) -> tuple[Predicted, ...]:
        return tuple(
            replace(
                prediction,
                regime=run,
                rows=rows,
                remainder=prediction.remainder[rows[prediction.rows]],
            )
            for prediction in predictions
            for run in runs
            for rows in [prediction.rows & np.isin(problem.simulator.stack.run, run.runs)]
        )

    return WithheldPredictions(
        split_by_run(judged.plain),
        split_by_run(judged.cured),
        split_by_run(judged.rival),
        split_by_run(judged.free_form),
        judged.by_answer,
        judged.chosen,
    )
