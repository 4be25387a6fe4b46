"""From a pendulum's file to its diagnosis, effects of the user's own among the causes."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from analysis.gap.pendulum.causes import Cause, cause, causes_for
from analysis.gap.pendulum.diagnose import Diagnosis, diagnose_trials
from analysis.gap.pendulum.search import MOST_CAUSES
from analysis.gap.pendulum.trial import Trial
from analysis.inertia.numeric import FloatArray
from hardware.description.errors import ConfigurationError
from pmm.gap.own_effects import chosen_of_pendulums, tried
from pmm.gap.pendulum import problem_of, read_case


@dataclass(frozen=True)
class Options:
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
class Examined:
    """A diagnosis, and which of the effects that were asked for these records cannot show."""

    diagnosis: Diagnosis
    hidden: tuple[str, ...]

    @property
    def notes(self) -> tuple[str, ...]:
        """What has to be known besides."""
        names = ", ".join(self.hidden)
        return (f"these records cannot show {names}",) if names else ()


def examine_pendulum(
    path: Path, options: Options, progress: Callable[[str], None] = lambda _: None
) -> Examined:
    """Read a file with its records and diagnose it.

    Raises
    ------
    ConfigurationError
        If the file, an option or an effect of the user's own is wrong.
    DataError
        If a record is.
    """
    kinds, more = chosen_of_pendulums(options.effects, options.without)
    case = read_case(path)
    problem = problem_of(case, path)
    first = problem.trials[0]
    for name, kind in more.items():
        tried(name, f"record {first.name}", partial(_typical, first, cause(kind)))
    causes = causes_for(problem.trials, kinds.values())
    shown = {one.name for one in causes}
    hidden = tuple(name for name in kinds if name not in shown) if options.effects else ()
    if not causes:
        raise ConfigurationError(f"--effects: these records cannot show {', '.join(hidden)}")
    found = diagnose_trials(problem, causes, most=options.most, reach=case.reach, progress=progress)
    return Examined(found, hidden)


def _typical(trial: Trial, one: Cause) -> FloatArray:
    return trial.simulate([one.effect(one.start, trial)])
