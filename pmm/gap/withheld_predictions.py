"""Runs that nobody looked at, or each regime in turn, predicted by the likeliest answers."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from analysis.gap.forward.free_numbers import Free, tolerated
from analysis.gap.forward.noise import pooled
from analysis.gap.forward.problem import Problem
from analysis.gap.forward.simulator import Simulator
from analysis.gap.forward.tolerances import Tolerances
from analysis.gap.inference.answers import NONE
from analysis.gap.judge.diagnosis import Diagnosis
from analysis.gap.judge.withheld import Predicted, gap_of, predict_withheld
from analysis.gap.observe.components import GapRun, Stack
from analysis.gap.observe.regimes import Regime, chosen_regime, regimes
from analysis.gap.quality.recentring import repeating_only
from analysis.gap.search.fit import Fit, linearised_at
from analysis.gap.search.polynomial import polynomial

_LIKELIEST: Final = 6  # answers that are asked to foretell


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


def predicted_withheld(
    diagnosis: Diagnosis,
    fitted: Sequence[GapRun],
    withheld: Sequence[GapRun],
    free: Sequence[Free],
    tolerances: Tolerances,
) -> WithheldPredictions:
    """Return what the likeliest answers predict of the withheld runs, or of each regime without."""
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
