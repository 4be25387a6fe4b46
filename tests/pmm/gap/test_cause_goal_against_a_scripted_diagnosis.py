"""The goal of a cause, its diagnosis and its place scripted, against what has to follow."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import pytest

from analysis.gap.design.proposals import OSCILLATION, Proposal
from hardware.description.errors import DataError
from hardware.description.kinds import Motion, RunKind
from hardware.description.setpoint import SetPoint
from pmm.gap.causes import CauseDiagnosis, CauseGoal, Standing, Suggestion
from pmm.gap.found_cause import suggestions
from pmm.plan.run_plan import RunPlan
from pmm.sequential.look import Ending, KnownCause, Look

SET_POINTS = [SetPoint(0.1 * k, 0.01) for k in range(1, 6)]
BETWEEN = ("cable", "no gap")


def proposal(k: int, gain: float, force_n: float = 0.0) -> Proposal:
    return Proposal(OSCILLATION, SET_POINTS[k], force_n, gain, BETWEEN)


REST = Proposal("rest", None, 0.0, 11.0, BETWEEN)


def found(sure: float, *proposals: Proposal, outside: tuple[str, ...] = ()) -> CauseDiagnosis:
    causes = (KnownCause("cable", sure, 0.95, ("friction",)), KnownCause("none", 1 - sure, 0.95))
    return CauseDiagnosis(
        ("said",), sure, "it is known", causes, suggestions((REST, *proposals)), outside
    )


def run(point: SetPoint) -> RunPlan:
    return RunPlan("", RunKind.OSCILLATION, Motion.PHASE, point, periods=4)


@dataclass
class Rig:
    """A place whose runs take 10 s each; it can make only the first four set-points."""

    there: Standing
    planned: list[Look] = field(default_factory=list)

    def standing(self) -> Standing:
        return self.there

    def offered(self, worth: Sequence[Suggestion]) -> Sequence[tuple[Suggestion, RunPlan]]:
        return [(one, run(one.set_point)) for one in worth if one.set_point in SET_POINTS[:4]]

    def times_left_s(self, runs: Sequence[RunPlan]) -> Sequence[float]:
        given = len(self.there.given_runs)
        return [10.0 * (given + count) for count in range(len(runs) + 1)]

    def plan(self, look: Look) -> Sequence[str]:
        self.planned.append(look)
        return ()


MADE = Standing(("a", "b", "c"), 30.0, (), (), frozenset(SET_POINTS[:1]))
UNSURE = found(0.6, proposal(4, 9.0), proposal(0, 8.0), proposal(1, 7.0, 5.0), proposal(2, 3.0),
               proposal(3, 2.0), proposal(1, 0.5))  # fmt: skip


def look(there: Standing, diagnosis: CauseDiagnosis, batch: int = 1) -> Look:
    return CauseGoal(Rig(there), lambda: diagnosis, batch=batch).look()


def test_what_is_given_is_made_before_anything_is_diagnosed() -> None:
    def never() -> CauseDiagnosis:
        raise AssertionError

    given = CauseGoal(Rig(replace(MADE, given_runs=(run(SET_POINTS[1]),))), never).look()
    assert [one.set_point for one in given.kept_runs] == SET_POINTS[1:2]
    assert (given.causes, given.ending, given.left_s) == ((), None, 10.0)


def test_new_runs_of_the_rig_alone_are_proposed_each_with_its_reason() -> None:
    # 4 is none of the rig's, 0 was made, 1 takes a weight or is worth too little.
    one, two = look(MADE, UNSURE), look(MADE, UNSURE, batch=5)
    assert [run.set_point for run in one.proposed] == [SET_POINTS[2]]
    assert [run.set_point for run in two.proposed] == SET_POINTS[2:4]
    assert two.whys == ("3.0 log odds between cable, no gap", "2.0 log odds between cable, no gap")
    assert two.chosen([2]).whys == two.whys[1:]  # type: ignore[union-attr]
    assert [cause.name for cause in one.causes] == ["cable", "none"]


def test_one_class_over_the_limit_ends_it_whatever_is_approved_of() -> None:
    left = replace(MADE, runs_left=(run(SET_POINTS[3]),))
    known = look(left, found(0.96, proposal(2, 9.0), outside=("the cable disconnected",)))
    assert known.ending is Ending.KNOWN
    assert known.remark == "it is known"
    stays = look(left, found(0.95, proposal(2, 9.0)))
    assert (stays.ending, [one.set_point for one in stays.kept_runs]) == (None, SET_POINTS[3:4])
    assert stays.proposed == ()


def test_the_time_and_what_the_rig_can_do_come_to_an_end() -> None:
    assert look(replace(MADE, time_left_s=19.0), UNSURE, batch=5).left_s == 10.0
    assert look(replace(MADE, time_left_s=9.0), UNSURE).ending is Ending.TIME
    out = look(MADE, found(0.6, proposal(0, 9.0), outside=("the cable disconnected",)))
    assert out.ending is Ending.EXHAUSTED
    assert out.remark == (
        "no run that the rig can make by itself is worth 1 log odds; what would tell: the cable "
        "disconnected"
    )


def test_a_rig_that_says_nothing_of_itself_is_refused() -> None:
    with pytest.raises(DataError, match=r"\[oscillator\] in the campaign file"):
        look(MADE, found(0.6))
