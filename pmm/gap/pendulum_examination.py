"""From a pendulum's file to its diagnosis, effects of the user's own among the causes."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

from analysis.gap.forward.candidate import Candidate
from analysis.gap.pendulum.causes import cause, causes_for
from analysis.gap.pendulum.diagnose import PendulumDiagnosis, diagnose_trials
from analysis.gap.pendulum.problem import PendulumProblem
from analysis.gap.pendulum.search import MOST_CAUSES, fit
from analysis.gap.pendulum.settle import Settled, settle
from analysis.gap.pendulum.trial import Trial
from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError, DataError
from pmm.gap.own_effects import chosen_of_pendulums, files_among, try_effect
from pmm.gap.pendulum import problem_of
from pmm.gap.pendulum_file import PendulumCase, read_case
from pmm.gap.pendulum_notes import notes


@dataclass(frozen=True)
class PendulumOptions:
    """What is asked for.

    Attributes
    ----------
    effects
        Names of the effects to consider, and files with effects of the user's own.
    without
        Effects that are not considered.
    most
        How many causes may act together.
    """

    effects: tuple[str, ...] = ()
    without: tuple[str, ...] = ()
    most: int = MOST_CAUSES


@dataclass(frozen=True, eq=False)
class ExaminedPendulum:
    """A diagnosis, and which of the effects that were asked for these records cannot show."""

    diagnosis: PendulumDiagnosis
    hidden: tuple[str, ...]

    @property
    def notes(self) -> tuple[str, ...]:
        """What has to be known besides."""
        on = [effect.name for effect in self.diagnosis.problem.trials[0].effects]
        said = [f"the simulation has {', '.join(on)} on"] if on else []
        if self.hidden:
            said.append(f"these records cannot show {', '.join(self.hidden)}")
        return (*said, *notes(self.diagnosis))


def examine_pendulum(
    path: Path, options: PendulumOptions, progress: Callable[[str], None] = lambda _: None
) -> ExaminedPendulum:
    """Read a file with its records and diagnose it.

    Raises
    ------
    ConfigurationError
        If the file, an option or an effect of the user's own is wrong.
    DataError
        If a record is.
    """
    case = read_case(path)
    problem, kinds = _prepared(case, path, options)
    causes = causes_for(problem.trials, kinds.values())
    shown = {candidate.kind.name for candidate in causes}
    hidden = tuple(name for name in kinds if name not in shown) if options.effects else ()
    if not causes:
        raise ConfigurationError(f"--effects: these records cannot show {', '.join(hidden)}")
    diagnosis = diagnose_trials(
        problem, causes, most=options.most, reach=case.reach, progress=progress
    )
    return ExaminedPendulum(diagnosis, hidden)


def fitted_causes(path: Path, names: Sequence[str], options: PendulumOptions) -> Settled:
    """Fit some causes together, whatever others there may be.

    Raises
    ------
    ConfigurationError, DataError
        As :func:`examine_pendulum`; also if the records cannot show one of the causes.
    """
    wanted = (*names, *files_among(options.effects))
    problem, kinds = _prepared(read_case(path), path, replace(options, effects=wanted))
    causes = {candidate.name: candidate for candidate in causes_for(problem.trials, kinds.values())}
    missing = [name for name in names if name not in causes]
    if missing:
        raise DataError(f"{path.stem}: these records cannot show {', '.join(missing)}")
    return settle(problem, fit(problem, [causes[name] for name in names]))


def _prepared(
    case: PendulumCase, path: Path, options: PendulumOptions
) -> tuple[PendulumProblem, dict[str, type[Any]]]:
    """Return the records, and the effects to consider; the user's own have been tried."""
    kinds, more = chosen_of_pendulums(options.effects, options.without)
    problem = problem_of(case, path, more)
    first = problem.trials[0]
    for name, kind in more.items():
        try_effect(name, f"record {first.name}", partial(_typical, first, cause(kind)))
    return problem, kinds


def _typical(trial: Trial, candidate: Candidate) -> FloatArray:
    return trial.simulate([candidate.effect(candidate.start)])
