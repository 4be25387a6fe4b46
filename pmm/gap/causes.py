"""The cause of a gap that is to be known: what is known of it, and which runs are left to make."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final, Protocol

from analysis.gap.design.proposals import Proposal
from analysis.gap.inference.answers import effects_in
from analysis.gap.judge.confounded import separating_measurements
from hardware.description.errors import DataError
from hardware.description.setpoint import SetPoint
from pmm.gap.conclusion import EFFECT
from pmm.gap.examination import Examined
from pmm.gap.report import gap_report
from pmm.gap.words import joined
from pmm.plan.run_plan import RunPlan
from pmm.sequential.look import Ending, KnownCause, Look

SURE: Final = 0.95
LEAST: Final = 1.0  # log odds that a run is worth making for
_POSSIBLE: Final = 0.02  # probability from which on an answer is still to be told from the others


@dataclass(frozen=True)
class Found:
    """What a diagnosis comes to, in values that go from one process to another.

    Attributes
    ----------
    said
        Three sentences, as of ``pmm gap``.
    sure
        Probability of the verdict: of an effect with all that is alike in these runs.
    alike
        Measurements that tell apart what these runs cannot.
    outside
        Those and others besides the rig's runs that would tell, what is confounded first.
    """

    said: tuple[str, ...]
    sure: float
    verdict: str
    causes: tuple[KnownCause, ...]
    proposals: tuple[Proposal, ...]
    alike: tuple[str, ...]
    outside: tuple[str, ...]


@dataclass(frozen=True)
class Standing:
    """What a place of runs holds.

    Attributes
    ----------
    runs, time_s
        Oscillations that were made, and the tank time of all runs made.
    given, left
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
    given: tuple[RunPlan, ...]
    left: tuple[RunPlan, ...]
    set_points: frozenset[SetPoint]
    notes: tuple[str, ...] = ()
    time_left_s: float = math.inf


class Place(Protocol):
    """Where a pursuit's runs are planned and recorded."""

    def standing(self) -> Standing:
        """Return what is there."""

    def offered(self, proposals: Sequence[Proposal]) -> Sequence[tuple[Proposal, RunPlan]]:
        """Return which of some proposals can be made there, each with its run."""

    def costs_s(self, runs: Sequence[RunPlan]) -> tuple[float, ...]:
        """Return the tank time of each of some runs that are to follow."""

    def plan(self, look: Look) -> Sequence[str]:
        """Write the plan as it was decided; return the names of the runs to be made now."""


@dataclass(frozen=True)
class CauseGoal:
    """One class of causes that is to be probable, in a place of runs.

    Attributes
    ----------
    found
        Diagnoses what is recorded there.
    least
        Expected log odds below which a run is not worth making.
    batch
        Runs that are proposed at once, at most.
    """

    place: Place
    found: Callable[[], Found]
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
        there = self.place.standing()
        look = Look(there.runs, there.time_s, (), notes=there.notes)
        if there.given:
            return self._kept(look, (*there.given, *there.left))
        found = self.found()
        look = replace(look, causes=found.causes, notes=(*there.notes, *found.said))
        if found.sure > SURE:
            return replace(look, ending=Ending.KNOWN, remark=_known(found))
        if there.left:
            return self._kept(look, there.left)
        if not found.proposals:
            raise DataError(
                "no runs can be proposed; [oscillator] in the campaign file, or [rig] in a "
                "case.toml beside it, says what the rig can do"
            )
        return self._next(look, there, found)

    def _kept(self, look: Look, runs: Sequence[RunPlan]) -> Look:
        return replace(look, kept=tuple(runs), left_s=math.fsum(self.place.costs_s(runs)))

    def _next(self, look: Look, there: Standing, found: Found) -> Look:
        """Return the look with the runs that are proposed, or why there are none."""
        worth = worth_making(there.set_points, found.proposals, self.least)
        offered = self.place.offered(worth)
        if not offered:
            return replace(look, ending=Ending.EXHAUSTED, remark=_exhausted(self.least, found))
        chosen: list[tuple[Proposal, RunPlan]] = []
        for one in offered:
            more_s = self.place.costs_s([run for _, run in (*chosen, one)])
            if len(chosen) < self.batch and math.fsum(more_s) <= there.time_left_s:
                chosen.append(one)
        if not chosen:
            return replace(look, ending=Ending.TIME, remark="too little for any run that tells")
        runs = tuple(run for _, run in chosen)
        costs_s = self.place.costs_s(runs)
        return replace(
            look,
            proposed=runs,
            costs_s=costs_s,
            reasons=tuple(reason(one) for one, _ in chosen),
            left_s=math.fsum(costs_s),
            remark="what is expected to tell the causes apart",
        )


def worth_making(
    there: frozenset[SetPoint], proposals: Sequence[Proposal], least: float
) -> tuple[Proposal, ...]:
    """Return the runs that the rig can make by itself, are new, and worth ``least`` log odds.

    Parameters
    ----------
    there
        What was made or is planned.
    """
    return tuple(
        one
        for one in proposals
        if one.set_point is not None
        and not one.force_n
        and one.gain >= least
        and one.set_point not in there
    )


def reason(one: Proposal) -> str:
    """Return what a run is expected to be worth, in words."""
    return f"{one.gain:.1f} log odds between {', '.join(one.between)}"


def found_of(examined: Examined, least: float = LEAST) -> Found:
    """Return what an examination comes to."""
    report, concluded = gap_report(examined), examined.conclusion
    possible = [name for name, share in examined.shares.items() if share > _POSSIBLE]
    effects = sorted({one for name in possible for one in effects_in(name)})
    outside = [
        str(one)
        for one in examined.diagnosis.proposals
        if (one.set_point is None or one.force_n) and one.gain >= least
    ]
    alike = tuple(dict.fromkeys(how for one in report.ranking for how in one.measure))
    every = tuple(dict.fromkeys([*alike, *separating_measurements(effects), *outside[:1]]))
    return Found(
        report.said,
        concluded.probability,
        concluded.verdict,
        tuple(_causes(examined)),
        examined.diagnosis.proposals,
        alike,
        every,
    )


def _causes(examined: Examined) -> Iterator[KnownCause]:
    """Yield what is possible, the most probable answer first, with all that is alike there."""
    concluded, answers = examined.conclusion, list(examined.shares.items())
    first = answers[0][0]
    alike = concluded.weighing.alike
    same = tuple(name for own in effects_in(first) for name in alike.get(own, ()))
    yield KnownCause(first, concluded.probability, SURE, same)
    for name, share in answers[1:]:
        if share > _POSSIBLE and name not in same:
            yield KnownCause(name, share, SURE)


def _known(found: Found) -> str:
    first = found.causes[0].name
    what = joined(first) if found.verdict == EFFECT else f"the answer {first!r}"
    also = f"; within its class tells: {'; or '.join(found.alike)}" if found.alike else ""
    return f"the class of {what} has probability {found.sure:.3f}{also}"


def _exhausted(least: float, found: Found) -> str:
    left = f"no run that the rig can make by itself is worth {least:g} log odds"
    if not found.outside:
        return f"{left}, and no measurement outside it is known that would tell"
    return f"{left}; what would tell: {'; or '.join(found.outside)}"
