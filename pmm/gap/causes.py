"""The cause of a gap that is to be known: what is known of it, and which runs are left to make.

The diagnosis itself is elsewhere: whoever keeps a loop's time does not even import it.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Final, Protocol

from hardware.description.errors import DataError
from hardware.description.setpoint import SetPoint
from pmm.plan.run_plan import RunPlan
from pmm.sequential.look import Ending, KnownCause, Look

SURE: Final = 0.95
LEAST: Final = 1.0  # log odds that a run is worth making for


@dataclass(frozen=True)
class Suggestion:
    """A run that a rig could make by itself, and what it is worth.

    Attributes
    ----------
    gain
        Log odds that the right one of the leading answers is expected to gain.
    between
        Those answers, by name.
    """

    set_point: SetPoint
    gain: float
    between: tuple[str, ...]


@dataclass(frozen=True)
class CauseDiagnosis:
    """What a diagnosis comes to, in values that go from one process to another.

    Attributes
    ----------
    sentences
        Three sentences, as of ``pmm gap``, and one for each run that is left out.
    suggestions
        The most telling first.
    probability
        Probability of the verdict: of an effect with all that is alike in these runs.
    verdict_text
        That in words, and what tells further where something is alike.
    other_measurements
        Measurements besides these runs that would tell, what is confounded first.
    """

    sentences: tuple[str, ...]
    probability: float
    verdict_text: str
    causes: tuple[KnownCause, ...]
    suggestions: tuple[Suggestion, ...]
    other_measurements: tuple[str, ...]


@dataclass(frozen=True)
class Standing:
    """What a place of runs holds.

    Attributes
    ----------
    runs, time_s
        Oscillations that were made, and the tank time of all runs made.
    given_runs, runs_left
        Runs that are made before anything is diagnosed, and others that are approved of.
    set_points
        What was made or is planned.
    notes
        Runs that cannot be used yet, in sentences.
    time_left_s
        What further runs may take.
    """

    runs: tuple[str, ...]
    time_s: float
    given_runs: tuple[RunPlan, ...]
    runs_left: tuple[RunPlan, ...]
    set_points: frozenset[SetPoint]
    notes: tuple[str, ...] = ()
    time_left_s: float = math.inf


class Place(Protocol):
    """Where a pursuit's runs are planned and recorded."""

    def standing(self) -> Standing:
        """Return what is there."""

    def offered(self, worth: Sequence[Suggestion]) -> Sequence[tuple[Suggestion, RunPlan]]:
        """Return which of some runs can be made there."""

    def times_left_s(self, runs: Sequence[RunPlan]) -> Sequence[float]:
        """Return the tank time that is left without some runs that may follow, with the first, ....

        What is made in any case is in all of them.
        """

    def plan(self, look: Look) -> Sequence[str]:
        """Write the plan as it was decided; return the names of the runs to be made now."""


@dataclass(frozen=True)
class CauseGoal:
    """One class of causes that is to be probable, in a place of runs.

    Attributes
    ----------
    diagnose
        Diagnoses what is recorded there.
    least
        Expected log odds below which a run is not worth making.
    batch
        Runs that are proposed at once, at most.
    """

    place: Place
    diagnose: Callable[[], CauseDiagnosis]
    least: float = LEAST
    batch: int = 1

    def plan(self, look: Look) -> Sequence[str]:
        """Write the plan as it was decided; return the names of the runs to be made now."""
        return self.place.plan(look)

    def look(self) -> Look:
        """Return what is known and what is to be made, from what was recorded.

        Raises
        ------
        ConfigurationError
            If there is no campaign, or a plan of it is wrong.
        DataError
            If the campaign cannot be diagnosed, or no runs can be proposed for it.
        """
        standing = self.place.standing()
        look = Look(standing.runs, standing.time_s, (), notes=standing.notes)
        if standing.given_runs:
            return self._keep_runs(look, standing)
        diagnosis = self.diagnose()
        look = replace(look, causes=diagnosis.causes, notes=(*standing.notes, *diagnosis.sentences))
        if diagnosis.probability > SURE:
            return replace(look, ending=Ending.KNOWN, remark=diagnosis.verdict_text)
        if standing.runs_left:
            return self._keep_runs(look, standing)
        if not diagnosis.suggestions and not diagnosis.other_measurements:
            raise DataError(
                "no runs can be proposed; [oscillator] in the campaign file, or [rig] in a "
                "case.toml beside it, says what the rig can do"
            )
        return self._with_next_runs(look, standing, diagnosis)

    def _keep_runs(self, look: Look, standing: Standing) -> Look:
        left_s = self.place.times_left_s(standing.runs_left)[-1]
        kept_runs = (*standing.given_runs, *standing.runs_left)
        return replace(look, kept_runs=kept_runs, left_s=left_s)

    def _with_next_runs(self, look: Look, standing: Standing, diagnosis: CauseDiagnosis) -> Look:
        """Return the look with the runs that are proposed, or why there are none."""
        worth = (
            suggestion for suggestion in diagnosis.suggestions if suggestion.gain >= self.least
        )
        offered = self.place.offered(
            [suggestion for suggestion in worth if suggestion.set_point not in standing.set_points]
        )
        if not offered:
            return replace(look, ending=Ending.EXHAUSTED, remark=_exhausted(self.least, diagnosis))
        chosen: list[tuple[Suggestion, RunPlan]] = []
        for pair in offered:
            times_s = self.place.times_left_s([run for _, run in (*chosen, pair)])
            if times_s[-1] - times_s[0] <= standing.time_left_s:
                chosen.append(pair)
            if len(chosen) == self.batch:
                break
        if not chosen:
            return replace(look, ending=Ending.TIME, remark="too little for any run that tells")
        runs = tuple(run for _, run in chosen)
        times_s = self.place.times_left_s(runs)
        return replace(
            look,
            proposed=runs,
            costs_s=tuple(after - before for before, after in pairwise(times_s)),
            reasons=tuple(_reason(suggestion) for suggestion, _ in chosen),
            left_s=times_s[-1],
            remark="what is expected to tell the causes apart",
        )


def _reason(suggestion: Suggestion) -> str:
    return f"{suggestion.gain:.1f} log odds between {', '.join(suggestion.between)}"


def _exhausted(least: float, diagnosis: CauseDiagnosis) -> str:
    statement = f"no run that the rig can make by itself is worth {least:g} log odds"
    if not diagnosis.other_measurements:
        return f"{statement}, and no measurement outside it is known that would tell"
    return f"{statement}; what would tell: {'; or '.join(diagnosis.other_measurements)}"
