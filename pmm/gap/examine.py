"""A campaign's folder examined: what can be used, the diagnosis, and its controls."""

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from analysis.gap.components import GapRun, Stack
from analysis.gap.description import Description, describe
from analysis.gap.diagnose import Diagnosis, Settings, diagnose
from analysis.gap.fit import Fit, Problem, at
from analysis.gap.forward import Simulator
from analysis.gap.free import Free, columns, free_numbers
from analysis.gap.gaussian import Nuisances
from analysis.gap.noise import pooled
from analysis.gap.polynomial import polynomial
from analysis.gap.priors import Priors
from analysis.gap.quality import doubts, judged
from analysis.gap.recentre import Recentred, repeating_only
from analysis.gap.regimes import Regime, chosen_regime, regimes
from analysis.gap.withheld import Predicted, predict_withheld
from hardware.description.errors import ConfigurationError, DataError
from pmm.campaign import CAMPAIGN_FILE, Campaign
from pmm.campaign_file import read_campaign
from pmm.gap.case import Case, read_case
from pmm.gap.hold_out import held_out_runs
from pmm.gap.load import Loaded, load_campaign
from sim.effects.catalogue import catalogue, find, user_effects
from sim.effects.effect import Effect

_FEWEST = 3  # runs

Progress = Callable[[str], None]


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
    chosen
        Whether the user chose the runs, so that nothing was fitted to them.
    """

    plain: tuple[Predicted, ...]
    cured: tuple[Predicted, ...]
    rival: tuple[Predicted, ...]
    free_form: tuple[Predicted, ...]
    chosen: bool


@dataclass(frozen=True, eq=False)
class Examined:
    """Everything about a campaign.

    Attributes
    ----------
    left_out
        Runs that were not used, by name, with the reason.
    held_out
        Names of the runs that the user withheld.
    """

    folder: Path
    campaign: Campaign
    left_out: Mapping[str, str]
    held_out: tuple[str, ...]
    recentred: Recentred
    free: tuple[Free, ...]
    diagnosis: Diagnosis
    judged: Judged
    description: Description | None
    catalogue: Mapping[str, type[Effect]]


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
        If the campaign, the case or an option is wrong.
    DataError
        If fewer than three runs can be used, or a channel is in other units in all of them.
    """
    file = folder / CAMPAIGN_FILE if folder.is_dir() else folder
    folder = file.parent
    known, more = chosen_effects(options)
    campaign, case = read_campaign(file), read_case(folder)
    held_out = held_out_runs(campaign, options.hold_out)
    on = campaign.effects_on(more)
    progress("reading")
    loaded = load_campaign(file, (), lambda name: progress(f"reading {name}"), options.sensors)
    there, fitted, withheld, left_out = _sorted(loaded, case, on, held_out, file)
    if len(fitted) < _FEWEST:
        why = "".join(f"; {name}: {reason}" for name, reason in left_out.items())
        raise DataError(f"{file}: {len(fitted)} runs to fit, a diagnosis needs {_FEWEST}{why}")
    settings = Settings(
        known,
        case.priors,
        on=on,
        choices=case.choices(campaign),
        reference_channel=loaded.reference_channel,
    )
    found = diagnose(there.rig, fitted, settings, executor, progress)
    progress("predicting withheld runs")
    free = free_numbers(there.rig, case.priors)
    judgement = _judged(found, fitted, withheld, free, case.priors)
    residual = found.problem.residual
    if found.best is not None:
        residual = residual - found.best.fit.signature
    described = describe(found.problem, residual)
    return Examined(
        folder, campaign, left_out, held_out, there, free, found, judgement, described, known
    )


def chosen_effects(options: Options) -> tuple[dict[str, type[Effect]], dict[str, type[Effect]]]:
    """Return the effects to consider, and those of the user's own files.

    Raises
    ------
    ConfigurationError
        If a name is not known or a file defines none.
    """
    more: dict[str, type[Effect]] = {}
    for one in options.effects:
        if one.endswith(".py"):
            more |= user_effects(one)
    names = [one for one in options.effects if not one.endswith(".py")]
    every = {**catalogue(), **more}
    chosen = {name: find(name, more) for name in names} | more if names else every
    for name in options.without:
        find(name, more)
    left = {name: kind for name, kind in chosen.items() if name not in options.without}
    if not left:
        raise ConfigurationError("--effects and --without leave no effect to consider")
    return left, more


def _sorted(
    loaded: Loaded, case: Case, on: Sequence[Effect], held_out: Sequence[str], file: Path
) -> tuple[Recentred, list[GapRun], list[GapRun], dict[str, str]]:
    """Return the rig to begin with, the runs to fit and those withheld, and what is left out."""
    fitted = [run for run in loaded.runs if run.name not in held_out]
    withheld = [run for run in loaded.runs if run.name in held_out]
    reference = loaded.reference_channel
    there, found = judged(loaded.rig, fitted, case.priors, on, reference)
    if withheld:
        names = {run.name for run in withheld}
        every = doubts(there.rig, loaded.runs, on, reference)
        found = (*found, *(one for one in every if one.run in names))
    for one in found:
        if not one.run:
            raise DataError(f"{file}: {one.channel}: {one.reason}")
    bad = {one.run: f"{one.channel}: {one.reason}".removeprefix(": ") for one in found}
    return (
        there,
        [run for run in fitted if run.name not in bad],
        [run for run in withheld if run.name not in bad],
        {**loaded.left_out, **bad},
    )


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
        return _predicted(found.problem, fits, every, polynomial(found.problem), chosen=False)
    joint = _joint(found.problem, fitted, withheld, free, priors)
    regime = chosen_regime(joint.simulator.stack.runs, [run.name for run in withheld])
    ones = [Regime("run", joint.simulator.stack.runs[at_].name, (at_,)) for at_ in regime.runs]
    kept = ~np.isin(joint.simulator.stack.run, regime.runs)
    fits = [
        None if one is None else at(joint, one.fit.candidates, one.fit.units)
        for one in (found.best, found.rival)
    ]
    whole = _predicted(joint, fits, [regime], polynomial(joint, kept), chosen=True)
    return _by_run(whole, joint, ones)


def _joint(
    problem: Problem,
    fitted: Sequence[GapRun],
    withheld: Sequence[GapRun],
    free: Sequence[Free],
    priors: Priors,
) -> Problem:
    """Return the problem over fitting and withheld runs, of what repeats with the shaft."""
    runs = [repeating_only(run) for run in pooled([*fitted, *withheld])]
    old = problem.simulator
    simulator = Simulator(old.rig, Stack.of(runs), old.on, old.reference_channel)
    return Problem(simulator, Nuisances(columns(simulator, free, priors)), problem.free)


def _predicted(
    problem: Problem,
    fits: Sequence[Fit | None],
    withheld: Sequence[Regime],
    control: Fit,
    *,
    chosen: bool,
) -> Judged:
    best, rival = fits
    return Judged(
        predict_withheld(problem, None, withheld),
        () if best is None else predict_withheld(problem, best, withheld),
        () if rival is None else predict_withheld(problem, rival, withheld),
        predict_withheld(problem, control, withheld),
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
        whole.chosen,
    )
