"""A campaign's folder examined: what can be used, the diagnosis, and its controls."""

import math
from collections.abc import Mapping
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from analysis.gap.forward.free_numbers import Free
from analysis.gap.judge.description import Description, describe
from analysis.gap.judge.diagnosis import Diagnosis, diagnose
from analysis.gap.judge.marginal import Marginal, marginals
from analysis.gap.judge.withheld import shrinkage
from analysis.gap.quality.recentring import Recentred
from analysis.gap.search.fit import Fit
from hardware.description.arrays import FloatArray
from hardware.description.setpoint import SetPoint
from pmm.campaign.campaign import Campaign
from pmm.gap.conclusion import EFFECT, Conclusion, Weighing, verdict_of
from pmm.gap.own_effects import chosen_effects, try_own
from pmm.gap.preparation import PreparedCampaign, Progress, prepare
from pmm.gap.steps import remains, walk_rows
from pmm.gap.withheld_predictions import WithheldPredictions, predicted_withheld
from sim.effects.catalogue import catalogue
from sim.effects.effect import Effect


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
    proposes
        Whether the next run is sought too: a fifth of the time.
    batch
        Runs that are to be made before the next look: those proposed tell most together.
    """

    effects: tuple[str, ...] = ()
    without: tuple[str, ...] = ()
    sensors: tuple[str, ...] = ()
    hold_out: tuple[str, ...] = ()
    runs: tuple[SetPoint, ...] = ()
    proposes: bool = True
    batch: int = 1


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
    choices = ready.settings.choices if options.proposes else None
    if choices is not None:
        choices = replace(choices, runs=options.runs or choices.runs, batch=options.batch)
    ready = replace(ready, settings=replace(ready.settings, choices=choices))
    recentred, tolerances = ready.recentred, ready.case.tolerances
    try_own(more, recentred.rig, ready.fitted)
    diagnosis = diagnose(recentred.rig, ready.fitted, ready.settings, executor, progress)
    progress("predicting withheld runs")
    free = recentred.free
    judgement = predicted_withheld(diagnosis, ready.fitted, ready.withheld, free, tolerances)
    return Examined(ready, free, diagnosis, judgement, marginals(diagnosis), kinds)
